#include "flatten/distortion.h"
#include "flatten/tube/conformal_tube.h"
#include "flatten/tube/strip_energy.h"
#include "flatten/tube/unified_flattening.h"
#include "tube_meshes.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

/// With folds and a lean: no surface of revolution.
TriMesh foldedTube() {
    return tests::tubeMesh(48, 120, [](double a, double s) {
        const double angle = 2.0 * std::numbers::pi * a;
        const double fold = std::pow(0.5 + 0.5 * std::cos(30.0 * s + 0.6 * std::sin(angle)), 3);
        const double radius = 20.0 - 9.0 * fold * (1.0 + 0.4 * std::cos(3.0 * angle));
        return glm::dvec3(radius * std::cos(angle) + 25.0 * std::sin(2.0 * s),
                          radius * std::sin(angle), 150.0 * s);
    });
}

/// A straight tube with a finger on its side, four times as deep as it is wide.
TriMesh pouchedTube() {
    constexpr double radius = 20.0, reachMm = 15.0, fingerMm = 6.0, deepMm = 48.0;
    return tests::tubeMesh(120, 80, [](double a, double s) {
        const double angle = 2.0 * std::numbers::pi * a;
        const glm::dvec3 wall(radius * std::cos(angle), radius * std::sin(angle), 80.0 * s);
        // Where the wall would be if it were unrolled around the finger's mouth.
        const glm::dvec2 away(radius * (angle - std::numbers::pi), 80.0 * (s - 0.5));
        const double r = glm::length(away);
        if (r >= reachMm) return wall;
        const double along = (reachMm - r) / reachMm;  // 0 at the mouth, 1 at the tip
        const double wide = fingerMm * std::sqrt(std::max(0.0, 1.0 - std::pow(along, 8.0)));
        const double mouth = std::exp(-12.0 * along);
        const glm::dvec2 out =
            (r > 0.0 ? away / r : glm::dvec2(0.0)) * (wide * (1.0 - mouth) + r * mouth);
        const double turn = std::numbers::pi + out.x / radius;
        const double far = radius + deepMm * along;
        return glm::dvec3(far * std::cos(turn), far * std::sin(turn), 40.0 + out.y);
    });
}

Distortion distortionOf(const TriMesh& tube, const PeriodicMap& map) {
    return measureDistortion(
        tube, [&](std::size_t triangle, int corner) { return map.corner(tube, triangle, corner); });
}

PeriodicMap conformal(const TriMesh& tube) {
    const auto made = conformalTube(tube);
    EXPECT_TRUE(made) << (made ? "" : describe(made.error()));
    return made->map;
}

PeriodicMap unified(const TriMesh& tube, const PeriodicMap& start, double areaWeight,
                    int threads = 0) {
    UnifiedOptions options;
    options.areaWeight = areaWeight;
    options.threads = threads;
    const auto made = unifiedFlattening(tube, start, options);
    EXPECT_TRUE(made) << (made ? "" : describe(made.error()));
    return made.value_or(PeriodicMap{});
}

TEST(UnifiedFlattening, WeightTradesAnglesForAreas) {
    const TriMesh tube = foldedTube();
    const PeriodicMap start = conformal(tube);
    Distortion before = distortionOf(tube, start);
    ASSERT_EQ(before.flips, 0u);
    for (const double weight : {0.03, 0.1, 0.3, 0.6, 0.9, 1.0}) {
        const Distortion now = distortionOf(tube, unified(tube, start, weight));
        EXPECT_EQ(now.flips, 0u);
        EXPECT_LT(now.logAreaDeviation, before.logAreaDeviation) << weight;
        EXPECT_GT(now.dilatation.mean, before.dilatation.mean) << weight;
        EXPECT_GT(now.angleErrorDegrees.mean, before.angleErrorDegrees.mean) << weight;
        before = now;
    }
    EXPECT_LT(before.logAreaDeviation, 0.03);
}

TEST(UnifiedFlattening, NoWeightIsTheConformalMap) {
    const TriMesh tube = foldedTube();
    const PeriodicMap start = conformal(tube), same = unified(tube, start, 0.0);
    EXPECT_EQ(same.flat, start.flat);
    EXPECT_EQ(same.turns, start.turns);
    EXPECT_EQ(same.height, start.height);
}

TEST(UnifiedFlattening, IsometryStays) {
    const TriMesh tube = tests::revolvedMesh(30, 40, 90.0, [](double) { return 12.0; });
    const PeriodicMap start = conformal(tube);
    for (const double weight : {0.1, 0.5, 1.0}) {
        const PeriodicMap map = unified(tube, start, weight);
        EXPECT_NEAR(map.height, start.height, 1e-9);
        for (std::size_t v = 0; v < map.flat.size(); ++v) {
            EXPECT_NEAR(std::remainder(map.flat[v].x - start.flat[v].x, 1.0), 0.0, 1e-9);
            EXPECT_NEAR(map.flat[v].y, start.flat[v].y, 1e-9);
        }
    }
}

