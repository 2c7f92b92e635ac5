#include "phantom/score.h"

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::phantom;

namespace {

/// A tube of half-width `half` voxels along k through the middle of a 40×40×60 grid.
Volume<std::uint8_t> boxTube(const Grid& grid, int half, std::uint8_t label = 1) {
    Volume<std::uint8_t> volume(grid, 0);
    for (int k = 5; k < 55; ++k) {
        for (int j = 20 - half; j <= 20 + half; ++j) {
            for (int i = 20 - half; i <= 20 + half; ++i)
                volume.writable()[grid.index(i, j, k)] = label;
        }
    }
    return volume;
}

Centerline straight(const Grid& grid, glm::dvec3 offsetMm) {
    Centerline line;
    for (int k = 5; k < 55; ++k) {
        CenterlinePoint point;
        point.positionMm = grid.patientFromVoxelPoint({20, 20, k}) + offsetMm;
        point.arcMm = k - 5;
        point.radiusMm = 4;
        line.points.push_back(point);
    }
    return line;
}

const Grid phantomGrid = axisAlignedGrid({40, 40, 60}, {1, 1, 1}, {-20, 7, 100});

TEST(PhantomScore, TruthAgainstItselfIsPerfect) {
    const auto truth = boxTube(phantomGrid, 4);
    const auto line = straight(phantomGrid, glm::dvec3(0));
    const auto score = scoreLumen(truth, line, truth, line);
    ASSERT_TRUE(score.has_value());
    EXPECT_EQ(score->dice, 1.0);
    EXPECT_EQ(score->diceAir, 1.0);
    EXPECT_EQ(score->diceTagged, 1.0);  // both empty
    EXPECT_EQ(score->overMl, 0.0);
    EXPECT_EQ(score->falseMl, 0.0);
    EXPECT_EQ(score->missedMl, 0.0);
    EXPECT_EQ(score->missedCenterlineMm, 0.0);
    EXPECT_LT(score->centerlineMaxErrorMm, 1e-12);
}

TEST(PhantomScore, DiceAndVolumesCountVoxels) {
    const auto truth = boxTube(phantomGrid, 4), found = boxTube(phantomGrid, 5);
    const auto line = straight(phantomGrid, glm::dvec3(0));
    const auto score = scoreLumen(truth, line, found, line);
    const double a = 81 * 50, b = 121 * 50;
    EXPECT_DOUBLE_EQ(score->dice, 2 * a / (a + b));
    EXPECT_DOUBLE_EQ(score->overMl, (b - a) * 1e-3);
    EXPECT_EQ(score->falseMl, 0.0) << "one voxel too wide is no other organ";
    EXPECT_EQ(score->missedMl, 0.0);
    const auto narrow = scoreLumen(found, line, truth, line);
    EXPECT_DOUBLE_EQ(narrow->missedMl, (b - a) * 1e-3);
    EXPECT_EQ(narrow->overMl, 0.0);
}

TEST(PhantomScore, FalseVolumeLiesBeyondThreeMillimetres) {
    const auto truth = boxTube(phantomGrid, 4);
    auto found = boxTube(phantomGrid, 4);
    // A second organ: 3 mm away nothing is false yet, farther all is.
    for (int i = 25; i <= 30; ++i)
        found.writable()[phantomGrid.index(i, 20, 30)] = 1;
    const auto line = straight(phantomGrid, glm::dvec3(0));
    const auto score = scoreLumen(truth, line, found, line);
    EXPECT_DOUBLE_EQ(score->overMl, 6e-3);
    EXPECT_DOUBLE_EQ(score->falseMl, 3e-3);
}

TEST(PhantomScore, LabelsAreScoredApart) {
    const auto truth = boxTube(phantomGrid, 4, 2), found = boxTube(phantomGrid, 4, 1);
    const auto line = straight(phantomGrid, glm::dvec3(0));
    const auto score = scoreLumen(truth, line, found, line);
    EXPECT_EQ(score->dice, 1.0);
    EXPECT_EQ(score->diceAir, 0.0);
    EXPECT_EQ(score->diceTagged, 0.0);
}

TEST(PhantomScore, MissedCenterlineLeavesGapsOut) {
    const auto truth = boxTube(phantomGrid, 4);
    auto found = boxTube(phantomGrid, 4);
    for (int k = 30; k < 55; ++k)
        found.writable()[phantomGrid.index(20, 20, k)] = 0;
    auto line = straight(phantomGrid, glm::dvec3(0));
    const auto score = scoreLumen(truth, line, found, line);
    EXPECT_DOUBLE_EQ(score->missedCenterlineMm, 24.5);  // samples 25…49; the last stands for half
    EXPECT_DOUBLE_EQ(score->missedCenterlineShare, 24.5 / 49.0);
    for (std::size_t n = 25; n < 50; ++n)
        line.points[n].gap = true;
    EXPECT_EQ(scoreLumen(truth, line, found, line)->missedCenterlineMm, 0.0);
}

TEST(PhantomScore, CenterlineErrorIsTheDistanceToThePolyline) {
    const auto truth = boxTube(phantomGrid, 4);
    const auto line = straight(phantomGrid, glm::dvec3(0));
    auto moved = straight(phantomGrid, {0, 1.5, 0.4});
    moved.points.back().positionMm.z -= 1.0;
    moved.points[10].positionMm.y += 3.0;
    moved.points[20].positionMm.y += 9.0, moved.points[20].gap = true;
    const auto score = scoreLumen(truth, line, truth, moved);
    EXPECT_DOUBLE_EQ(score->centerlineMaxErrorMm, 4.5);
    EXPECT_NEAR(score->centerlineMeanErrorMm, 1.5 + 3.0 / 49.0, 1e-12);
}

TEST(PhantomScore, RefusesAnotherGrid) {
    const Grid other = axisAlignedGrid({40, 40, 60}, {1, 1, 1.1});
    const auto line = straight(phantomGrid, glm::dvec3(0));
    EXPECT_FALSE(scoreLumen(boxTube(phantomGrid, 4), line, boxTube(other, 4), line).has_value());
}

}  // namespace
