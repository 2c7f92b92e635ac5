// A bridge is carried from the labels to the path and to the surface, as long
// as it is and no farther.
#include "core/bridges.h"

#include "centerline/path.h"
#include "contouring/dual_contouring.h"
#include "core/ct_scan.h"
#include "topology/distance_field.h"

#include <numbers>

#include <gtest/gtest.h>

namespace haustra {
namespace {

constexpr double radiusMm = 9.0, bridgeRadiusMm = 1.5, beginMm = 40.0, endMm = 30.0;
constexpr glm::dvec3 spacing{0.8, 0.8, 1.0};

// Two segments of a straight tube along z, from 0 on, and a bridge of
// `lengthMm` between.
struct BridgedTube {
    explicit BridgedTube(double lengthMm)
        : fromMm(beginMm),
          toMm(beginMm + lengthMm),
          labels(axisAlignedGrid({32, 32, int(toMm + endMm) + 9}, spacing, {-12.4, -12.4, -4.0}),
                 std::uint8_t(0)),
          hu(labels.grid(), std::int16_t(40)) {
        for (std::size_t n = 0; n < labels.grid().voxelCount(); ++n) {
            const glm::dvec3 p = labels.grid().patientFromVoxelPoint(labels.grid().voxelAt(n));
            const double fromAxis = glm::length(glm::dvec2(p));
            if (p.z < 0.0 || p.z > toMm + endMm) continue;
            const bool between = p.z > fromMm && p.z < toMm;
            if (fromAxis > (between ? bridgeRadiusMm : radiusMm)) continue;
            labels.writable()[n] = std::uint8_t(between ? LumenLabel::bridge : LumenLabel::air);
            if (!between) hu.writable()[n] = -1000;
        }
    }
    double fromMm, toMm;
    Volume<std::uint8_t> labels;
    Volume<std::int16_t> hu;
};

class BridgeOf : public testing::TestWithParam<double> {
protected:
    const BridgedTube tube{GetParam()};
};

TEST_P(BridgeOf, KnownLengthHasExactlyItsArcsOnThePath) {
    centerline::CenterlineOptions options;
    options.ends = centerline::EndRule::farthest;
    const auto traced = centerline::traceCenterline(
        tube.labels, topology::distanceToBoundaryMm(tube.labels), options);
    ASSERT_TRUE(traced) << describe(traced.error());
    const Centerline& path = traced->centerline;
    for (const CenterlinePoint& point : path.points) {
        const double z = point.positionMm.z;
        if (std::min(std::abs(z - tube.fromMm), std::abs(z - tube.toMm)) < spacing.z) continue;
        EXPECT_EQ(point.gap, z > tube.fromMm && z < tube.toMm) << "at " << z;
    }
    const auto bridges = bridgesOf(path);
    ASSERT_EQ(bridges.size(), 1u);
    // Its ends are between samples a millimetre apart, and between voxels.
    EXPECT_NEAR(bridges[0].lengthMm(), GetParam(), 2.0 * spacing.z);
    const double start = poseAtArc(path, bridges[0].fromArcMm).point.positionMm.z,
                 end = poseAtArc(path, bridges[0].toArcMm).point.positionMm.z;
    EXPECT_NEAR(std::min(start, end), tube.fromMm, 1.5 * spacing.z);
    EXPECT_NEAR(std::max(start, end), tube.toMm, 1.5 * spacing.z);
}

TEST_P(BridgeOf, KnownLengthHasExactlyItsTrianglesOnTheSurface) {
    const auto surface = contouring::contourLumen(tube.hu, tube.labels, -480.0);
    ASSERT_TRUE(surface) << describe(surface.error());
    const auto bridged = bridgedTriangles(*surface, tube.labels);
    ASSERT_EQ(bridged.size(), surface->triangles.size());
    double areaMm2 = 0.0;
    for (std::size_t n = 0; n < bridged.size(); ++n) {
        const glm::ivec3 t = surface->triangles[n];
        const glm::dvec3 a = surface->vertices[std::size_t(t.x)],
                         b = surface->vertices[std::size_t(t.y)],
                         c = surface->vertices[std::size_t(t.z)];
        const double z = (a.z + b.z + c.z) / 3.0;
        if (bridged[n]) {
            areaMm2 += 0.5 * glm::length(glm::cross(b - a, c - a));
            EXPECT_GT(z, tube.fromMm - spacing.z);
            EXPECT_LT(z, tube.toMm + spacing.z);
            EXPECT_LT(glm::length(glm::dvec2(a)), 2.0 * bridgeRadiusMm) << "the segments' ends";
        } else if (z > tube.fromMm + spacing.z && z < tube.toMm - spacing.z) {
            ADD_FAILURE() << "no bridge at " << z;
        }
    }
    // A tube of 13 voxels' cross-section is round to about a tenth of its
    // circumference.
    const double expected = 2.0 * std::numbers::pi * bridgeRadiusMm * GetParam();
    EXPECT_NEAR(areaMm2, expected, 0.25 * expected + 20.0);
}

INSTANTIATE_TEST_SUITE_P(Collapse, BridgeOf, testing::Values(6.0, 15.0, 40.0));

TEST(Bridges, AWallWithoutOneHasNone) {
    BridgedTube tube(10.0);
    for (std::uint8_t& label : tube.labels.writable())
        label =
            label == std::uint8_t(LumenLabel::bridge) ? std::uint8_t(LumenLabel::tagged) : label;
    const auto bridged = bridgedTriangles(
        contouring::contourLumen(tube.hu, tube.labels, -480.0).value(), tube.labels);
    EXPECT_EQ(std::count(bridged.begin(), bridged.end(), 0), std::ptrdiff_t(bridged.size()));
    EXPECT_TRUE(bridgesOf({}).empty());
}

TEST(Bridges, EachRunOfGapSamplesIsOneAndTheEndsOfThePathEndIt) {
    Centerline path;
    for (const char sample : std::string("##...##.#...#"))
        path.points.push_back({glm::dvec3(0.0), double(path.points.size()), 1.0, sample == '#'});
    const auto bridges = bridgesOf(path);
    ASSERT_EQ(bridges.size(), 4u);
    const double ends[4][2] = {{0.0, 1.5}, {4.5, 6.5}, {7.5, 8.5}, {11.5, 12.0}};
    for (std::size_t n = 0; n < 4; ++n) {
        EXPECT_EQ(bridges[n].fromArcMm, ends[n][0]);
        EXPECT_EQ(bridges[n].toArcMm, ends[n][1]);
    }
}

}  // namespace
}  // namespace haustra
