// Organs other than the colon, prepared from their profiles alone: a branching vessel full of
// contrast, and bladders, on scans of known geometry.
#include "nifti/nifti_file.h"
#include "organs/built_in_profiles.h"
#include "pipeline/prepare.h"
#include "temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::pipeline {
namespace {

namespace fs = std::filesystem;

using Signed = std::function<double(glm::dvec3 mm)>;  // distance to a wall, mm, negative inside

double capsule(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, double radius) {
    const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(p, a + t * (b - a)) - radius;
}

// A vessel along z that a branch leaves.
const glm::dvec3 origin(-25.0, 40.0, -500.0);
const glm::dvec3 low = origin + glm::dvec3(20, 25, 6), high = origin + glm::dvec3(20, 25, 84),
                 fork = origin + glm::dvec3(20, 25, 35), tip = origin + glm::dvec3(50, 25, 62);
double vessel(glm::dvec3 p) {
    return std::min(capsule(p, low, high, 5.0), capsule(p, fork, tip, 3.5));
}
// The same with a loop: the branch comes back.
double loopedVessel(glm::dvec3 p) {
    return std::min(vessel(p), capsule(p, tip, high - glm::dvec3(0, 0, 6), 3.0));
}
const glm::dvec3 bladderCenter = origin + glm::dvec3(30, 25, 45);
double bladder(glm::dvec3 p) {
    const glm::dvec3 q = (p - bladderCenter) / glm::dvec3(22, 18, 26);
    return (glm::length(q) - 1.0) * 18.0;
}

class PrepareOrgans : public testing::Test {
protected:
    // A scan with edges as soft as a scanner's and noise of sd about 8 HU.
    void writeScan(const Signed& wall, double contentHu, double aroundHu) {
        const Grid grid = axisAlignedGrid({70, 60, 72}, {0.85, 0.85, 1.25}, origin);
        Volume<std::int16_t> hu(grid);
        std::uint32_t state = 7;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const double mm = wall(grid.patientFromVoxelPoint(grid.voxelAt(n)));
            const double share = 0.5 * std::erfc(mm / 0.9);
            double noise = 0.0;
            for (int draw = 0; draw < 4; ++draw) {
                state = state * 1664525u + 1013904223u;
                noise += (double(state >> 8) / (1 << 24) - 0.5) * 14.0;
            }
            hu.writable()[n] =
                std::int16_t(std::lround(share * contentHu + (1.0 - share) * aroundHu + noise));
        }
        ASSERT_TRUE(nifti::writeNifti(folder_ / "scan.nii.gz", hu));
    }

    std::string writeProfile(const std::string& text) const {
        std::ofstream(folder_ / "organ.json") << text;
        return folder_ / "organ.json";
    }

    Result<PrepareReport> prepareAs(const std::string& organ,
                                    const std::vector<glm::dvec3>& seedsMm = {}) {
        PrepareOptions options;
        options.series = folder_ / "scan.nii.gz";
        options.organ = organ;
        options.seedsMm = seedsMm;
        options.replace = true;  // one case, whichever scan
        return prepare(store::CaseStore::open(folder_ / "store", true).value(), "organ", options);
    }
    store::Case opened() const {
        return store::CaseStore::open(folder_ / "store", false).value().openCase("organ").value();
    }

    // The surface's vertices against the wall that the scan was made of.
    static void expectOnWall(const TriMesh& surface, const Signed& wall, double meanMm) {
        double sum = 0.0, outwards = 0.0;
        for (const glm::dvec3& v : surface.vertices) {
            sum += std::abs(wall(v));
            outwards += wall(v);
        }
        const double count = double(surface.vertices.size());
        ASSERT_GT(count, 100.0);
        EXPECT_LT(sum / count, meanMm);
        EXPECT_LT(std::abs(outwards / count), 0.5 * meanMm) << "the wall stands to one side";
    }
    // Positive where triangles are counter-clockwise seen from outside.
    static double volumeMm3(const TriMesh& mesh) {
        double six = 0.0;
        for (const glm::ivec3& t : mesh.triangles) {
            six += glm::dot(mesh.vertices[t.x] - origin,
                            glm::cross(mesh.vertices[t.y] - origin, mesh.vertices[t.z] - origin));
        }
        return six / 6.0;
    }

