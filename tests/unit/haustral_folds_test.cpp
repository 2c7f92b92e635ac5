// Folds of the lumen's wall: sheets that stand into one lumen, and nothing else.
#include "segmentation/haustral_folds.h"

#include "segmentation/bowel_contents.h"

#include <functional>

#include <gtest/gtest.h>

using namespace haustra;
using segmentation::Content;
using segmentation::cutIntoPieces;
using segmentation::foldDensityMm;
using segmentation::TubePieces;

namespace {

constexpr double radiusMm = 16.0, lengthMm = 100.0;

/// Of the largest piece, of what `isLumen(patient point)` and holds `content`.
double densityOf(double voxelMm, Content content, const std::function<bool(glm::dvec3)>& isLumen) {
    const glm::dvec3 lo(-22, -22, -10), hi(60, 22, lengthMm + 10);
    const Grid grid =
        axisAlignedGrid(glm::ivec3(glm::ceil((hi - lo) / voxelMm)), glm::dvec3(voxelMm), lo);
    Volume<std::int16_t> hu(grid, std::int16_t(40));
    Volume<std::uint8_t> contents(grid, std::uint8_t(Content::tissue)),
        walls(grid, std::uint8_t(0));
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        if (p.z < 0.0 || p.z > lengthMm || !isLumen(p)) continue;
        hu.writable()[n] = content == Content::gas ? -1000 : 500;
        contents.writable()[n] = std::uint8_t(content);
    }
    const TubePieces cut = cutIntoPieces(hu, contents, walls, {});
    return foldDensityMm(cut, walls, 2).at(0);
}

bool inTube(glm::dvec3 p, double x = 0.0) {
    return glm::length(glm::dvec2(p.x - x, p.y)) <= radiusMm;
}
/// Sheets of 2.8 mm that stand in by 7 mm on one side, every `spacingMm`.
bool inFold(glm::dvec3 p, double spacingMm) {
    return std::abs(std::remainder(p.z - 0.5 * spacingMm, spacingMm)) <= 1.4 &&
           p.x < -radiusMm + 7.0;
}

TEST(HaustralFolds, ASmoothTubeHasNone) {
    EXPECT_LT(densityOf(1.0, Content::gas, [](glm::dvec3 p) { return inTube(p); }), 0.002);
}

TEST(HaustralFolds, TheirVolumeOverTheWall) {
    // Of a segment 7 mm high what lies 2.5 mm deep is a segment of 4.5 mm, seen from the axis at
    // 13.5 mm: its area times the thickness, over the tube's wall and ends.
    const double deep = radiusMm - 2.5, cosine = (radiusMm - 7.0) / deep;
    const double area = deep * deep * (std::acos(cosine) - cosine * std::sqrt(1 - cosine * cosine));
    const double wall = 4.0 / M_PI * 2.0 * M_PI * radiusMm * lengthMm +  // voxels' faces
                        2.0 * M_PI * radiusMm * radiusMm;
    for (const double voxelMm : {0.7, 1.0, 1.4}) {
        for (const double spacingMm : {20.0, 50.0}) {
            const double expected = lengthMm / spacingMm * 2.8 * area / wall;
            const double found = densityOf(voxelMm, Content::gas, [&](glm::dvec3 p) {
                return inTube(p) && !inFold(p, spacingMm);
            });
            EXPECT_NEAR(found, expected, 0.35 * expected) << voxelMm << ' ' << spacingMm;
        }
    }
}

TEST(HaustralFolds, AWallBetweenTwoLoopsIsNone) {
    const double beside = 2.0 * radiusMm + 2.5;
    EXPECT_LT(
        densityOf(1.0, Content::gas, [&](glm::dvec3 p) { return inTube(p) || inTube(p, beside); }),
        0.002);
}

TEST(HaustralFolds, AreNotSoughtInBone) {
    EXPECT_EQ(
        densityOf(1.0, Content::tagged, [](glm::dvec3 p) { return inTube(p) && !inFold(p, 20.0); }),
        -1.0);
}

}  // namespace
