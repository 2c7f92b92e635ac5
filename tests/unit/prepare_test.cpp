// Laws of prepare: work that is unchanged and sound is reused, anything else is done again, and
// the products do not depend on the number of threads.
#include "pipeline/prepare.h"

#include "cleansing/tissue_mixture.h"
#include "core/tri_mesh.h"
#include "nifti/nifti_file.h"
#include "pipeline/axial_order.h"
#include "pipeline/product_attributes.h"
#include "pipeline/source_key.h"
#include "pipeline/stage_meter.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::pipeline {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void overwrite(const fs::path& file, const std::string& bytes) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

// A bent tube of air in soft tissue, and its mask.
constexpr glm::ivec3 tubeSize{48, 40, 90};

Volume<std::uint8_t> tubeMask(double radiusMm, std::uint8_t label = 1) {
    Volume<std::uint8_t> mask(axisAlignedGrid(tubeSize, {0.8, 0.8, 1.2}, {-20.0, 5.0, -300.0}));
    for (std::size_t n = 0; n < mask.grid().voxelCount(); ++n) {
        const glm::ivec3 v = mask.grid().voxelAt(n);
        const glm::dvec2 axis(24.0 + 8.0 * std::sin(v.z * 0.06), 20.0);
        const bool inside =
            0.8 * glm::distance(glm::dvec2(v), axis) < radiusMm && v.z > 4 && v.z < 85;
        mask.writable()[n] = inside ? label : 0;
    }
    return mask;
}

class Prepare : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("haustra-prepare-" + std::to_string(::getpid()) + "-" +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        ASSERT_TRUE(nifti::writeNifti(maskFile(), tubeMask(6.0)));
        writeScan(6.0);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void writeScan(double radiusMm) const {
        const auto mask = tubeMask(radiusMm);
        Volume<std::int16_t> ct(mask.grid());
        for (std::size_t n = 0; n < mask.grid().voxelCount(); ++n) {
            ct.writable()[n] = mask[n] ? -1000 : std::int16_t(40 + n % 7);
        }
        ASSERT_TRUE(nifti::writeNifti(ctFile(), ct));
    }
    fs::path ctFile() const { return folder_ / "ct.nii.gz"; }
    fs::path maskFile() const { return folder_ / "mask.nii.gz"; }
    store::CaseStore store(const std::string& name = "store") const {
        return store::CaseStore::open(folder_ / name, true).value();
    }
    PrepareOptions options() const {
        PrepareOptions options;
        options.series = ctFile();
        options.lumenMask = maskFile();
        return options;
    }
    // Runs it and gives which stages were reused.
    std::map<std::string, bool> reused(const PrepareOptions& options) const {
        const auto report = prepare(store(), "tube", options);
        EXPECT_TRUE(report) << describe(report.error());
        std::map<std::string, bool> stages;
        if (report) {
            for (const StageReport& stage : report->stages)
                stages[stage.stage] = stage.reused;
        }
        return stages;
    }
    static std::map<std::string, std::string> bytesOf(const store::Case& source) {
        std::map<std::string, std::string> bytes;
        const auto entries = source.products().value();
        for (const auto& entry : entries) {
            bytes[entry.product + " " + entry.key.hex] = content(source.folder() / entry.file);
        }
        return bytes;
    }

    using Stages = std::map<std::string, bool>;
    static Stages all(bool reused, const std::vector<std::string>& stages = stageNames()) {
        Stages result;
        for (const std::string& stage : stages)
            result[stage] = reused;
        return result;
    }
    static Stages redone(const std::vector<std::string>& stages) {
        Stages result = all(true);
        for (const std::string& stage : stages)
            result[stage] = false;
        return result;
    }
    static std::string stageOf(const std::string& product) {
        static const std::map<std::string, std::string> stages{{"ct", "import"},
                                                               {"cleansed", "cleansing"},
                                                               {"cleansed-lumen", "cleansing"},
                                                               {"lumen", "denoising"}};
        const auto found = stages.find(product);
        return found == stages.end() ? product : found->second;
    }
    fs::path folder_;
};

TEST_F(Prepare, ASecondRunReusesEverythingAndChangesNothing) {
    EXPECT_EQ(reused(options()), all(false));
    const auto before = bytesOf(store().openCase("tube").value());
    EXPECT_EQ(before.size(), 9u);
    EXPECT_EQ(reused(options()), all(true));
    EXPECT_EQ(bytesOf(store().openCase("tube").value()), before);
}

