// The colon in a drawn abdomen: a tube with air over fluid in a block of soft tissue, with lungs,
// stomach and opacified bowel beside it.
#include "topology/lumen.h"

#include "cleansing/tissue_mixture.h"
#include "phantom/phantom.h"
#include "phantom/score.h"
#include "topology/run_components.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

constexpr int levelRow = 62;  // the fluid's surface: voxel row 62, y = 124 mm

struct Drawing {
    Volume<std::int16_t> hu{axisAlignedGrid({100, 100, 120}, {2, 2, 2})};

    Drawing() {
        const Grid& g = hu.grid();
        std::mt19937 random(3);
        std::normal_distribution<double> noise(0.0, 12.0);
        for (std::size_t n = 0; n < g.voxelCount(); ++n) {
            const glm::ivec3 v = g.voxelAt(n);
            const bool body = v.x >= 6 && v.x < 94 && v.y >= 10 && v.y < 90;
            const bool fat = body && (v.x < 10 || v.x >= 90 || v.y < 14 || v.y >= 86);
            hu.writable()[n] =
                std::int16_t(std::lround((body ? (fat ? -95 : 45) : -990) + noise(random)));
        }
    }
    void paint(double value, const std::function<bool(glm::dvec3)>& inside) {
        const Grid& g = hu.grid();
        for (std::size_t n = 0; n < g.voxelCount(); ++n) {
            const glm::dvec3 v(g.voxelAt(n));
            if (inside(v)) hu.writable()[n] = std::int16_t(value);
        }
    }
    // An arch from low left over the top to low right, 26 voxels wide in the end: 52 mm.
    static bool inColon(glm::dvec3 v) {
        const double legs =
            std::min(std::hypot(v.x - 26, v.y - 55), std::hypot(v.x - 74, v.y - 55));
        const bool leg = v.z >= 15 && v.z < 70 && legs < 11;
        const double ring = std::hypot(std::hypot(v.x - 50, v.z - 70) - 24, v.y - 55);
        return leg || (v.z >= 70 && ring < 11);
    }
    static bool inLung(glm::dvec3 v) {
        return v.z > 110 && v.y > 30 && v.y < 80 && v.x > 20 && v.x < 80;
    }
    static bool inStomach(glm::dvec3 v) {
        return glm::length((v - glm::dvec3(52, 30, 92)) / glm::dvec3(9, 8, 7)) < 1;
    }
    static bool inIleum(glm::dvec3 v) {
        return glm::length((v - glm::dvec3(50, 72, 40)) / glm::dvec3(9, 6, 20)) < 1;
    }

    CtScan scan(PatientPosition position, int level = levelRow, bool up = false) {
        paint(-988, inColon);
        paint(620,
              [=](glm::dvec3 v) { return inColon(v) && (up ? v.y <= 110 - level : v.y >= level); });
        paint(-860, inLung);
        paint(-985, inStomach);
        paint(30, [](glm::dvec3 v) { return inStomach(v) && v.y > 30; });
        paint(400, inIleum);
        return {hu.share(), position};
    }
};

Result<topology::Lumen> find(const CtScan& scan, const topology::LumenOptions& options = {}) {
    const auto tissue = cleansing::fitTissueModel(scan);
    EXPECT_TRUE(tissue);
    return topology::findLumen(scan, *tissue, options);
}

std::size_t labelled(const topology::Lumen& lumen, const std::function<bool(glm::dvec3)>& where) {
    std::size_t count = 0;
    for (std::size_t n = 0; n < lumen.labels.grid().voxelCount(); ++n) {
        count += lumen.labels[n] != 0 && where(glm::dvec3(lumen.labels.grid().voxelAt(n)));
    }
    return count;
}

double diceWithDrawing(const topology::Lumen& lumen) {
    std::size_t both = 0, sum = 0;
    for (std::size_t n = 0; n < lumen.labels.grid().voxelCount(); ++n) {
        const bool truth = Drawing::inColon(glm::dvec3(lumen.labels.grid().voxelAt(n)));
        const bool found = lumen.labels[n] != 0;
        both += truth && found, sum += truth + found;
    }
    return 2.0 * double(both) / double(sum);
}

