// Maps of tubes whose conformal map is known, and laws that hold for all.
#include "flatten/tube/conformal_tube.h"

#include "flatten/distortion.h"
#include "tube_meshes.h"

#include <cstring>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

using namespace haustra;
using flatten::ConformalTube;
using flatten::conformalTube;

namespace {

constexpr double fullTurn = 2.0 * std::numbers::pi;

/// A colon-like tube: bent, with haustra, and a cross-section that is not round.
TriMesh bentTube(int around, int along) {
    return tests::tubeMesh(around, along, [](double a, double s) {
        const double angle = fullTurn * a, bend = 2.0 * s;
        const double r = 20.0 + 4.0 * std::cos(40.0 * s) + 3.0 * std::cos(3.0 * angle + 5.0 * s);
        const double out = 90.0 + r * std::cos(angle);
        return glm::dvec3(out * std::cos(bend), out * std::sin(bend),
                          r * std::sin(angle) + 30.0 * s);
    });
}

/// Largest difference between `map` and `exact` (per vertex: x in turns, y), after the best turn.
double largestError(const flatten::PeriodicMap& map, const std::vector<glm::dvec2>& exact) {
    const auto wrapped = [](double x) { return x - std::round(x); };
    const double shift = map.flat[0].x - exact[0].x;
    double mean = 0.0, worst = 0.0;
    for (std::size_t v = 0; v < exact.size(); ++v)
        mean += wrapped(map.flat[v].x - exact[v].x - shift) / double(exact.size());
    for (std::size_t v = 0; v < exact.size(); ++v) {
        worst = std::max(worst, std::abs(wrapped(map.flat[v].x - exact[v].x - shift - mean)));
        worst = std::max(worst, std::abs(map.flat[v].y - exact[v].y));
    }
    return worst;
}

flatten::Distortion distortionOf(const TriMesh& mesh, const flatten::PeriodicMap& map) {
    return flatten::measureDistortion(mesh,
                                      [&](std::size_t t, int c) { return map.corner(mesh, t, c); });
}

}  // namespace

/// The prism over a regular polygon unrolls into the plane, and the linear functions are harmonic
/// on every triangulation of it whose vertices lie on the prism.
TEST(ConformalTube, UnrollsAPrismToSolverPrecision) {
    const int around = 24, along = 31;
    const double radius = 7.0, height = 40.0;
    const double girth = 2.0 * around * radius * std::sin(std::numbers::pi / around);
    // Rings at random heights, and vertices between them moved at random up and down their edge of
    // the prism: the triangles are irregular, and every one lies on a face of the prism.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-0.45, 0.45);
    TriMesh mesh = tests::revolvedMesh(around, along, height, [&](double) { return radius; });
    std::vector<glm::dvec2> exact;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const auto ring = int(v) / around;
        if (ring > 0 && ring < along) mesh.vertices[v].z += height / along * jitter(random);
        exact.push_back({double(int(v) % around) / around, mesh.vertices[v].z / girth});
    }
    for (const bool delaunay : {false, true}) {
        flatten::ConformalTubeOptions options;
        options.intrinsicDelaunay = delaunay;
        const auto made = conformalTube(mesh, 0, options);
        ASSERT_TRUE(made) << describe(made.error());
        EXPECT_NEAR(made->modulus, height / girth, 1e-12);
        EXPECT_NEAR(made->certificate, 0.0, 1e-12);
        EXPECT_LT(largestError(made->map, exact), 1e-12);
        EXPECT_EQ(made->repaired, 0);
        const auto distortion = distortionOf(mesh, made->map);
        EXPECT_LT(distortion.angleErrorDegrees.max, 1e-9);
        EXPECT_NEAR(distortion.dilatation.max, 1.0, 1e-11);
        EXPECT_LT(distortion.logAreaDeviation, 1e-10);
        EXPECT_NEAR(distortion.areaRange, 1.0, 1e-10);
        EXPECT_EQ(distortion.flips, 0u);
    }
}

