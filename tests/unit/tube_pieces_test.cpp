// Contents of the bowel cut at necks: what is one lumen stays one piece.
#include "segmentation/tube_pieces.h"

#include "segmentation/bowel_contents.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;
using segmentation::Content;
using segmentation::cutIntoPieces;
using segmentation::TubePieces;

namespace {

/// Tubes of gas along z, 80 mm long and 10 mm in radius, about these axes.
TubePieces tubes(const std::vector<glm::dvec2>& axes) {
    const Grid grid = axisAlignedGrid({80, 60, 100}, glm::dvec3(1.0), {-20, -20, -10});
    Volume<std::int16_t> hu(grid, std::int16_t(40));
    Volume<std::uint8_t> content(grid, std::uint8_t(Content::tissue)), walls(grid, std::uint8_t(0));
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        for (const glm::dvec2 axis : axes) {
            if (p.z < 0.0 || p.z > 80.0 || glm::distance(glm::dvec2(p), axis) > 10.0) continue;
            hu.writable()[n] = -1000;
            content.writable()[n] = std::uint8_t(Content::gas);
        }
    }
    return cutIntoPieces(hu, content, walls, {});
}

TEST(TubePieces, TwoTubesThatOpenToEachOtherAreTwo) {
    const TubePieces cut = tubes({{0, 0}, {17, 0}});
    ASSERT_EQ(cut.pieces.size(), 2u);
    ASSERT_EQ(cut.orifices.size(), 1u);
    EXPECT_NEAR(cut.orifices[0].radiusMm, 6.0, 1.5);
}

TEST(TubePieces, ThreeInARowAreThree) {
    EXPECT_EQ(tubes({{0, 0}, {17, 0}, {34, 0}}).pieces.size(), 3u);
}

TEST(TubePieces, AHairpinOfThreeIsThree) {
    EXPECT_EQ(tubes({{0, 0}, {17.8, 0}, {8.9, 15.4}}).pieces.size(), 3u);
}

// No tube has stretches that all open to each other: it is one body with folds in it.
TEST(TubePieces, FourSideBySideAreOneLumen) {
    const TubePieces cut = tubes({{0, 0}, {17.8, 0}, {8.9, 15.4}, {26.7, 15.4}});
    ASSERT_EQ(cut.pieces.size(), 1u);
    EXPECT_TRUE(cut.orifices.empty());
    std::size_t voxels = 0;
    for (const std::int32_t piece : cut.pieceAt.voxels())
        voxels += piece == 0;
    EXPECT_EQ(cut.pieces[0].voxels, voxels);
    EXPECT_NEAR(cut.pieces[0].volumeMl, 4 * 25.4 - 5.0, 5.0);
}

// Settled tagging grows denser downwards, in layers, and is no less even for it; what does so
// upwards, or sideways, is uneven.
TEST(TubePieces, LayersOfSedimentAreEven) {
    const auto coreSdHu = [](glm::dvec3 huPerMm, segmentation::GravityAxis down) {
        const Grid grid = axisAlignedGrid({40, 40, 40}, glm::dvec3(1.0), {-20, -20, -20});
        Volume<std::int16_t> hu(grid, std::int16_t(40));
        Volume<std::uint8_t> content(grid, std::uint8_t(Content::tissue)),
            walls(grid, std::uint8_t(0));
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
            if (glm::length(p) > 15.0) continue;
            hu.writable()[n] = std::int16_t(std::lround(700.0 + glm::dot(huPerMm, p)));
            content.writable()[n] = std::uint8_t(Content::tagged);
        }
        const TubePieces cut = cutIntoPieces(hu, content, walls, {.down = down});
        EXPECT_EQ(cut.pieces.size(), 1u);
        EXPECT_NEAR(cut.pieces[0].coreHu, 700.0, 1.0);
        return cut.pieces[0].coreSdHu;
    };
    EXPECT_LT(coreSdHu({0, 12, 0}, {1, 1}), 1.0);
    EXPECT_LT(coreSdHu({0, -12, 0}, {1, -1}), 1.0);
    EXPECT_LT(coreSdHu({12, 0, 0}, {0, 1}), 1.0);
    const double all = 12.0 * 12.5 / std::sqrt(5.0);  // of a ball of that radius
    EXPECT_NEAR(coreSdHu({0, -12, 0}, {1, 1}), all, 3.0);
    EXPECT_NEAR(coreSdHu({12, 0, 0}, {1, 1}), all, 3.0);
    EXPECT_NEAR(coreSdHu({0, 0, 12}, {1, 1}), all, 3.0);
}

}  // namespace