TEST_F(Prepare, ProductsAreTheStagesOutputs) {
    reused(options());
    const auto tube = store().openCase("tube").value();
    const auto ct = tube.readVolume<std::int16_t>("ct").value();
    const auto labels = tube.readVolume<std::uint8_t>("lumen").value();
    const auto distance = tube.readVolume<float>("distance").value();
    const auto centerline = tube.readCenterline().value();
    EXPECT_EQ(tube.attributes("ct").value().at("position"), "unknown");
    EXPECT_TRUE(sameGrid(ct.grid(), labels.grid()));
    EXPECT_EQ(labels.grid().patientFromVoxel, ct.grid().patientFromVoxel);
    for (std::size_t n = 0; n < labels.grid().voxelCount(); ++n) {
        ASSERT_EQ(labels[n] != 0, ct[n] == -1000);
        ASSERT_EQ(labels[n] != 0, distance[n] > 0.0f);
    }
    EXPECT_NEAR(centerline.lengthMm(), 90.0, 20.0);
    // Nothing is tagged, so nothing is cleansed, and the surface is the tube's.
    const auto cleansed = tube.readVolume<std::int16_t>("cleansed").value();
    EXPECT_TRUE(std::ranges::equal(cleansed.voxels(), ct.voxels()));
    EXPECT_TRUE(tube.readVolume<TissueFractions>("mixture"));
    const auto surface = tube.readMesh().value();
    const MeshTopology topology = meshTopology(surface);
    EXPECT_TRUE(topology.closed());
    EXPECT_EQ(topology.eulerCharacteristic, 2);
    EXPECT_EQ(tube.attributes("surface").value().at("triangles"),
              std::to_string(surface.triangles.size()));
}

TEST_F(Prepare, ChangedInputsRedoWhatComesFromThemAlone) {
    reused(options());
    ASSERT_TRUE(nifti::writeNifti(maskFile(), tubeMask(5.0)));
    EXPECT_EQ(reused(options()), redone({"segmentation", "mixture", "cleansing", "denoising",
                                         "distance", "centerline", "surface"}));
    writeScan(5.0);
    EXPECT_EQ(reused(options()), all(false));
    PrepareOptions coarser = options();
    coarser.surfaceErrorMm = 0.3;
    EXPECT_EQ(reused(coarser), redone({"surface"}));
    coarser.threads = 1;
    EXPECT_EQ(reused(coarser), all(true));
}

TEST_F(Prepare, ANewScanLeavesNoProductOfTheOldOne) {
    reused(options());
    ASSERT_TRUE(nifti::writeNifti(ctFile(), Volume<std::int16_t>(tubeMask(5.0).grid(), -7)));
    PrepareOptions only = options();
    only.until = "import";
    EXPECT_EQ(reused(only), (Stages{{"import", false}}));
    EXPECT_EQ(store().openCase("tube")->products()->size(), 1u);
}

TEST_F(Prepare, UntilStopsAndTheNextRunGoesOn) {
    PrepareOptions some = options();
    some.until = "distance";
    EXPECT_EQ(reused(some), all(false, {"import", "segmentation", "mixture", "cleansing",
                                        "denoising", "distance"}));
    EXPECT_EQ(reused(options()), redone({"centerline", "surface"}));
}

TEST_F(Prepare, AMaskStandsAlone) {
    PrepareOptions alone = options();
    alone.series.clear();
    EXPECT_EQ(reused(alone),
              all(false, {"segmentation", "denoising", "distance", "centerline", "surface"}));
    const auto tube = store().openCase("tube").value();
    for (const char* product : {"ct", "mixture", "cleansed", "cleansed-lumen"})
        EXPECT_FALSE(tube.find(product)) << product;
    EXPECT_TRUE(tube.find("centerline"));
    EXPECT_TRUE(meshTopology(tube.readMesh().value()).closed());
}

// What a store of before this order of stages holds: the same names, made otherwise.
TEST_F(Prepare, OldProductsAreMadeAgain) {
    reused(options());
    const auto now = bytesOf(store().openCase("tube").value());
    fs::remove_all(folder_ / "store");
    PrepareOptions import = options();
    import.until = "import";
    reused(import);
    {
        auto old = store().createCase("tube").value();
        const auto key = store::makeKey("lumen", 1, "", {old.find("ct")->key});
        ASSERT_TRUE(old.publishVolume("lumen", key, tubeMask(3.0)));
        ASSERT_TRUE(old.publishVolume("distance", key, Volume<float>(tubeMask(3.0).grid(), 1.0f)));
        ASSERT_TRUE(old.publishCenterline("centerline", key, {}));
    }
    PrepareOptions found = options();
    found.until = "segmentation";
    reused(found);
    EXPECT_EQ(store().openCase("tube")->products()->size(), 2u)
        << "old products outlive their input";
    reused(options());
    EXPECT_EQ(bytesOf(store().openCase("tube").value()), now);
}