/// On a surface of revolution with radius r over arc length l the map is x = angle, and
/// y = ∫ dl / (2π r); for r = cosh z both are elementary: dl = cosh z dz, so y = z / 2π.
TEST(ConformalTube, ConvergesToTheCatenoidsMap) {
    double before = 0.0, meanBefore = 0.0;
    for (const int size : {24, 48, 96}) {
        TriMesh mesh = tests::tubeMesh(size, size / 2, [](double a, double s) {
            const double z = 2.6 * s - 1.3 + 0.3 * std::sin(fullTurn * s) / fullTurn;
            return glm::dvec3(std::cosh(z) * std::cos(fullTurn * a),
                              std::cosh(z) * std::sin(fullTurn * a), z);
        });
        std::vector<glm::dvec2> exact;
        for (const glm::dvec3& at : mesh.vertices)
            exact.push_back({std::atan2(at.y, at.x) / fullTurn, (at.z + 1.3) / fullTurn});
        const auto made = conformalTube(mesh, 0);
        ASSERT_TRUE(made) << describe(made.error());
        const double error = largestError(made->map, exact);
        const double mean = distortionOf(mesh, made->map).angleErrorDegrees.mean;
        if (before > 0.0) {
            EXPECT_NEAR(before / error, 4.0, 0.6);
            EXPECT_NEAR(meanBefore / mean, 2.0, 0.3);
        }
        before = error;
        meanBefore = mean;
    }
    EXPECT_LT(before, 1e-3);
}

TEST(ConformalTube, CertificateIsPositiveAndFalls) {
    double before = 1.0;
    for (const int size : {16, 32, 64}) {
        const auto made = conformalTube(bentTube(size, 4 * size));
        ASSERT_TRUE(made);
        EXPECT_GT(made->certificate, 0.0);
        EXPECT_LT(made->certificate, 0.5 * before);
        before = made->certificate;
    }
}

TEST(ConformalTube, KeepsOrientationAndWholeTriangles) {
    TriMesh mesh = bentTube(48, 192);
    for (const bool inverted : {false, true}) {
        if (inverted) {
            for (glm::ivec3& t : mesh.triangles)
                std::swap(t.y, t.z);
        }
        const auto made = conformalTube(mesh, 0);
        ASSERT_TRUE(made);
        EXPECT_EQ(distortionOf(mesh, made->map).flips, 0u);
        double area = 0.0;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const glm::dvec2 at = made->map.corner(mesh, t, 0);
            const glm::dvec2 a = made->map.corner(mesh, t, 1) - at,
                             b = made->map.corner(mesh, t, 2) - at;
            EXPECT_LT(std::max(std::abs(a.x), std::abs(b.x)), 0.5);
            EXPECT_EQ(made->map.turns[t][0], 0);
            area += 0.5 * (a.x * b.y - a.y * b.x);
        }
        // The strip is covered once.
        EXPECT_NEAR(area, made->map.height, 1e-10);
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
            EXPECT_GE(made->map.flat[v].x, 0.0);
            EXPECT_LT(made->map.flat[v].x, 1.0);
        }
        for (int v = 0; v < 48; ++v) {
            EXPECT_EQ(made->map.flat[std::size_t(v)].y, 0.0);
            EXPECT_EQ(made->map.flat[mesh.vertices.size() - 1 - std::size_t(v)].y,
                      made->map.height);
        }
    }
}

/// A blind finger three times as long as it is round, on a grid shaken almost until it folds.
TEST(ConformalTube, UnfoldsWhatTheIntrinsicTriangulationHides) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shake(-0.45 / 60.0, 0.45 / 60.0);
    const TriMesh mesh = tests::tubeMesh(60, 60, [&](double a, double s) {
        if (s > 0.0 && s < 1.0) {
            a += shake(random);
            s += shake(random);
        }
        const double r = 20.0 + 60.0 * std::exp(-std::pow(7.0 * std::hypot(a - 0.5, s - 0.5), 6.0));
        return glm::dvec3(r * std::cos(fullTurn * a), r * std::sin(fullTurn * a), 120.0 * s);
    });
    flatten::ConformalTubeOptions options;
    options.repairFlips = false;
    const auto folded = conformalTube(mesh, 0, options), unfolded = conformalTube(mesh, 0);
    ASSERT_TRUE(folded && unfolded);
    const auto before = distortionOf(mesh, folded->map), after = distortionOf(mesh, unfolded->map);
    EXPECT_GT(before.flips, 0u);
    EXPECT_GT(before.dilatation.max, 50.0);
    EXPECT_EQ(after.flips, 0u);
    EXPECT_LT(after.dilatation.max, 20.0);
    EXPECT_LT(after.dilatation.mean, before.dilatation.mean);
    EXPECT_GT(unfolded->repaired, 0);
    EXPECT_EQ(folded->repaired, 0);
    EXPECT_EQ(unfolded->modulus, folded->modulus);
}

