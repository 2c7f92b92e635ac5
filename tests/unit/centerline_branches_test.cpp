// Centerlines of trees, of organs without a rectum, and across bridges.
#include "centerline/path.h"
#include "topology/distance_field.h"
#include "topology/handle_cutting.h"
#include "tube_phantom.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace haustra::centerline {
namespace {

using tests::fillTube;
using tests::gridAround;
using tests::sampleCurve;
constexpr double pi = std::numbers::pi;
const glm::dvec3 spacing(0.8, 0.8, 1.0);

TracedCenterline trace(const Volume<std::uint8_t>& mask, const CenterlineOptions& options) {
    auto traced = traceCenterline(mask, topology::distanceToBoundaryMm(mask), options);
    EXPECT_TRUE(traced) << describe(traced.error());
    return traced ? std::move(*traced) : TracedCenterline();
}

std::vector<glm::dvec3> line(glm::dvec3 from, glm::dvec3 to) {
    return sampleCurve([=](double t) { return glm::mix(from, to, t); });
}

double meanDistanceMm(const Centerline& found, const std::vector<glm::dvec3>& truth) {
    double sum = 0.0;
    for (const CenterlinePoint& p : found.points)
        sum += tests::distanceToCurve(truth, p.positionMm);
    return sum / double(found.points.size());
}

/// A Y with a twig: the stem goes on into the left arm, the right arm leaves it, the twig that.
struct Tree {
    std::vector<glm::dvec3> stem = line({0, 0, -50}, {0, 0, 60});
    std::vector<glm::dvec3> left = line({0, 0, 60}, {-70, 0, 130});
    std::vector<glm::dvec3> right = line({0, 0, 60}, {48, 12, 108});
    std::vector<glm::dvec3> twig = line({24, 6, 84}, {24, 38, 90});
    Volume<std::uint8_t> mask{gridAround({{-70, 0, -50}, {48, 38, 130}}, 12.0, spacing),
                              std::uint8_t(0)};
    Tree() {
        fillTube(mask, stem, 6.0);
        fillTube(mask, left, 5.0);
        fillTube(mask, right, 4.0);
        fillTube(mask, twig, 2.5);
    }
};

TEST(CenterlineBranches, FollowEachArmToItsTip) {
    const Tree tree;
    CenterlineOptions options;
    options.ends = EndRule::farthest;
    EXPECT_TRUE(trace(tree.mask, options).branches.empty());
    options.branches = true;
    const TracedCenterline traced = trace(tree.mask, options);
    const std::vector<CenterlinePoint>& main = traced.centerline.points;
    EXPECT_LT(glm::distance(main.front().positionMm, tree.stem.front()), 6.0);
    EXPECT_LT(glm::distance(main.back().positionMm, tree.left.back()), 5.0);
    ASSERT_EQ(traced.branches.size(), 2u);
    for (std::size_t n = 0; n < 2; ++n) {
        const Centerline& branch = traced.branches[n];
        const auto& truth = n == 0 ? tree.right : tree.twig;
        EXPECT_LT(glm::distance(branch.points.back().positionMm, truth.back()), 5.0);
        // It begins on the line it leaves, and ends in its own: past the fork it follows the truth.
        EXPECT_EQ(branch.points.front().arcMm, 0.0);
        const auto& parent = n == 0 ? tree.stem : tree.right;
        const auto& sibling = n == 0 ? tree.left : tree.stem;
        EXPECT_LT(std::min({tests::distanceToCurve(parent, branch.points.front().positionMm),
                            tests::distanceToCurve(sibling, branch.points.front().positionMm)}),
                  3.0);
        Centerline outer;
        for (const CenterlinePoint& p : branch.points) {
            EXPECT_FALSE(p.gap);
            EXPECT_GT(p.radiusMm, 0.0);
            if (glm::distance(p.positionMm, truth.front()) > 9.0) outer.points.push_back(p);
        }
        EXPECT_GT(outer.points.size(), 15u);
        EXPECT_LT(meanDistanceMm(outer, truth), 0.8);
    }
    options.shortestBranchMm = 40.0;
    EXPECT_EQ(trace(tree.mask, options).branches.size(), 1u);
    options.shortestBranchMm = 80.0;
    EXPECT_TRUE(trace(tree.mask, options).branches.empty());
}

TEST(CenterlineBranches, HaustraAreNone) {
    // A tube whose wall bulges all along, as the colon's does.
    const auto curve = sampleCurve([](double t) {
        const double a = pi * t;
        return glm::dvec3(-60.0 * std::cos(a), 0.0, 60.0 * std::sin(a) + 30.0 * t);
    });
    Volume<std::uint8_t> mask(gridAround(curve, 26.0, spacing), std::uint8_t(0));
    fillTube(mask, curve, 10.0);
    for (std::size_t n = 10; n < curve.size(); n += 40) {
        const double turn = 2.1 * double(n);
        fillTube(mask, {curve[n] + 9.0 * glm::dvec3(0.0, std::cos(turn), std::sin(turn))}, 9.0);
    }
    CenterlineOptions options;
    options.branches = true;
    EXPECT_TRUE(trace(mask, options).branches.empty());
}

TEST(CenterlineEnds, FarthestAreTheLongestPathsTheLowerOneFirst) {
    // By the colon's rule the path would begin at the end that is posterior and near the midline.
    const auto curve = sampleCurve([](double t) {
        const double a = 1.2 * pi * t;
        return glm::dvec3(50.0 * std::cos(a), 90.0 - 110.0 * t, 20.0 + 40.0 * std::sin(a));
    });
    for (const bool flip : {false, true}) {
        auto points = curve;
        for (glm::dvec3& p : points)
            p.z = flip ? -p.z : p.z;
        Volume<std::uint8_t> mask(gridAround(points, 12.0, spacing), std::uint8_t(0));
        fillTube(mask, points, 7.0);
        CenterlineOptions options;
        options.ends = EndRule::farthest;
        const Centerline found = trace(mask, options).centerline;
        const auto [low, high] =
            std::minmax(points.front(), points.back(), [](auto& a, auto& b) { return a.z < b.z; });
        EXPECT_LT(glm::distance(found.points.front().positionMm, low), 7.0);
        EXPECT_LT(glm::distance(found.points.back().positionMm, high), 7.0);
        // A given end still overrules.
        options.rectumMm = high;
        EXPECT_LT(glm::distance(trace(mask, options).centerline.points.front().positionMm, high),
                  2.0);
    }
}

TEST(CenterlineGaps, ABridgeIsOne) {
    const auto arch = [](double t) {
        return glm::dvec3(-60.0 * std::cos(pi * t), 0.0, 60.0 * std::sin(pi * t) + 40.0 * t);
    };
    const auto whole = sampleCurve(arch);
    const auto lower = sampleCurve([&](double t) { return arch(0.45 * t); });
    const auto upper = sampleCurve([&](double t) { return arch(0.65 + 0.35 * t); });
    Volume<std::uint8_t> mask(gridAround(whole, 12.0, spacing), std::uint8_t(0));
    fillTube(mask, lower, 8.0);
    fillTube(mask, upper, 8.0);
    const auto joined = topology::cutHandles(mask);
    ASSERT_TRUE(joined) << describe(joined.error());
    const TracedCenterline traced = trace(joined->labels, {});
    EXPECT_TRUE(traced.notes.empty());
    double fromMm = 1e9, toMm = -1e9;
    int changes = 0;
    const std::vector<CenterlinePoint>& points = traced.centerline.points;
    for (std::size_t n = 0; n < points.size(); ++n) {
        changes += n > 0 && points[n].gap != points[n - 1].gap;
        const glm::ivec3 voxel(
            glm::floor(mask.grid().voxelFromPatientPoint(points[n].positionMm) + 0.5));
        EXPECT_EQ(points[n].gap, mask.at(voxel) == 0);
        EXPECT_EQ(points[n].gap, points[n].radiusMm == 0.0);
        if (!points[n].gap) continue;
        fromMm = std::min(fromMm, points[n].arcMm);
        toMm = std::max(toMm, points[n].arcMm);
    }
    EXPECT_EQ(changes, 2);
    EXPECT_NEAR(toMm - fromMm, glm::distance(lower.back(), upper.front()) - 2.0 * 8.0, 8.0);
    EXPECT_LT(glm::distance(points.front().positionMm, lower.front()), 8.0);
    EXPECT_LT(glm::distance(points.back().positionMm, upper.back()), 8.0);
}

}  // namespace
}  // namespace haustra::centerline