TEST_F(Prepare, TheTissueModelComesBackFromTheSegmentationBitForBit) {
    reused(options());
    const auto tube = store().openCase("tube").value();
    const CtScan scan{tube.readVolume<std::int16_t>("ct").value(), PatientPosition::unknown};
    const auto fitted = cleansing::fitTissueModel(scan).value();
    const auto stored = tissueModelOf(tube.attributes("segmentation").value()).value();
    EXPECT_EQ(stored.meanHu, fitted.meanHu);
    EXPECT_EQ(stored.sdHu, fitted.sdHu);
    EXPECT_EQ(stored.weight, fitted.weight);
    EXPECT_EQ(stored.airBelowHu, fitted.airBelowHu);
    EXPECT_EQ(stored.taggedAboveHu, fitted.taggedAboveHu);
    auto damaged = tube.attributes("segmentation").value();
    for (const char* bad : {"", "1,2,3", "1,2,3,4,5", "1,2,3,x", "1,2,3,nan"}) {
        damaged["mean-hu"] = bad;
        EXPECT_FALSE(tissueModelOf(damaged)) << bad;
    }
}

TEST_F(Prepare, AMaskWithoutASeriesIsOfTheCasesScan) {
    PrepareOptions import = options();
    import.until = "import";
    reused(import);
    PrepareOptions mask = options();
    mask.series.clear();
    EXPECT_EQ(reused(mask), all(false, {"segmentation", "mixture", "cleansing", "denoising",
                                        "distance", "centerline", "surface"}));
    EXPECT_TRUE(store().openCase("tube")->find("ct"));
    EXPECT_EQ(reused(options()), all(true));
}

TEST_F(Prepare, AMaskOnAnotherGridIsRefused) {
    Volume<std::uint8_t> shifted(tubeMask(6.0));
    Grid grid = shifted.grid();
    grid.patientFromVoxel[3].x += 0.4;
    const auto moved = Volume<std::uint8_t>::view(grid, shifted.voxels().data(), nullptr);
    ASSERT_TRUE(nifti::writeNifti(maskFile(), moved));
    const auto report = prepare(store(), "tube", options());
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().place.find("mask.nii.gz"), std::string::npos);

    ASSERT_TRUE(nifti::writeNifti(maskFile(),
                                  Volume<std::uint8_t>(axisAlignedGrid({9, 9, 9}, {1, 1, 1}), 1)));
    EXPECT_FALSE(prepare(store(), "tube", options()));
    ASSERT_TRUE(nifti::writeNifti(maskFile(), Volume<std::uint8_t>(grid, 0)));
    EXPECT_FALSE(prepare(store(), "tube", options()));
}

TEST_F(Prepare, ACoronalScanIsPreparedAsTheAxialOne) {
    EXPECT_EQ(reused(options()), all(false));
    const AxisOrder coronal{0, 2, 1};
    auto ct = nifti::readNifti<std::int16_t>(ctFile()).value();
    ASSERT_TRUE(
        nifti::writeNifti(folder_ / "coronal.nii.gz", reordered(std::move(ct), coronal, 1)));
    ASSERT_TRUE(
        nifti::writeNifti(folder_ / "coronal-mask.nii.gz", reordered(tubeMask(6.0), coronal, 1)));
    PrepareOptions turned = options();
    turned.series = folder_ / "coronal.nii.gz";
    for (const fs::path& mask : {maskFile(), folder_ / "coronal-mask.nii.gz"}) {
        turned.lumenMask = mask;
        const std::string name = mask.stem().stem().string();
        const auto report = prepare(store(), name, turned);
        ASSERT_TRUE(report) << describe(report.error());
        EXPECT_EQ(std::ranges::count(report->notes,
                                     "import: the voxels' axes were put in axial order; they were "
                                     "stored as xzy"),
                  1);
        for (const char* product : {"ct", "cleansed"}) {
            const auto axial = store().openCase("tube")->readVolume<std::int16_t>(product).value();
            const auto other = store().openCase(name)->readVolume<std::int16_t>(product).value();
            EXPECT_TRUE(sameGrid(other.grid(), axial.grid()));
            EXPECT_TRUE(std::ranges::equal(other.voxels(), axial.voxels())) << product;
        }
    }
    // The mask alone.
    turned.series.clear();
    ASSERT_TRUE(prepare(store(), "alone", turned));
    EXPECT_EQ(store().openCase("alone")->readVolume<std::uint8_t>("lumen")->grid().size, tubeSize);
}