TEST(ConformalTube, StartsAtTheLoopThatIsNamed) {
    const TriMesh mesh = bentTube(24, 96);
    const int last = int(mesh.vertices.size()) - 1;
    const auto up = conformalTube(mesh, 3), byItself = conformalTube(mesh),
               down = conformalTube(mesh, last);
    ASSERT_TRUE(up && byItself && down);
    EXPECT_EQ(down->map.flat[std::size_t(last)].y, 0.0);
    EXPECT_NEAR(up->modulus, down->modulus, 1e-12);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        EXPECT_EQ(up->map.flat[v], byItself->map.flat[v]);
        EXPECT_NEAR(up->map.flat[v].y + down->map.flat[v].y, up->modulus, 1e-11);
    }
    EXPECT_EQ(conformalTube(mesh, 24 * 40).error().kind, ErrorKind::badInput);
}

TEST(ConformalTube, IsTheSameMovedTurnedAndScaled) {
    const TriMesh mesh = bentTube(32, 128);
    TriMesh moved = mesh;
    const glm::dmat4 motion =
        glm::scale(glm::rotate(glm::translate(glm::dmat4(1.0), {40.0, -7.0, 130.0}), 1.1,
                               glm::normalize(glm::dvec3(1.0, 2.0, -0.5))),
                   glm::dvec3(0.037));
    for (glm::dvec3& at : moved.vertices)
        at = glm::dvec3(motion * glm::dvec4(at, 1.0));
    const auto here = conformalTube(mesh), there = conformalTube(moved);
    ASSERT_TRUE(here && there);
    EXPECT_NEAR(here->modulus, there->modulus, 1e-9);
    EXPECT_LT(largestError(there->map, here->map.flat), 1e-9);
}

TEST(ConformalTube, IsTheSameForAnyNumberOfThreads) {
    const TriMesh mesh = bentTube(64, 400);
    flatten::ConformalTubeOptions options;
    options.threads = 1;
    const auto one = conformalTube(mesh, -1, options);
    options.threads = 2;
    const auto two = conformalTube(mesh, -1, options);
    ASSERT_TRUE(one && two);
    EXPECT_EQ(std::memcmp(one->map.flat.data(), two->map.flat.data(),
                          one->map.flat.size() * sizeof(glm::dvec2)),
              0);
    EXPECT_EQ(one->map.turns, two->map.turns);
    EXPECT_EQ(one->certificate, two->certificate);
}

TEST(ConformalTube, IterativeSolversAgree) {
    const TriMesh mesh = bentTube(24, 100);
    const auto direct = conformalTube(mesh);
    ASSERT_TRUE(direct);
    for (const auto solver :
         {flatten::Solver::conjugateGradient, flatten::Solver::jacobiConjugateGradient}) {
        flatten::ConformalTubeOptions options;
        options.solver = solver;
        const auto made = conformalTube(mesh, -1, options);
        ASSERT_TRUE(made);
        EXPECT_TRUE(made->converged);
        EXPECT_GT(made->iterations, 0);
        EXPECT_LT(largestError(made->map, direct->map.flat), 1e-7);
    }
}

TEST(ConformalTube, RefusesWhatIsNoTube) {
    const auto kindOf = [](const TriMesh& mesh) {
        const auto made = conformalTube(mesh);
        return made ? ErrorKind::io : made.error().kind;
    };
    const TriMesh tube = bentTube(12, 20);
    TriMesh threeLoops = tube;
    threeLoops.triangles.erase(threeLoops.triangles.begin() + 200);
    EXPECT_EQ(kindOf(threeLoops), ErrorKind::badInput);
    TriMesh oneLoop = tube;
    oneLoop.vertices.push_back({0.0, 0.0, 0.0});
    for (int i = 0; i < 12; ++i)
        oneLoop.triangles.push_back({(i + 1) % 12, i, int(tube.vertices.size())});
    EXPECT_EQ(kindOf(oneLoop), ErrorKind::badInput);
    TriMesh closed = oneLoop;
    closed.vertices.push_back({5.0, 0.0, 0.0});
    for (int i = 0; i < 12; ++i)
        closed.triangles.push_back({240 + i, 240 + (i + 1) % 12, int(oneLoop.vertices.size())});
    EXPECT_EQ(kindOf(closed), ErrorKind::badInput);
    TriMesh two = tube;
    for (const glm::dvec3& at : tube.vertices)
        two.vertices.push_back(at + glm::dvec3(0.0, 0.0, 500.0));
    for (const glm::ivec3& t : tube.triangles)
        two.triangles.push_back(t + int(tube.vertices.size()));
    EXPECT_EQ(kindOf(two), ErrorKind::badInput);
    EXPECT_EQ(kindOf({}), ErrorKind::badInput);
    TriMesh flat = tube;
    for (glm::dvec3& at : flat.vertices)
        at = {1.0, 1.0, 1.0};
    EXPECT_EQ(kindOf(flat), ErrorKind::noResult);
}
