// The centerline of tubes whose true one is known.
#include "centerline/path.h"
#include "core/crop.h"
#include "topology/distance_field.h"
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

Centerline trace(const Volume<std::uint8_t>& mask, const CenterlineOptions& options = {}) {
    const auto traced = traceCenterline(mask, topology::distanceToBoundaryMm(mask), options);
    EXPECT_TRUE(traced) << describe(traced.error());
    return traced ? traced->centerline : Centerline();
}

void expectSound(const Centerline& line, const Volume<std::uint8_t>& mask) {
    ASSERT_GT(line.points.size(), 1u);
    EXPECT_EQ(line.points.front().arcMm, 0.0);
    for (std::size_t n = 0; n < line.points.size(); ++n) {
        const CenterlinePoint& p = line.points[n];
        if (n > 0) {
            EXPECT_NEAR(p.arcMm - line.points[n - 1].arcMm, 1.0, 0.01);
            EXPECT_LE(glm::distance(p.positionMm, line.points[n - 1].positionMm), 1.02);
        }
        if (p.gap) continue;
        const glm::ivec3 voxel(glm::floor(mask.grid().voxelFromPatientPoint(p.positionMm) + 0.5));
        EXPECT_TRUE(mask.grid().contains(voxel) && mask.at(voxel) != 0)
            << "outside at arc " << p.arcMm;
        EXPECT_GT(p.radiusMm, 0.0);
    }
}

/// Mean distance from the true curve, leaving the two round caps out.
double meanErrorMm(const Centerline& line, const std::vector<glm::dvec3>& truth, double capMm) {
    double sum = 0.0;
    int count = 0;
    for (const CenterlinePoint& p : line.points) {
        if (p.arcMm < capMm || p.arcMm > line.lengthMm() - capMm) continue;
        sum += tests::distanceToCurve(truth, p.positionMm);
        ++count;
    }
    return sum / count;
}

double lengthMm(const std::vector<glm::dvec3>& curve) {
    double sum = 0.0;
    for (std::size_t n = 1; n < curve.size(); ++n)
        sum += glm::distance(curve[n], curve[n - 1]);
    return sum;
}

void expectFollows(const std::vector<glm::dvec3>& truth, double radiusMm) {
    Volume<std::uint8_t> mask(gridAround(truth, radiusMm + 3.0, spacing), std::uint8_t(0));
    fillTube(mask, truth, radiusMm);
    const Centerline line = trace(mask);
    expectSound(line, mask);
    EXPECT_LT(meanErrorMm(line, truth, 1.5 * radiusMm), 0.4);  // half a voxel
    // The line reaches into the caps, to where a ball of a few mm fits.
    EXPECT_GT(line.lengthMm(), lengthMm(truth));
    EXPECT_LT(line.lengthMm(), lengthMm(truth) + 2.0 * radiusMm);
    for (const CenterlinePoint& p : line.points) {
        if (p.arcMm > 1.5 * radiusMm && p.arcMm < line.lengthMm() - 1.5 * radiusMm) {
            EXPECT_NEAR(p.radiusMm, radiusMm, 1.0);
        }
    }
    // Rectum first: the truth's lower end.
    const auto [low, high] =
        std::minmax(truth.front(), truth.back(), [](auto& a, auto& b) { return a.z < b.z; });
    EXPECT_LT(glm::distance(line.points.front().positionMm, low), radiusMm);
    EXPECT_LT(glm::distance(line.points.back().positionMm, high), radiusMm);
}

TEST(CenterlinePath, FollowsASegmentOfATorus) {
    expectFollows(sampleCurve([](double t) {
                      const double a = pi * (0.1 + 1.3 * t);
                      return glm::dvec3(45.0 * std::cos(a), 3.0,
                                        45.0 * std::sin(a) - 20.0 * (1.0 - t));
                  }),
                  9.0);
}

TEST(CenterlinePath, FollowsAHelix) {
    expectFollows(sampleCurve([](double t) {
                      const double a = 4.0 * pi * t;
                      return glm::dvec3(30.0 * std::cos(a), 30.0 * std::sin(a), 80.0 * t);
                  }),
                  7.0);
}

/// A hairpin whose legs lie 2 mm apart, as long loops of the colon do.
std::vector<glm::dvec3> hairpin(double legMm, double radiusMm) {
    const double bend = radiusMm + 1.0, total = 2.0 * legMm + pi * bend;
    return sampleCurve([=](double t) {
        const double s = t * total;
        if (s < legMm) return glm::dvec3(-bend, 0.0, s);
        if (s > legMm + pi * bend)
            return glm::dvec3(bend, 0.0, total - s + 5.0 * (s - legMm - pi * bend) / legMm);
        const double a = (s - legMm) / bend;
        return glm::dvec3(-bend * std::cos(a), 0.0, legMm + bend * std::sin(a));
    });
}