TEST_F(Prepare, MaskValuesFarFromZeroAreLumen) {
    ASSERT_TRUE(nifti::writeNifti(maskFile(), tubeMask(6.0, 255)));
    const auto report = prepare(store(), "tube", options());
    ASSERT_TRUE(report);
    EXPECT_NE(std::ranges::find_if(report->notes,
                                   [](const std::string& note) {
                                       return note.find("mask values") != std::string::npos;
                                   }),
              report->notes.end());
    const auto labels = store().openCase("tube")->readVolume<std::uint8_t>("segmentation").value();
    EXPECT_EQ(labels.at(24, 20, 6), 1);
}

TEST_F(Prepare, DamagedProductsAreMadeAgainByteForByte) {
    reused(options());
    const auto tube = store().openCase("tube").value();
    const auto sound = bytesOf(tube);
    const auto entries = tube.products().value();
    for (const auto& entry : entries) {
        const fs::path file = tube.folder() / entry.file;
        const std::string whole = content(file);
        std::string flipped = whole;
        flipped[whole.size() - 5] = char(flipped[whole.size() - 5] ^ 16);
        for (const std::string& bad :
             {whole.substr(0, whole.size() - 1), whole.substr(0, 100), std::string(), flipped}) {
            overwrite(file, bad);
            const auto report = prepare(store(), "tube", options());
            ASSERT_TRUE(report) << describe(report.error());
            EXPECT_TRUE(std::ranges::any_of(report->notes, [&](const std::string& note) {
                return note.find(entry.file) != std::string::npos;
            })) << entry.file;
            for (const StageReport& stage : report->stages) {
                EXPECT_EQ(stage.reused, stage.stage != stageOf(entry.product));
            }
            EXPECT_EQ(bytesOf(tube), sound);
        }
        fs::remove(file);
        ASSERT_TRUE(prepare(store(), "tube", options()));
        EXPECT_EQ(bytesOf(tube), sound);
    }
}

TEST_F(Prepare, WithItsDamagedIndexRemovedACaseIsMadeAgain) {
    reused(options());
    const auto tube = store().openCase("tube").value();
    const auto sound = bytesOf(tube);
    overwrite(tube.folder() / "case.json", "{");
    const auto report = prepare(store(), "tube", options());
    ASSERT_FALSE(report);
    const std::string said = describe(report.error());
    EXPECT_NE(said.find("case.json"), std::string::npos) << said;
    EXPECT_NE(said.find("remove this file"), std::string::npos) << said;
    fs::remove(tube.folder() / "case.json");
    EXPECT_EQ(reused(options()), all(false));
    EXPECT_EQ(bytesOf(tube), sound);
}

TEST_F(Prepare, WhatDenoisingAndTheSurfaceCameToIsNoted) {
    for (int run = 0; run < 2; ++run) {  // made, and reused
        const auto report = prepare(store(), "tube", options());
        ASSERT_TRUE(report) << describe(report.error());
        for (const char* start : {"denoising: 0 handles cut, 0 cavities filled, ", "surface: "}) {
            EXPECT_TRUE(std::ranges::any_of(report->notes, [&](const std::string& note) {
                return note.rfind(start, 0) == 0;
            })) << start;
        }
    }
    EXPECT_NE(
        store().openCase("tube")->attributes("surface")->at("notes").find("Euler characteristic 2"),
        std::string::npos);
}

TEST_F(Prepare, AFailedStageNamesItsCase) {
    Volume<std::uint8_t> speck(tubeMask(6.0).grid(), 0);
    speck.writable()[speck.grid().index(20, 20, 40)] = 1;
    ASSERT_TRUE(nifti::writeNifti(maskFile(), speck));
    PrepareOptions alone = options();
    alone.series.clear();
    const auto report = prepare(store(), "speck", alone);
    ASSERT_FALSE(report);
    EXPECT_NE(describe(report.error()).find("case speck, "), std::string::npos)
        << describe(report.error());
}