    const tests::TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

TEST_F(PrepareOrgans, AContrastFilledVesselWithItsBranch) {
    writeScan(vessel, 300.0, 45.0);
    const auto report = prepareAs("vessel");
    ASSERT_TRUE(report) << describe(report.error());
    std::vector<std::string> stages;
    for (const StageReport& stage : report->stages)
        stages.push_back(stage.stage);
    EXPECT_EQ(stages, (std::vector<std::string>{"import", "segmentation", "denoising", "distance",
                                                "centerline", "surface"}));
    EXPECT_TRUE(std::ranges::any_of(report->notes, [](const std::string& note) {
        return note.starts_with("flattening: left out");
    }));
    const store::Case made = opened();
    for (const char* product : {"mixture", "cleansed", "cleansed-lumen", "flatmap"})
        EXPECT_FALSE(made.find(product)) << product;

    const TriMesh surface = made.readMesh().value();
    EXPECT_TRUE(meshTopology(surface).closed());
    EXPECT_EQ(meshTopology(surface).genus(), 0);
    expectOnWall(surface, vessel, 0.15);
    EXPECT_GT(volumeMm3(surface), 0.0);
    EXPECT_NEAR(std::stod(made.attributes("surface")->at("iso-hu")), 0.5 * (300.0 + 45.0), 6.0);

    // The longest way through runs up the branch or the trunk from the foot; the other is a branch.
    const Centerline line = made.readCenterline().value();
    const Centerline branches = made.readCenterline("branches").value();
    EXPECT_EQ(made.attributes("branches")->at("branches"), "1");
    ASSERT_FALSE(branches.points.empty());
    EXPECT_EQ(branches.points.front().arcMm, 0.0);
    const auto nearest = [](const Centerline& to, glm::dvec3 p) {
        double mm = 1e9;
        for (const CenterlinePoint& point : to.points)
            mm = std::min(mm, glm::distance(point.positionMm, p));
        return mm;
    };
    EXPECT_LT(nearest(line, low), 6.0);
    EXPECT_LT(std::min(nearest(line, high), nearest(branches, high)), 6.0);
    EXPECT_LT(std::min(nearest(line, tip), nearest(branches, tip)), 5.0);
}

TEST_F(PrepareOrgans, AVesselsLoopIsItsOwnAndABallsIsCut) {
    writeScan(loopedVessel, 300.0, 45.0);
    ASSERT_TRUE(prepareAs("vessel"));
    EXPECT_EQ(meshTopology(opened().readMesh().value()).genus(), 1);
    EXPECT_EQ(opened().attributes("lumen")->at("handles-kept"), "1");
    const std::string ball = writeProfile(R"({"organ": "vein", "cleanse": false,
        "lumen": {"finder": "hu-range", "hu": [180, 700]}, "topology": "ball",
        "end-points": "farthest", "branches": false})");
    const auto report = prepareAs(ball);
    ASSERT_TRUE(report) << describe(report.error());
    for (const StageReport& stage : report->stages) {
        EXPECT_EQ(stage.reused, stage.stage == "import" || stage.stage == "segmentation")
            << stage.stage;
    }
    EXPECT_EQ(meshTopology(opened().readMesh().value()).genus(), 0);
    EXPECT_GE(std::stoi(opened().attributes("lumen")->at("handles-cut")), 1);
    EXPECT_FALSE(opened().find("branches")) << "what the profile does not keep is gone";
}

