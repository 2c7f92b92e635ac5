// The fields that walls are contoured on: a mask's, and a scan's whose content is not air.
#include "contouring/wall_field.h"

#include "contouring/dual_contouring.h"
#include "core/ct_scan.h"
#include "core/tri_mesh.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace haustra::contouring {
namespace {

const Grid grid = axisAlignedGrid({50, 48, 40}, {0.8, 0.8, 1.1}, {-20.0, -15.0, 7.0});
const glm::dvec3 centerMm = grid.patientFromVoxelPoint({25.2, 23.7, 19.6});
constexpr double radiusMm = 12.3;

Volume<std::uint8_t> ball(double radius = radiusMm) {
    Volume<std::uint8_t> labels(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        labels.writable()[n] = glm::distance(p, centerMm) < radius;
    }
    return labels;
}

Volume<std::int16_t> scan(double contentHu, double aroundHu) {
    Volume<std::int16_t> hu(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const double mm =
            glm::distance(grid.patientFromVoxelPoint(grid.voxelAt(n)), centerMm) - radiusMm;
        const double share = 0.5 * std::erfc(mm / 0.8);
        hu.writable()[n] = std::int16_t(std::lround(share * contentHu + (1 - share) * aroundHu));
    }
    return hu;
}

TEST(WallField, AMasksIsTheBinomialOfItsVoxels) {
    const auto labels = ball();
    const WallField field = smoothedMask(labels, 2);
    EXPECT_EQ(field.isoHu, 0.0);
    constexpr int weights[] = {1, 4, 6, 4, 1};
    for (std::size_t n = 0; n < grid.voxelCount(); n += 101) {
        const glm::ivec3 v = grid.voxelAt(n);
        double sum = 0.0;
        for (int k = -2; k <= 2; ++k) {
            for (int j = -2; j <= 2; ++j) {
                for (int i = -2; i <= 2; ++i) {
                    const glm::ivec3 at =
                        glm::clamp(v + glm::ivec3(i, j, k), glm::ivec3(0), grid.size - 1);
                    sum += weights[i + 2] * weights[j + 2] * weights[k + 2] *
                           (labels.at(at) ? -1000.0 : 1000.0) / 4096.0;
                }
            }
        }
        ASSERT_NEAR(field.hu[n], sum, 1.0);
    }
    const WallField one = smoothedMask(labels, 1);
    EXPECT_TRUE(std::ranges::equal(one.hu.voxels(), field.hu.voxels()));
}

// Soundness: contouring at 0 is nearer to the ball than the staircase of its voxels, whose wall is
// midway between voxel centres everywhere, and stands to neither side.
TEST(WallField, AMasksSurfaceIsNoStaircase) {
    const auto labels = ball();
    const auto deviation = [&](const Volume<std::int16_t>& hu) {
        const TriMesh mesh = contourLumen(hu, labels, 0.0).value();
        EXPECT_TRUE(meshTopology(mesh).closed());
        EXPECT_EQ(meshTopology(mesh).eulerCharacteristic, 2);
        double mean = 0.0, square = 0.0;
        for (const glm::dvec3& v : mesh.vertices) {
            const double mm = glm::distance(v, centerMm) - radiusMm;
            mean += mm, square += mm * mm;
        }
        const double count = double(mesh.vertices.size());
        return glm::dvec2(mean / count, std::sqrt(square / count));
    };
    Volume<std::int16_t> steps(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        steps.writable()[n] = labels[n] ? -1000 : 1000;
    const glm::dvec2 smooth = deviation(smoothedMask(labels).hu), stairs = deviation(steps);
    EXPECT_LT(smooth.y, 0.75 * stairs.y);
    EXPECT_LT(smooth.y, 0.15);
    EXPECT_LT(std::abs(smooth.x), 0.06);
}

TEST(WallField, ThinMasksKeepTheirTopology) {
    Volume<std::uint8_t> line(grid, 0);
    for (int i = 5; i < 45; ++i)
        line.writable()[grid.index(i, 20, 20)] = 1;
    const TriMesh mesh = contourLumen(smoothedMask(line).hu, line, 0.0).value();
    EXPECT_TRUE(meshTopology(mesh).closed());
    EXPECT_EQ(meshTopology(mesh).eulerCharacteristic, 2);
}

TEST(WallField, ContentsWallIsMidwayAndRisesOutwards) {
    for (const glm::dvec2 hu :
         {glm::dvec2(300, 40), glm::dvec2(5, 60), glm::dvec2(-900, 40), glm::dvec2(5, -100)}) {
        const auto field = contentField(scan(hu.x, hu.y), ball(), 2);
        ASSERT_TRUE(field) << describe(field.error());
        EXPECT_EQ(field->negated, hu.x > hu.y);
        EXPECT_NEAR(field->negated ? -field->isoHu : field->isoHu, 0.5 * (hu.x + hu.y), 1.0);
        const glm::ivec3 middle(25, 24, 20);
        EXPECT_LT(field->hu.at(middle), field->isoHu);
        EXPECT_GT(field->hu.at(0, 0, 0), field->isoHu);
        const TriMesh mesh = contourLumen(field->hu, ball(), field->isoHu).value();
        double sum = 0.0;
        for (const glm::dvec3& v : mesh.vertices)
            sum += std::abs(glm::distance(v, centerMm) - radiusMm);
        EXPECT_LT(sum / double(mesh.vertices.size()), 0.06) << hu.x;
    }
}

TEST(WallField, WhatShowsNoWallIsRefused) {
    EXPECT_FALSE(contentField(scan(40, 44), ball()));
    EXPECT_FALSE(contentField(scan(300, 40), Volume<std::uint8_t>(grid, 0)));
    EXPECT_FALSE(contentField(scan(300, 40), Volume<std::uint8_t>(grid, 1)));
    const Grid other = axisAlignedGrid({3, 3, 3}, {1, 1, 1});
    EXPECT_FALSE(contentField(scan(300, 40), Volume<std::uint8_t>(other, 1)));
    // The lowest HU of all has no counterpart; it must not change sides.
    auto hu = scan(300, 40);
    hu.writable()[0] = -32768;
    EXPECT_EQ(contentField(hu, ball())->hu[0], 32767);
}

}  // namespace
}  // namespace haustra::contouring