TEST_F(Prepare, ProductsDoNotDependOnTheNumberOfThreads) {
    std::map<std::string, std::string> first;
    for (const int threads : {1, 2, 5}) {
        PrepareOptions some = options();
        some.threads = threads;
        ASSERT_TRUE(prepare(store(), "threads-" + std::to_string(threads), some));
        const auto bytes = bytesOf(store().openCase("threads-" + std::to_string(threads)).value());
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes, first);
    }
}

TEST_F(Prepare, ACaseThatIsBeingWrittenIsRefused) {
    const auto held = store().createCase("tube");
    ASSERT_TRUE(held);
    const auto report = prepare(store(), "tube", options());
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("being written"), std::string::npos);
}

TEST_F(Prepare, WrongOptionsAreToldAndLeaveNoCase) {
    PrepareOptions wrong = options();
    wrong.until = "polish";
    EXPECT_FALSE(prepare(store(), "tube", wrong));
    EXPECT_FALSE(prepare(store(), "tube", {}));
    wrong = options();
    wrong.series = folder_ / "none";
    EXPECT_EQ(prepare(store(), "tube", wrong).error().kind, ErrorKind::notFound);
    wrong = options();
    wrong.surfaceErrorMm = 0.0;
    EXPECT_FALSE(prepare(store(), "tube", wrong));
    wrong = options();
    wrong.surfaceErrorMm = std::nan("");
    EXPECT_FALSE(prepare(store(), "tube", wrong));
    wrong = options();
    wrong.excludesMm = {{0.0, 0.0, 0.0}};
    EXPECT_EQ(prepare(store(), "tube", wrong).error().kind, ErrorKind::badInput);
    wrong = options();
    wrong.lumenMask = folder_;
    EXPECT_NE(describe(prepare(store(), "tube", wrong).error()).find("a folder"),
              std::string::npos);
    wrong = options();
    wrong.series.clear();
    wrong.until = "import";
    EXPECT_EQ(prepare(store(), "tube", wrong).error().kind, ErrorKind::badInput);
    wrong = options();
    wrong.organ = "spleen";
    EXPECT_EQ(prepare(store(), "tube", wrong).error().kind, ErrorKind::notFound);
    EXPECT_FALSE(prepare(store(), "../tube", options()));
    EXPECT_TRUE(fs::is_empty(folder_ / "store" / "cases"));
}

TEST_F(Prepare, ProgressEndsEachStageAtOne) {
    std::map<std::string, double> last;
    PrepareOptions some = options();
    some.progress = [&](const std::string& stage, double fraction) {
        EXPECT_GE(fraction, 0.0);
        EXPECT_LE(fraction, 1.0);
        last[stage] = fraction;
    };
    ASSERT_TRUE(prepare(store(), "tube", some));
    EXPECT_EQ(last.size(), stageNames().size());
    for (const auto& [stage, fraction] : last)
        EXPECT_EQ(fraction, 1.0) << stage;
}

TEST_F(Prepare, TheSourcesKeyIsOfTheirContentNotOfTheirNames) {
    overwrite(folder_ / "a/1.dcm", "one");
    overwrite(folder_ / "a/2.dcm", "two");
    overwrite(folder_ / "b/z", "one");
    overwrite(folder_ / "b/deep/er/1.dcm", "two");
    overwrite(folder_ / "c/1.dcm", "one");
    overwrite(folder_ / "c/2.dcm", "twO");
    overwrite(folder_ / "d/1.dcm", "onetwo");
    const auto key = [&](const char* name) { return sourceKey(folder_ / name, 2).value().hex; };
    EXPECT_EQ(key("a"), key("b"));
    EXPECT_NE(key("a"), key("c"));
    EXPECT_NE(key("a"), key("d"));
    EXPECT_FALSE(sourceKey(folder_ / "none", 2));
}

TEST(StageMeter, SeesThePeakOfItsOwnStageOnly) {
    constexpr std::size_t bytes = std::size_t(200) << 20;
    const auto touch = [] {
        std::vector<char> memory(bytes);
        for (std::size_t n = 0; n < bytes; n += 4096)
            const_cast<volatile char&>(memory[n]) = 1;
    };
    const StageMeter first;
    const double before = first.peakMemoryMib();
    touch();
    EXPECT_GT(first.peakMemoryMib(), before + 190.0);
    const StageMeter second;
    EXPECT_LT(second.peakMemoryMib(), before + 100.0);
}

}  // namespace
}  // namespace haustra::pipeline