// Urine is darker than the wall, or brighter where contrast is excreted, or brighter than the fat.
TEST_F(PrepareOrgans, ABladderWhateverSurroundsIt) {
    struct {
        double contentHu, aroundHu;
        const char* hu;
    } const bladders[] = {{5, -100, "[-40, 40]"}, {5, 250, "[-60, 120]"}, {400, 30, "[250, 700]"}};
    for (const auto& [contentHu, aroundHu, hu] : bladders) {
        writeScan(bladder, contentHu, aroundHu);
        const std::string profile =
            writeProfile(std::string(R"({"organ": "bladder", "cleanse": false, "topology": "ball",
                "end-points": "farthest", "branches": false, "lumen": {"finder": "hu-range",
                "opening-mm": 4, "hu": )") +
                         hu + "}}");
        const auto report = prepareAs(profile, {bladderCenter});
        ASSERT_TRUE(report) << contentHu << ": " << describe(report.error());
        const TriMesh surface = opened().readMesh().value();
        EXPECT_EQ(meshTopology(surface).eulerCharacteristic, 2);
        EXPECT_TRUE(meshTopology(surface).closed());
        const double trueMm3 = 4.0 / 3.0 * M_PI * 22 * 18 * 26;
        EXPECT_NEAR(volumeMm3(surface), trueMm3, 0.02 * trueMm3) << contentHu;
        EXPECT_NEAR(std::stod(opened().attributes("surface")->at("iso-hu")),
                    0.5 * (contentHu + aroundHu), 6.0);
        const Centerline line = opened().readCenterline().value();
        EXPECT_NEAR(line.lengthMm(), 52.0, 15.0);
    }
}

TEST_F(PrepareOrgans, TheBuiltInBladderFindsUrineInFat) {
    writeScan(bladder, 5.0, -100.0);
    const auto report = prepareAs("bladder");
    ASSERT_TRUE(report) << describe(report.error());
    const double trueMm3 = 4.0 / 3.0 * M_PI * 22 * 18 * 26;
    EXPECT_NEAR(volumeMm3(opened().readMesh().value()), trueMm3, 0.02 * trueMm3);
}

// The colon is no special case: what its profile says of tissues decides, and so does `cleanse`.
TEST_F(PrepareOrgans, TheColonIsDrivenByItsProfile) {
    writeScan(bladder, -1000.0, 45.0);
    Volume<std::uint8_t> mask(nifti::readNifti<std::int16_t>(folder_ / "scan.nii.gz")->grid());
    for (std::size_t n = 0; n < mask.grid().voxelCount(); ++n) {
        mask.writable()[n] =
            bladder(mask.grid().patientFromVoxelPoint(mask.grid().voxelAt(n))) < 0.0;
    }
    ASSERT_TRUE(nifti::writeNifti(folder_ / "mask.nii.gz", mask));
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string text(organs::builtInProfiles().at("colon"));
        text.replace(text.find(from), from.size(), to);
        PrepareOptions options;
        options.series = folder_ / "scan.nii.gz";
        options.lumenMask = folder_ / "mask.nii.gz";
        options.organ = writeProfile(text);
        return prepare(store::CaseStore::open(folder_ / "store", true).value(), "organ", options);
    };
    EXPECT_EQ(changed("\"colon\"", "\"stomach\"")->stages.size(), stageNames().size());
    EXPECT_TRUE(opened().find("cleansed"));
    const auto raw = changed("\"cleanse\": true", "\"cleanse\": false");
    ASSERT_TRUE(raw) << describe(raw.error());
    EXPECT_EQ(raw->stages.size(), stageNames().size() - 2);
    EXPECT_TRUE(raw->stages[1].reused) << "the segmentation does not depend on it";
    for (const char* product : {"mixture", "cleansed", "cleansed-lumen"})
        EXPECT_FALSE(opened().find(product)) << product;
    EXPECT_TRUE(opened().find("surface"));
    const auto refused = changed("[-10, 110]", "[100, 110]");
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("100 to 110"), std::string::npos);
}

TEST_F(PrepareOrgans, ABadProfileLeavesNoCase) {
    writeScan(bladder, 5.0, -100.0);
    const auto report = prepareAs(writeProfile(R"({"organ": "bladder", "hu": [0, 1]})"));
    ASSERT_FALSE(report);
    EXPECT_NE(describe(report.error()).find("organ.json"), std::string::npos);
    EXPECT_TRUE(fs::is_empty(folder_ / "store" / "cases"));
}

}  // namespace
}  // namespace haustra::pipeline