TEST(CenterlinePath, DoesNotTakeTheShortCutThroughALeak) {
    const std::vector<glm::dvec3> truth = hairpin(120.0, 10.0);
    Volume<std::uint8_t> mask(gridAround(truth, 14.0, spacing), std::uint8_t(0));
    fillTube(mask, truth, 10.0);
    // Two leaks, nearly half as wide as the tube.
    for (const double z : {15.0, 60.0}) {
        fillTube(mask,
                 {{-2.0, 0.0, z}, {-1.0, 0.0, z}, {0.0, 0.0, z}, {1.0, 0.0, z}, {2.0, 0.0, z}},
                 4.0);
    }
    const Centerline line = trace(mask);
    expectSound(line, mask);
    EXPECT_GT(line.lengthMm(), lengthMm(truth));
    EXPECT_LT(meanErrorMm(line, truth, 15.0), 0.8);  // the bend is as tight as the tube allows
}

TEST(CenterlinePath, IsNotLedAstrayByACatheterOrTheIleum) {
    const auto truth =
        sampleCurve([](double t) { return glm::dvec3(40.0 * std::sin(pi * t), 0.0, 160.0 * t); });
    const auto catheter =
        sampleCurve([](double t) { return glm::dvec3(0.0, -20.0 * t, -40.0 * t); });
    const auto ileum =
        sampleCurve([](double t) { return glm::dvec3(-60.0 * t, 0.0, 150.0 + 20.0 * t); });
    Volume<std::uint8_t> mask(axisAlignedGrid({190, 90, 300}, spacing, {-75.0, -40.0, -60.0}),
                              std::uint8_t(0));
    fillTube(mask, truth, 14.0);
    fillTube(mask, catheter, 2.5);
    fillTube(mask, ileum, 5.0);
    const Centerline line = trace(mask);
    expectSound(line, mask);
    EXPECT_LT(glm::distance(line.points.front().positionMm, truth.front()), 16.0);
    EXPECT_LT(glm::distance(line.points.back().positionMm, truth.back()), 16.0);
    EXPECT_LT(meanErrorMm(line, truth, 20.0), 0.8);
}

TEST(CenterlinePath, ContinuesAcrossAGapAndMarksIt) {
    const auto curve = [](double t) {
        const double a = pi * t;
        return glm::dvec3(-60.0 * std::cos(a), 0.0, 60.0 * std::sin(a) - 30.0 * (1.0 - t));
    };
    const auto whole = sampleCurve(curve);
    const auto upper = sampleCurve([&](double t) { return curve(0.65 + 0.35 * t); });
    const auto lower = sampleCurve([&](double t) { return curve(0.45 * t); });
    Volume<std::uint8_t> mask(gridAround(whole, 12.0, spacing), std::uint8_t(0));
    fillTube(mask, lower, 8.0);
    fillTube(mask, upper, 8.0, 2);
    mask.writable()[0] = 1;  // a crumb that is not worth a visit
    const auto traced = traceCenterline(mask, topology::distanceToBoundaryMm(mask));
    ASSERT_TRUE(traced) << describe(traced.error());
    const Centerline& line = traced->centerline;
    expectSound(line, mask);
    EXPECT_EQ(traced->notes.size(), 2u);  // the crumb, the gap
    double gapFrom = 1e9, gapTo = -1e9;
    int changes = 0;
    for (std::size_t n = 0; n < line.points.size(); ++n) {
        const CenterlinePoint& p = line.points[n];
        changes += n > 0 && p.gap != line.points[n - 1].gap;
        if (!p.gap) continue;
        EXPECT_EQ(p.radiusMm, 0.0);
        gapFrom = std::min(gapFrom, p.arcMm);
        gapTo = std::max(gapTo, p.arcMm);
    }
    EXPECT_EQ(changes, 2);
    EXPECT_NEAR(gapTo - gapFrom, glm::distance(lower.back(), upper.front()) - 2.0 * 8.0, 10.0);
    EXPECT_LT(glm::distance(line.points.front().positionMm, lower.front()), 8.0);
    EXPECT_LT(glm::distance(line.points.back().positionMm, upper.back()), 8.0);
}