TEST(Lumen, IsTheColonWithItsFluidAndNothingElse) {
    const auto lumen = find(Drawing().scan(PatientPosition::supine));
    ASSERT_TRUE(lumen) << describe(lumen.error());
    EXPECT_GT(diceWithDrawing(*lumen), 0.995);
    EXPECT_EQ(labelled(*lumen, Drawing::inLung), 0u);
    EXPECT_EQ(labelled(*lumen, Drawing::inStomach), 0u);
    EXPECT_EQ(labelled(*lumen, Drawing::inIleum), 0u);
    EXPECT_EQ(lumen->segments.size(), 1u);
    EXPECT_EQ(lumen->gravity, glm::dvec3(0, 1, 0));
}

TEST(Lumen, EachVoxelIsLabelledByWhatItHolds) {
    const CtScan scan = Drawing().scan(PatientPosition::supine);
    const auto lumen = find(scan);
    ASSERT_TRUE(lumen);
    for (std::size_t n = 0; n < scan.hu.grid().voxelCount(); ++n) {
        const auto label = LumenLabel(lumen->labels[n]);
        if (label == LumenLabel::air) {
            ASSERT_LT(scan.hu[n], -400);
        }
        if (label == LumenLabel::tagged) {
            ASSERT_GE(scan.hu.grid().voxelAt(n).y, levelRow - 1);
        }
    }
}

TEST(Lumen, AProneSeriesHasItsFluidOnTheOtherSide) {
    const auto lumen = find(Drawing().scan(PatientPosition::prone, levelRow, true));
    ASSERT_TRUE(lumen) << describe(lumen.error());
    EXPECT_GT(diceWithDrawing(*lumen), 0.995);
    EXPECT_EQ(lumen->gravity, glm::dvec3(0, -1, 0));
    EXPECT_TRUE(lumen->notes.empty());
}

TEST(Lumen, LevelsOverruleAWrongPatientPosition) {
    const auto lumen = find(Drawing().scan(PatientPosition::supine, levelRow, true));
    ASSERT_TRUE(lumen);
    EXPECT_EQ(lumen->gravity, glm::dvec3(0, -1, 0));
    ASSERT_EQ(lumen->notes.size(), 1u);
    EXPECT_NE(lumen->notes[0].find("supine"), std::string::npos);
    EXPECT_GT(diceWithDrawing(*lumen), 0.995);
}

TEST(Lumen, GravityComesFromTheDataWhereThePositionIsUnknown) {
    const auto lumen = find(Drawing().scan(PatientPosition::unknown));
    ASSERT_TRUE(lumen);
    EXPECT_EQ(lumen->gravity, glm::dvec3(0, 1, 0));
    EXPECT_GT(diceWithDrawing(*lumen), 0.995);
}

TEST(Lumen, APersonCanAddAndRemovePieces) {
    const CtScan scan = Drawing().scan(PatientPosition::supine);
    topology::LumenOptions options;
    options.seedsMm = {scan.hu.grid().patientFromVoxelPoint({52, 26, 92})};
    auto withStomach = find(scan, options);
    ASSERT_TRUE(withStomach) << describe(withStomach.error());
    EXPECT_GT(labelled(*withStomach, Drawing::inStomach), 500u);

    options.seedsMm.clear();
    options.excludesMm = {scan.hu.grid().patientFromVoxelPoint({26, 70 - 6 + 0.0, 40}),
                          scan.hu.grid().patientFromVoxelPoint({74, 64, 40})};
    auto withoutFluid = find(scan, options);
    ASSERT_TRUE(withoutFluid) << describe(withoutFluid.error());
    EXPECT_EQ(labelled(*withoutFluid, [](glm::dvec3 v) { return v.y > levelRow + 1; }), 0u);

    options.excludesMm = {scan.hu.grid().patientFromVoxelPoint({50, 15, 20})};
    const auto nowhere = find(scan, options);
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().place, "100.0,30.0,40.0");
}