TEST(UnifiedFlattening, EndsStayStraightAndTheStripOneAround) {
    constexpr int around = 48, along = 120;
    const TriMesh tube = foldedTube();
    const PeriodicMap map = unified(tube, conformal(tube), 0.7);
    for (int i = 0; i < around; ++i) {
        EXPECT_EQ(map.flat[std::size_t(i)].y, 0.0);
        EXPECT_EQ(map.flat[std::size_t(along * around + i)].y, map.height);
    }
    double area = 0.0;
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        const glm::dvec2 a = map.corner(tube, t, 0), b = map.corner(tube, t, 1) - a,
                         c = map.corner(tube, t, 2) - a;
        area += 0.5 * (b.x * c.y - b.y * c.x);
    }
    EXPECT_NEAR(area, map.height, 1e-9);
    for (const glm::dvec2& v : map.flat) {
        EXPECT_GE(v.x, 0.0);
        EXPECT_LT(v.x, 1.0);
        EXPECT_GE(v.y, 0.0);
        EXPECT_LE(v.y, map.height);
    }
}

// A change of y alone can even out the mean of each ring, and no more.
TEST(UnifiedFlattening, KeepsMoreThanAChangeOfHeightAlone) {
    const TriMesh tube = foldedTube();
    const PeriodicMap start = conformal(tube);
    // Rings of equal height, and the surface in each.
    constexpr int rings = 400;
    std::vector<double> areaUpTo(rings + 1, 0.0);
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        double y = 0.0;
        for (int c = 0; c < 3; ++c)
            y += start.corner(tube, t, c).y / 3.0;
        const auto& v = tube.vertices;
        const glm::ivec3 n = tube.triangles[t];
        areaUpTo[1 + std::size_t(std::min(rings - 1.0, rings * y / start.height))] +=
            glm::length(glm::cross(v[std::size_t(n.y)] - v[std::size_t(n.x)],
                                   v[std::size_t(n.z)] - v[std::size_t(n.x)]));
    }
    for (int r = 0; r < rings; ++r)
        areaUpTo[std::size_t(r) + 1] += areaUpTo[std::size_t(r)];
    for (const double share : {0.5, 1.0}) {
        PeriodicMap stretched = start;
        for (glm::dvec2& place : stretched.flat) {
            const double at = rings * place.y / start.height;
            const int ring = std::min(int(at), rings - 1);
            const double even =
                start.height / areaUpTo[rings] *
                glm::mix(areaUpTo[std::size_t(ring)], areaUpTo[std::size_t(ring) + 1], at - ring);
            place.y = glm::mix(place.y, even, share);
        }
        const Distortion by = distortionOf(tube, stretched);
        const Distortion ours = distortionOf(tube, unified(tube, start, 0.5 * share));
        EXPECT_LT(ours.logAreaDeviation, by.logAreaDeviation);
        EXPECT_LT(ours.angleErrorDegrees.mean, by.angleErrorDegrees.mean);
    }
}

TEST(UnifiedFlattening, OpensBlindPouches) {
    const TriMesh tube = pouchedTube();
    const PeriodicMap start = conformal(tube);
    const Distortion before = distortionOf(tube, start);
    ASSERT_EQ(before.flips, 0u);
    ASSERT_GT(before.areaRange, 5e3);
    const Distortion after = distortionOf(tube, unified(tube, start, 0.5));
    EXPECT_EQ(after.flips, 0u);
    EXPECT_LT(after.areaRange, 100.0);
    EXPECT_LT(after.logAreaDeviation, 0.3 * before.logAreaDeviation);
}

TEST(UnifiedFlattening, SameForAnyNumberOfThreads) {
    const TriMesh tube = foldedTube();
    const PeriodicMap start = conformal(tube);
    const PeriodicMap one = unified(tube, start, 0.4, 1), three = unified(tube, start, 0.4, 3);
    EXPECT_EQ(one.flat, three.flat);
    EXPECT_EQ(one.turns, three.turns);
    EXPECT_EQ(one.height, three.height);
}

TEST(UnifiedFlattening, RefusesWhatIsNoMap) {
    const TriMesh tube = foldedTube();
    const PeriodicMap start = conformal(tube);
    const auto refused = [&](const PeriodicMap& map, double weight) {
        UnifiedOptions options;
        options.areaWeight = weight;
        const auto made = unifiedFlattening(tube, map, options);
        return !made && made.error().kind == ErrorKind::badInput;
    };
    EXPECT_FALSE(refused(start, 0.5));
    for (const double weight : {-0.1, 1.1, double(NAN)})
        EXPECT_TRUE(refused(start, weight));
    PeriodicMap flipped = start;
    flipped.flat[3000].y += 1.0;
    EXPECT_TRUE(refused(flipped, 0.5));
    PeriodicMap shortened = start;
    shortened.flat.pop_back();
    EXPECT_TRUE(refused(shortened, 0.5));
    PeriodicMap level = start;
    level.height = 0.0;
    EXPECT_TRUE(refused(level, 0.5));
}