TEST(CenterlinePath, GoesTheOtherWayWhenThePersonSaysSo) {
    const auto truth =
        sampleCurve([](double t) { return glm::dvec3(40.0 * std::sin(pi * t), 0.0, 100.0 * t); });
    Volume<std::uint8_t> mask(gridAround(truth, 12.0, spacing), std::uint8_t(0));
    fillTube(mask, truth, 8.0);
    CenterlineOptions upwards, downwards;
    upwards.rectumMm = truth.front(), upwards.cecumMm = truth.back();
    downwards.rectumMm = truth.back(), downwards.cecumMm = truth.front();
    const Centerline up = trace(mask, upwards), down = trace(mask, downwards);
    expectSound(up, mask);
    expectSound(down, mask);
    ASSERT_EQ(up.points.size(), down.points.size());
    EXPECT_NEAR(up.lengthMm(), down.lengthMm(), 0.5);
    double sum = 0.0;
    for (std::size_t n = 0; n < up.points.size(); ++n) {
        sum += glm::distance(up.points[n].positionMm,
                             down.points[down.points.size() - 1 - n].positionMm);
    }
    EXPECT_LT(sum / double(up.points.size()), 0.3);
    EXPECT_LT(glm::distance(up.points.front().positionMm, truth.front()), 2.0);
    // One end given: the other is found.
    CenterlineOptions onlyCecum;
    onlyCecum.cecumMm = truth.front();
    EXPECT_LT(glm::distance(trace(mask, onlyCecum).points.back().positionMm, truth.front()), 2.0);
    EXPECT_LT(glm::distance(trace(mask, onlyCecum).points.front().positionMm, truth.back()), 8.0);
    CenterlineOptions astray;
    astray.rectumMm = glm::dvec3(300.0, 0.0, 0.0);
    EXPECT_FALSE(traceCenterline(mask, topology::distanceToBoundaryMm(mask), astray));
}

TEST(CenterlinePath, IsTheSameForAnyNumberOfThreads) {
    const auto truth = hairpin(60.0, 8.0);
    Volume<std::uint8_t> mask(gridAround(truth, 12.0, spacing), std::uint8_t(0));
    fillTube(mask, truth, 8.0);
    CenterlineOptions one, many;
    one.threads = 1, many.threads = 4;
    const Centerline a = trace(mask, one), b = trace(mask, many);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t n = 0; n < a.points.size(); ++n)
        EXPECT_EQ(a.points[n].positionMm, b.points[n].positionMm);
}

TEST(CenterlinePath, IsTheSameWhereverTheScanBegins) {
    const auto truth = sampleCurve([](double t) {
        const double a = 4.0 * pi * t;
        return glm::dvec3(25.0 * std::cos(a), 25.0 * std::sin(a), 60.0 * t);
    });
    Volume<std::uint8_t> mask(gridAround(truth, 12.0, spacing), std::uint8_t(0));
    fillTube(mask, truth, 8.0);
    const Centerline line = trace(mask);
    // Odd and even, so that any blocks counted from the grid's corner would lie otherwise.
    for (const glm::ivec3 before :
         {glm::ivec3(1, 0, 0), glm::ivec3(0, 3, 0), glm::ivec3(0, 0, 1), glm::ivec3(3, 2, 5)}) {
        Grid wider = mask.grid();
        wider.size += before;
        wider.patientFromVoxel[3] =
            glm::dvec4(mask.grid().patientFromVoxelPoint(glm::dvec3(-before)), 1.0);
        Volume<std::uint8_t> moved(wider, std::uint8_t(0));
        paste(mask, {before, mask.grid().size}, moved, 1);
        const Centerline same = trace(moved);
        ASSERT_EQ(same.points.size(), line.points.size());
        for (std::size_t n = 0; n < line.points.size(); ++n)
            EXPECT_LT(glm::distance(same.points[n].positionMm, line.points[n].positionMm), 1e-6);
    }
}

TEST(CenterlinePath, RefusesWhatHoldsNoPath) {
    const Volume<std::uint8_t> empty(axisAlignedGrid({9, 9, 9}, glm::dvec3(1.0)), std::uint8_t(0));
    const auto none = traceCenterline(empty, topology::distanceToBoundaryMm(empty));
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::noResult);
    Volume<std::uint8_t> dot(axisAlignedGrid({9, 9, 9}, glm::dvec3(1.0)), std::uint8_t(0));
    dot.writable()[dot.grid().index(4, 4, 4)] = 1;
    EXPECT_FALSE(traceCenterline(dot, topology::distanceToBoundaryMm(dot)));
    EXPECT_FALSE(
        traceCenterline(dot, Volume<float>(axisAlignedGrid({8, 9, 9}, glm::dvec3(1.0)), 0.0f)));
}

}  // namespace
}  // namespace haustra::centerline
