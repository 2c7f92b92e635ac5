// Laws of the path in the middle of the lumen's cross-sections.
#include "centerline/cross_sections.h"
#include "centerline/path.h"
#include "centerline/spline.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::centerline;

namespace {

// A tube whose axis is a quarter of a circle, with haustra on one side: sacs of half its radius.
constexpr double bendMm = 45.0, radiusMm = 12.0;

glm::dvec3 onAxis(double angle) {
    return {bendMm * std::cos(angle), bendMm * std::sin(angle), 0.0};
}
bool inTube(glm::dvec3 p, double sacMm) {
    const double angle = std::atan2(p.y, p.x);
    if (angle < 0.05 || angle > M_PI / 2 - 0.05) return false;
    const double aside = std::hypot(p.x, p.y) - bendMm;
    const double wide =
        radiusMm + sacMm * std::max(0.0, aside / radiusMm) * std::pow(std::sin(14.0 * angle), 2);
    return std::hypot(aside, p.z) < wide;
}
Volume<std::uint8_t> tube(double sacMm) {
    Volume<std::uint8_t> labels(axisAlignedGrid({75, 75, 45}, glm::dvec3(1.0), {-5, -5, -22}));
    for (std::size_t n = 0; n < labels.voxels().size(); ++n)
        labels.writable()[n] =
            inTube(labels.grid().patientFromVoxelPoint(labels.grid().voxelAt(n)), sacMm);
    return labels;
}
double offAxisMm(glm::dvec3 p) {
    return std::hypot(std::hypot(p.x, p.y) - bendMm, p.z);
}
double meanOffAxisMm(const std::vector<glm::dvec3>& points) {
    double sum = 0.0;
    for (const glm::dvec3 p : points)
        sum += offAxisMm(p);
    return sum / double(points.size());
}

TEST(CrossSections, BringACurveBackToTheAxis) {
    const Volume<std::uint8_t> labels = tube(0.0);
    const Volume<float> distanceMm = topology::distanceToBoundaryMm(labels, 1);
    std::vector<glm::dvec3> curve;  // cuts the bend short by up to 7 mm
    for (int n = 0; n <= 200; ++n) {
        const double t = double(n) / 200.0, angle = 0.15 + t * (M_PI / 2 - 0.3);
        curve.push_back(onAxis(angle) * (1.0 - 7.0 / bendMm * std::sin(M_PI * t)));
    }
    const auto moved = atCrossSections(curve, labels, distanceMm, 1);
    EXPECT_GT(meanOffAxisMm(curve), 4.0);
    EXPECT_LT(meanOffAxisMm(moved), 0.6);
    EXPECT_LT(glm::distance(moved.front(), curve.front()), 1e-9);
    EXPECT_LT(glm::distance(moved.back(), curve.back()), 1e-9);
    const auto again = atCrossSections(curve, labels, distanceMm, 4);
    EXPECT_TRUE(std::equal(moved.begin(), moved.end(), again.begin(), again.end()));
}

TEST(CrossSections, StayOffTheWallAndInBridgesWhereTheyAre) {
    Volume<std::uint8_t> labels = tube(6.0);
    const Volume<float> distanceMm = topology::distanceToBoundaryMm(labels, 1);
    std::vector<glm::dvec3> curve;
    for (int n = 0; n <= 200; ++n)
        curve.push_back(onAxis(0.15 + n / 200.0 * (M_PI / 2 - 0.3)) + glm::dvec3(0, 0, 4));
    const auto moved = atCrossSections(curve, labels, distanceMm, 1);
    for (const glm::dvec3 p : moved) {
        const glm::dvec3 v = labels.grid().voxelFromPatientPoint(p);
        EXPECT_GT(trilinear(distanceMm, v), 3.0);
    }
    for (std::uint8_t& label : labels.writable())
        label = label ? 3 : 0;
    const auto still = atCrossSections(curve, labels, distanceMm, 1);
    for (const glm::dvec3 p : still)
        EXPECT_NEAR(p.z, 4.0, 1e-9);
}

// Two wide stretches that a thread of single voxels joins, to and fro, as a bridge across a
// collapse on a coarse grid may: no spline follows its turns, however little it smooths there.
TEST(SmoothInsideLumen, IsAsLongAsItsPathWhereNoSplineFits) {
    Volume<std::uint8_t> labels(axisAlignedGrid({60, 60, 60}, glm::dvec3(1.9)));
    const auto set = [&](glm::ivec3 v) { labels.writable()[labels.grid().index(v)] = 1; };
    for (int k = 0; k < 60; ++k) {
        for (int j = 0; j < 60; ++j) {
            for (int i = 0; i < 60; ++i) {
                const glm::dvec2 aside(i - 30, j - 30);
                if (glm::length(aside) < 9.0 && k > 2 && k < 57 && (k < 20 || k > 40))
                    set({i, j, k});
            }
        }
    }
    std::vector<glm::ivec3> path;
    for (int k = 5; k < 20; ++k)
        path.push_back({30, 30, k});
    glm::ivec3 at(30, 30, 19);
    const auto go = [&](int axis, int sign, int voxels) {
        for (; voxels > 0; --voxels)
            at[axis] += sign, path.push_back(at), set(at);
    };
    for (int n = 0; at.z <= 38;
         ++n) {  // by edges, with a voxel that leads face by face on one side
        glm::ivec3 side = at;
        side[2] += 1, set(side);
        at = side, at[n % 2] += n / 2 % 2 ? 1 : -1;
        path.push_back(at), set(at);
    }
    go(2, 1, 41 - at.z);
    go(2, 1, 14);
    const auto curve = smoothInsideLumen(path, labels, topology::distanceToBoundaryMm(labels, 1));
    double pathMm = 0.0, curveMm = 0.0, longestMm = 0.0;
    for (std::size_t n = 1; n < path.size(); ++n)
        pathMm += 1.9 * glm::length(glm::dvec3(path[n] - path[n - 1]));
    for (std::size_t n = 1; n < curve.size(); ++n) {
        curveMm += glm::distance(curve[n], curve[n - 1]);
        longestMm = std::max(longestMm, glm::distance(curve[n], curve[n - 1]));
    }
    EXPECT_LT(curveMm, 1.1 * pathMm);
    EXPECT_LT(longestMm, 1.9);
    for (const glm::dvec3 p : curve)
        EXPECT_TRUE(insideLumen(labels, labels.grid().voxelFromPatientPoint(p)));
}

TEST(StaysInside, SeesAWallOneVoxelThickHoweverItLies) {
    Volume<std::uint8_t> labels(axisAlignedGrid({20, 20, 20}, glm::dvec3(1.0)), std::uint8_t(1));
    // Oblique, and parted face by face alone: its voxels touch at edges and corners.
    for (std::size_t n = 0; n < labels.voxels().size(); ++n) {
        const glm::ivec3 v = labels.grid().voxelAt(n);
        labels.writable()[n] = v.x + v.y + v.z != 28;
    }
    for (int n = 0; n < 500; ++n) {
        const glm::dvec3 a(0.1 + 0.013 * n, 6.0 - 0.007 * n, 3.0 + 0.004 * n),
            b(18.0 - 0.011 * n, 12.0 + 0.009 * n, 17.0 - 0.005 * n);
        const auto below = [](glm::dvec3 p) {
            const glm::ivec3 v(glm::floor(p + 0.5));
            return v.x + v.y + v.z < 28;
        };
        if (below(a) == below(b)) continue;
        EXPECT_FALSE(staysInside(labels, a, b));
        EXPECT_TRUE(staysInside(labels, a, glm::mix(a, glm::dvec3(0.0), 0.5)));
    }
}

}  // namespace
