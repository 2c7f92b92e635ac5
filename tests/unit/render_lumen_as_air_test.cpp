// Tagged residue shown as air, against the scan that would have been without residue.
#include "render/lumen_as_air.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace haustra::render {
namespace {

/// A tube along z, half full of fluid up to a level in y, as a scanner blurs it.
struct Phantom {
    Volume<std::int16_t> tagged, dry;
    Volume<std::uint8_t> lumen;
};

constexpr double radius = 10.0, level = 1.5, softHu = 40.0, airHu = -1000.0, fluidHu = 700.0;

Phantom makePhantom(double blurMm) {
    const Grid grid = axisAlignedGrid({40, 40, 12}, {0.7, 0.7, 1.0}, {-13.65, -13.65, 0.0});
    Phantom phantom{Volume<std::int16_t>(grid), Volume<std::int16_t>(grid),
                    Volume<std::uint8_t>(grid)};
    const auto edge = [&](double distanceMm) {
        return 0.5 + 0.5 * std::erf(distanceMm / (std::sqrt(2.0) * blurMm));
    };
    for (std::size_t i = 0; i < grid.voxelCount(); ++i) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(i)));
        const double inside = edge(radius - std::hypot(p.x, p.y)), submerged = edge(p.y - level);
        const double content = submerged * fluidHu + (1.0 - submerged) * airHu;
        const double hu = inside * content + (1.0 - inside) * softHu;
        phantom.tagged.writable()[i] = std::int16_t(std::lround(hu));
        phantom.dry.writable()[i] =
            std::int16_t(std::lround(inside * airHu + (1.0 - inside) * softHu));
        // As a classifier labels it: what is not clearly air in the lumen is tagged.
        const bool isLumen = std::hypot(p.x, p.y) < radius;
        phantom.lumen.writable()[i] = std::uint8_t(!isLumen      ? LumenLabel::outside
                                                   : hu < -480.0 ? LumenLabel::air
                                                                 : LumenLabel::tagged);
        // Wall voxels half filled by air are not tagged.
        if (isLumen && hu >= -480.0 && p.y < level - 3.0) phantom.lumen.writable()[i] = 0;
    }
    return phantom;
}

TEST(LumenAsAir, TheWallLiesWhereItWouldWithoutFluid) {
    const Phantom phantom = makePhantom(0.6);
    const Volume<std::int16_t> cleared = lumenAsAir(phantom.tagged, phantom.lumen, 2);
    // Along rays from the middle: where the mucosa's ramp begins, −600 HU.
    for (double angle = 0.0; angle < 6.28; angle += 0.1) {
        const auto wallAt = [&](const Volume<std::int16_t>& volume) {
            for (double r = 0.0; r < 13.0; r += 0.01) {
                const glm::dvec3 p(r * std::cos(angle), r * std::sin(angle), 5.0);
                if (trilinear(volume, volume.grid().voxelFromPatientPoint(p)) > -600.0) return r;
            }
            return 13.0;
        };
        EXPECT_NEAR(wallAt(cleared), wallAt(phantom.dry), 0.7) << "angle " << angle;
    }
}

TEST(LumenAsAir, NoShellFloatsInTheLumen) {
    const Phantom phantom = makePhantom(0.6);
    const Volume<std::int16_t> cleared = lumenAsAir(phantom.tagged, phantom.lumen, 2);
    for (std::size_t i = 0; i < cleared.grid().voxelCount(); ++i) {
        const glm::dvec3 p =
            cleared.grid().patientFromVoxelPoint(glm::dvec3(cleared.grid().voxelAt(i)));
        if (std::hypot(p.x, p.y) > radius - 2.0) continue;
        EXPECT_LT(cleared[i], -850) << p.x << " " << p.y;
    }
}

TEST(LumenAsAir, WhatIsFarFromResidueStays) {
    const Phantom phantom = makePhantom(0.6);
    const Volume<std::int16_t> cleared = lumenAsAir(phantom.tagged, phantom.lumen, 2);
    for (std::size_t i = 0; i < cleared.grid().voxelCount(); ++i) {
        const glm::dvec3 p =
            cleared.grid().patientFromVoxelPoint(glm::dvec3(cleared.grid().voxelAt(i)));
        if (p.y > level - 5.0 && std::hypot(p.x, p.y) < radius + 3.0) continue;
        EXPECT_EQ(cleared[i], phantom.tagged[i]);
    }
}

TEST(LumenAsAir, AThinWallBetweenAirAndAnotherLoopsResidueStaysClosed) {
    // Slanted, so that its voxels touch by edges: 0.7 mm of wall, all blur.
    const Grid grid = axisAlignedGrid({40, 40, 6}, glm::dvec3(0.7));
    const glm::dvec3 across = glm::normalize(glm::dvec3(1.0, 0.45, 0.0));
    Volume<std::int16_t> ct(grid);
    Volume<std::uint8_t> lumen(grid);
    const auto edge = [](double mm) { return 0.5 + 0.5 * std::erf(mm / (std::sqrt(2.0) * 0.6)); };
    for (std::size_t i = 0; i < grid.voxelCount(); ++i) {
        const double mm =
            glm::dot(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(i))), across) - 18.0;
        const double air = 1.0 - edge(mm + 0.35), residue = edge(mm - 0.35);
        ct.writable()[i] = std::int16_t(
            std::lround(air * airHu + residue * fluidHu + (1.0 - air - residue) * softHu));
        lumen.writable()[i] = std::uint8_t(mm < -0.35  ? LumenLabel::air
                                           : mm > 0.35 ? LumenLabel::tagged
                                                       : LumenLabel::outside);
    }
    const Volume<std::int16_t> cleared = lumenAsAir(ct, lumen, 2);
    for (double along = -6.0; along < 6.0; along += 0.1) {
        double densest = airHu;
        for (double mm = -3.0; mm < 3.0; mm += 0.05) {
            const glm::dvec3 p =
                (18.0 + mm) * across + along * glm::dvec3(-across.y, across.x, 0.0);
            const glm::dvec3 voxel = grid.voxelFromPatientPoint(p + glm::dvec3(0.0, 0.0, 2.0));
            densest = std::max(densest, trilinear(cleared, voxel));
        }
        EXPECT_GT(densest, -550.0) << along;
    }
}

TEST(LumenAsAir, WhatIsLabelledButNoDenserThanAWallStays) {
    const Grid grid = axisAlignedGrid({9, 9, 9}, glm::dvec3(1.0));
    const Volume<std::int16_t> ct(grid, 120);
    Volume<std::uint8_t> lumen(grid, 0);
    lumen.writable()[grid.index(4, 4, 4)] = std::uint8_t(LumenLabel::tagged);
    const Volume<std::int16_t> cleared = lumenAsAir(ct, lumen, 1);
    for (const std::int16_t hu : cleared.voxels())
        EXPECT_EQ(hu, 120);
}

TEST(LumenAsAir, IsTheSameForAnyNumberOfThreads) {
    const Phantom phantom = makePhantom(0.8);
    const auto one = lumenAsAir(phantom.tagged, phantom.lumen, 1),
               four = lumenAsAir(phantom.tagged, phantom.lumen, 4);
    EXPECT_TRUE(std::equal(one.voxels().begin(), one.voxels().end(), four.voxels().begin()));
}

}  // namespace
}  // namespace haustra::render
