// What is clicked and measured on a conformal map is what is on the surface.
#include "analytic_tubes.h"
#include "core/flat_lookup.h"
#include "flatten/tube/conformal_tube.h"
#include "flatten/tube/seam.h"
#include "flatten/tube/unified_flattening.h"
#include "tube_meshes.h"

#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

const tests::HalfBall polyp{.middle = {0.98, 0.35}};

/// 0.3 mm fine around the polyp, and coarser away from it.
TriMesh polypTube() {
    constexpr double turn = 2.0 * std::numbers::pi;
    return tests::tubeMesh(100, 80, [](double a, double s) {
        return polyp.position(a - 0.8 / turn * std::sin(turn * (a - polyp.middle.x)),
                              2.0 * polyp.middle.y * (s + 0.8 / turn * std::sin(turn * s)));
    });
}

/// The polyp's tube as readers get it, its areas evened out by `areaWeight`; the seam runs through
/// the polyp.
FlatLookup lookupOf(double areaWeight) {
    const TriMesh tube = polypTube();
    auto made = conformalTube(tube);
    EXPECT_TRUE(made);
    UnifiedOptions options;
    options.areaWeight = areaWeight;
    auto map = unifiedFlattening(tube, made->map, options);
    EXPECT_TRUE(map);
    int top = 0;
    for (std::size_t v = 0; v < tube.vertices.size(); ++v) {
        const auto reach = [&](std::size_t of) {
            return std::hypot(tube.vertices[of].x, tube.vertices[of].y);
        };
        if (reach(v) < reach(std::size_t(top))) top = int(v);
    }
    FlatMap cut = cutAlongSeam(tube, *map, map->flat[std::size_t(top)].x);
    cut.cameras.push_back({});
    cut.camera.assign(cut.flat.size(), 0);
    return FlatLookup(std::make_shared<const FlatMap>(std::move(cut)));
}

TEST(FlatMeasure, PixelsComeBack) {
    constexpr double pixelsPerUnit = 1600.0;
    for (const double areaWeight : {0.0, 0.5}) {
        const FlatLookup lookup = lookupOf(areaWeight);
        const auto rows = unsigned(pixelsPerUnit * lookup.map().height);
        std::mt19937 random(1);
        for (int n = 0; n < 10000; ++n) {
            const glm::dvec2 pixel(random() % 1600 + 0.5, random() % rows + 0.5);
            const auto place = lookup.at(pixel / pixelsPerUnit);
            ASSERT_TRUE(place);
            const WallPlace back = lookup.nearest(place->positionMm);
            const double around = std::remainder(back.flat.x - place->flat.x, 1.0);
            EXPECT_LT(pixelsPerUnit * std::abs(around), 0.01);
            EXPECT_LT(pixelsPerUnit * std::abs(back.flat.y - place->flat.y), 0.01);
        }
    }
}

// Clicked to the pixel of the finer strip on two opposite places of its foot.
TEST(FlatMeasure, PolypReadsItsDiameter) {
    constexpr double pixelsPerUnit = 1600.0;
    for (const double areaWeight : {0.0, 0.5}) {
        const FlatLookup lookup = lookupOf(areaWeight);
        std::vector<glm::dvec2> outline;
        for (int n = 0; n < 72; ++n) {
            const double azimuth = std::numbers::pi * n / 36.0;
            const auto click = [&](double direction) {
                const glm::dvec2 foot = polyp.foot(direction);
                const glm::dvec2 flat = lookup.nearest(polyp.position(foot.x, foot.y)).flat;
                return (glm::floor(pixelsPerUnit * flat) + 0.5) / pixelsPerUnit;
            };
            const glm::dvec2 from = click(azimuth);
            glm::dvec2 to = click(azimuth + std::numbers::pi);
            to.x += std::round(from.x - to.x);  // across the seam
            EXPECT_NEAR(lookup.path(from, to).straightMm, 2.0 * polyp.ballMm, 0.5);
            outline.push_back(from);
            outline.back().x += std::round(outline.front().x - from.x);
        }
        EXPECT_NEAR(lookup.areaMm2(outline), polyp.areaMm2(), 0.05 * polyp.areaMm2());
    }
}

}  // namespace
}  // namespace haustra::flatten