// A slab of bone against the wall, brighter than any fluid.
TEST(Lumen, DenseMaterialThatTouchesTheWallIsNotStool) {
    Drawing drawing;
    CtScan scan = drawing.scan(PatientPosition::supine);
    const auto inBone = [](glm::dvec3 v) {
        return v.x >= 38 && v.x < 62 && v.y > 45 && v.y < 85 && v.z >= 16 && v.z < 34;
    };
    drawing.paint(1200, inBone);
    scan.hu = drawing.hu.share();
    const auto lumen = find(scan);
    ASSERT_TRUE(lumen) << describe(lumen.error());
    EXPECT_EQ(labelled(*lumen, [&](glm::dvec3 v) { return inBone(v) && !Drawing::inColon(v); }),
              0u);
    EXPECT_GT(diceWithDrawing(*lumen), 0.99);
}

TEST(Lumen, ABodyWithoutGasHasNone) {
    Drawing drawing;
    const CtScan scan{drawing.hu.share(), PatientPosition::supine};
    const auto lumen = find(scan);
    ASSERT_FALSE(lumen);
    EXPECT_EQ(lumen.error().kind, ErrorKind::noResult);
}

TEST(Lumen, IsTheSameForAnyNumberOfThreads) {
    const CtScan scan = Drawing().scan(PatientPosition::supine);
    topology::LumenOptions one, three;
    one.threads = 1, three.threads = 3;
    const auto a = find(scan, one), b = find(scan, three);
    ASSERT_TRUE(a && b);
    EXPECT_TRUE(std::equal(a->labels.voxels().begin(), a->labels.voxels().end(),
                           b->labels.voxels().begin()));
}

TEST(Lumen, AgreesWithThePhantomsTruth) {
    for (PatientPosition position : {PatientPosition::supine, PatientPosition::prone}) {
        phantom::PhantomOptions options;
        options.size = phantom::Size::small;
        options.position = position;
        const auto made = phantom::makePhantom(options);
        ASSERT_TRUE(made);
        const auto lumen = find(made->scan);
        ASSERT_TRUE(lumen) << describe(lumen.error());
        const auto score =
            phantom::scoreLumen(made->lumen, made->centerline, lumen->labels, made->centerline);
        ASSERT_TRUE(score);
        EXPECT_GE(score->dice, 0.96);
        EXPECT_LE(score->falseMl, 5.0);
        // Voxels of 1.5 x 1.5 x 2 mm close some narrow places that a clinical scan keeps open.
        EXPECT_LE(score->missedCenterlineShare, 0.05);
    }
}

TEST(RunComponents, AgreeWithAFloodFill) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        const glm::ivec3 size(1 + random() % 9, 1 + random() % 9, 1 + random() % 9);
        Volume<std::int16_t> volume(axisAlignedGrid(size, {1, 1, 1}));
        for (auto& v : volume.writable())
            v = std::int16_t(random() % 3);
        const topology::RunComponents runs(volume, 1.5, 1 + int(seed % 3));
        const Grid& g = volume.grid();
        std::vector<int> flood(g.voxelCount(), -1);
        int count = 0;
        for (std::size_t n = 0; n < g.voxelCount(); ++n) {
            if (volume[n] >= 1.5 || flood[n] >= 0) continue;
            std::vector<std::size_t> stack{n};
            flood[n] = count;
            while (!stack.empty()) {
                const glm::ivec3 v = g.voxelAt(stack.back());
                stack.pop_back();
                for (int f = 0; f < 6; ++f) {
                    glm::ivec3 w = v;
                    w[f / 2] += f % 2 ? 1 : -1;
                    if (!g.contains(w) || volume.at(w) >= 1.5 || flood[g.index(w)] >= 0) continue;
                    flood[g.index(w)] = count;
                    stack.push_back(g.index(w));
                }
            }
            ++count;
        }
        ASSERT_EQ(int(runs.components().size()), count);
        std::uint64_t total = 0;
        for (const auto& c : runs.components())
            total += c.voxels;
        for (std::size_t n = 0; n < g.voxelCount(); ++n) {
            ASSERT_EQ(runs.at(g.voxelAt(n)), flood[n]);  // both number by the first voxel
            total -= flood[n] >= 0;
        }
        EXPECT_EQ(total, 0u);
    }
}

}  // namespace
