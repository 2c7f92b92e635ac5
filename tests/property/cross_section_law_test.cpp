// Laws of the path in the middle of the lumen's cross-sections.
#include "topology/centerline_cross_sections.h"
#include "topology/centerline_path.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::topology;

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
    const Volume<float> distanceMm = distanceToBoundaryMm(labels, 1);
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
    const Volume<float> distanceMm = distanceToBoundaryMm(labels, 1);
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

}  // namespace