/// A map of the folded tube, every vertex shaken by some of its distance to the next.
std::vector<glm::dvec2> shaken(const PeriodicMap& map, double by) {
    std::mt19937 random(5);
    std::vector<glm::dvec2> flat = map.flat;
    const auto unit = [&] { return double(random()) / 4294967296.0 - 0.5; };
    for (glm::dvec2& v : flat)
        v += by * glm::dvec2(unit(), unit()) / 48.0;
    return flat;
}

TEST(StripEnergy, GradientIsTheSlope) {
    const TriMesh tube = foldedTube();
    const PeriodicMap start = conformal(tube);
    const std::vector<glm::dvec2> flat = shaken(start, 0.05);
    for (const StripEnergy::Weights weights :
         {StripEnergy::Weights{1.0, 0.0}, {0.0, 1.0}, {0.3, 0.7}}) {
        StripEnergy energy(tube, start, weights, 1);
        ASSERT_TRUE(std::isfinite(energy.value(flat)));
        std::vector<glm::dvec2> gradient(flat.size(), glm::dvec2(0.0));
        const auto& triangles = energy.derivatives(flat);
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            for (int c = 0; c < 3; ++c)
                gradient[std::size_t(tube.triangles[t][c])] +=
                    glm::dvec2(triangles[t].gradient[std::size_t(2 * c)],
                               triangles[t].gradient[std::size_t(2 * c) + 1]);
        }
        for (std::size_t v = 100; v < flat.size(); v += 611) {
            for (int axis = 0; axis < 2; ++axis) {
                const double h = 1e-6;
                auto more = flat, less = flat;
                more[v][axis] += h, less[v][axis] -= h;
                const double slope = (energy.value(more) - energy.value(less)) / (2.0 * h);
                EXPECT_NEAR(gradient[v][axis], slope, 1e-4 * std::abs(slope) + 1e-6);
            }
        }
    }
}

TEST(StripEnergy, HessianIsPositiveAndNearAnIsometryExact) {
    const TriMesh tube = tests::revolvedMesh(12, 9, 50.0, [](double) { return 12.0; });
    const PeriodicMap start = conformal(tube);
    StripEnergy energy(tube, start, {0.6, 0.4}, 1);
    ASSERT_NEAR(energy.value(start.flat), 0.0, 1e-12);
    const auto exact = energy.derivatives(start.flat);
    std::mt19937 random(9);
    const auto unit = [&] { return double(random()) / 4294967296.0 - 0.5; };
    const auto curvature = [](const StripEnergy::Derivatives& of, const double* d) {
        double sum = 0.0;
        std::size_t at = 0;
        for (std::size_t r = 0; r < 6; ++r) {
            for (std::size_t c = 0; c <= r; ++c)
                sum += (r == c ? 1.0 : 2.0) * of.hessian[at++] * d[r] * d[c];
        }
        return sum;
    };
    for (int n = 0; n < 20; ++n) {
        std::vector<glm::dvec2> step(start.flat.size());
        for (glm::dvec2& s : step)
            s = glm::dvec2(unit(), unit());
        double along = 0.0, mixed = 0.0;
        for (std::size_t t = 0; t < exact.size(); ++t) {
            double d[6];
            for (int c = 0; c < 3; ++c) {
                d[2 * c] = step[std::size_t(tube.triangles[t][c])].x;
                d[2 * c + 1] = step[std::size_t(tube.triangles[t][c])].y;
            }
            along += curvature(exact[t], d);
            for (std::size_t k = 0; k < 6; ++k)
                mixed += exact[t].scaleMixed[k] * d[k];
        }
        EXPECT_GT(along, 0.0);
        // With the scale at its best along the way.
        along -= mixed * mixed / energy.scaleCurvature();
        const double h = 1e-5;
        auto there = start.flat;
        for (std::size_t v = 0; v < there.size(); ++v)
            there[v] += h * step[v];
        // The projection adds 1e-3 of a uniform metric where the energy has none.
        EXPECT_NEAR(2.0 * energy.value(there) / (h * h), along, 5e-3 * along);
        energy.value(start.flat);
    }
}

TEST(StripEnergy, FirstFlipIsWhereTheFirstAreaVanishes) {
    const TriMesh tube = foldedTube();
    const PeriodicMap start = conformal(tube);
    StripEnergy energy(tube, start, {0.5, 0.5}, 2);
    std::vector<glm::dvec2> step = shaken(start, 1.0);
    for (std::size_t v = 0; v < step.size(); ++v)
        step[v] -= start.flat[v];
    const double flip = energy.firstFlip(start.flat, step);
    ASSERT_TRUE(std::isfinite(flip));
    const auto at = [&](double share) {
        auto flat = start.flat;
        for (std::size_t v = 0; v < flat.size(); ++v)
            flat[v] += share * step[v];
        return energy.value(flat);
    };
    EXPECT_TRUE(std::isfinite(at(flip * (1.0 - 1e-6))));
    EXPECT_FALSE(std::isfinite(at(flip * (1.0 + 1e-6))));
}

}  // namespace
}  // namespace haustra::flatten
