#include "phantom/filled_colon.h"
#include "phantom/implicit.h"
#include "phantom/random.h"
#include "phantom/surface_score.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::phantom;

namespace {

const Grid phantomGrid = axisAlignedGrid({72, 72, 54}, {0.75, 0.75, 1.05}, {-27, -26, -28});

Volume<std::uint8_t> insideOf(const Grid& grid, const std::function<double(glm::dvec3)>& field) {
    Volume<std::uint8_t> inside(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        inside.writable()[n] = field(grid.patientFromVoxelPoint(grid.voxelAt(n))) < 0.0;
    return inside;
}

TrueSurface surfaceOf(const std::function<double(glm::dvec3)>& field,
                      const std::function<bool(glm::dvec3)>& leftOut = nullptr) {
    return TrueSurface({field, leftOut}, insideOf(phantomGrid, field), 2);
}

double ball(glm::dvec3 p) {
    return glm::length(p) - 20.0;
}

/// A sphere about the origin of quads cut in two, finer than a degree.
TriMesh sphere(double radiusMm, double untilPolar = std::numbers::pi) {
    constexpr int rows = 240, columns = 480;
    TriMesh mesh;
    for (int r = 0; r <= rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            const double polar = untilPolar * r / rows, turn = 2 * std::numbers::pi * c / columns;
            mesh.vertices.push_back(radiusMm * glm::dvec3(std::sin(polar) * std::cos(turn),
                                                          std::sin(polar) * std::sin(turn),
                                                          std::cos(polar)));
        }
    }
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            const int a = r * columns + c, b = r * columns + (c + 1) % columns;
            mesh.triangles.push_back({a, a + columns, b});
            mesh.triangles.push_back({b, a + columns, b + columns});
        }
    }
    return mesh;
}

TEST(CellGrid, FindsWhatASearchOfAllFinds) {
    Random random(5, 5);
    std::vector<Box> boxes;
    for (int n = 0; n < 500; ++n) {
        const glm::dvec3 p = 10.0 * random.normal3();
        boxes.push_back({p, p});
    }
    const CellGrid cells(boxes, 1.7);
    for (int n = 0; n < 500; ++n) {
        const glm::dvec3 p = (n % 5 ? 12.0 : 90.0) * random.normal3();
        const auto squared = [&](std::uint32_t item) {
            return glm::dot(p - boxes[item].low, p - boxes[item].low);
        };
        std::uint32_t nearest = 0;
        for (std::uint32_t m = 1; m < boxes.size(); ++m) {
            if (squared(m) < squared(nearest)) nearest = m;
        }
        const auto found = cells.nearest(p, squared);
        EXPECT_EQ(found.item, nearest);
        EXPECT_EQ(found.squaredMm2, squared(nearest));
    }
    EXPECT_EQ(CellGrid().nearest(glm::dvec3(0), [](std::uint32_t) { return 0.0; }).item,
              CellGrid::none);
}

TEST(TrueSurface, SamplesLieOnABallAndAddUpToItsArea) {
    const TrueSurface surface = surfaceOf(ball);
    EXPECT_GT(surface.samples().size(), 5000u);
    for (const SurfaceSample& sample : surface.samples()) {
        EXPECT_NEAR(ball(sample.positionMm), 0.0, 1e-3);
        EXPECT_GT(glm::dot(sample.outward, glm::normalize(sample.positionMm)), 0.999);
    }
    EXPECT_NEAR(surface.areaMm2() / (4 * std::numbers::pi * 400.0), 1.0, 0.005);
}

TEST(TrueSurface, DistanceToABallIsExactWhateverTheFieldsScale) {
    const auto steep = [](glm::dvec3 p) { return 3.0 * ball(p) + 0.05 * ball(p) * ball(p); };
    for (const TrueSurface& surface : {surfaceOf(ball), surfaceOf(steep)}) {
        Random random(1, 1);
        for (int n = 0; n < 1000; ++n) {
            const glm::dvec3 p =
                glm::normalize(random.normal3()) * (20.0 + (n % 2 ? 0.5 : 8.0) * random.normal());
            EXPECT_NEAR(surface.signedDistanceMm(p), ball(p), n % 2 ? 2e-3 : 0.02);
            EXPECT_EQ(surface.distanceMm(p), std::abs(surface.signedDistanceMm(p)));
        }
    }
}

TEST(TrueSurface, HoldsNothingWhereAllIsInside) {
    const TrueSurface none({ball, nullptr}, Volume<std::uint8_t>(phantomGrid, 1), 1);
    EXPECT_EQ(none.areaMm2(), 0.0);
    EXPECT_TRUE(std::isinf(none.distanceMm(glm::dvec3(0))));
}

/// The nearest place of the field's zero set in a cube about p, by the crossings of the edges of a
/// grid of 0.08 mm.
double bruteForceMm(const ColonShape& shape, glm::dvec3 p, double reachMm) {
    ColonShape::Nearby nearby;
    shape.findNearby(p, 2.0 * reachMm + 1.0, nearby);
    constexpr double h = 0.08;
    const int count = 2 * int(reachMm / h) + 1;
    const Grid grid =
        axisAlignedGrid(glm::ivec3(count), glm::dvec3(h), p - h * glm::dvec3(0.5 * (count - 1)));
    std::vector<double> field(grid.voxelCount());
    for (std::size_t n = 0; n < field.size(); ++n)
        field[n] = shape.evaluate(grid.patientFromVoxelPoint(grid.voxelAt(n)), nearby).lumenMm;
    double best = 1e9;
    for (std::size_t n = 0; n < field.size(); ++n) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::ivec3 w = grid.voxelAt(n);
            const glm::dvec3 a = grid.patientFromVoxelPoint(w);
            if (++w[axis] >= count) continue;
            const double fa = field[n], fb = field[grid.index(w)];
            if ((fa < 0.0) == (fb < 0.0)) continue;
            const glm::dvec3 b = grid.patientFromVoxelPoint(w);
            best = std::min(best, glm::distance(p, glm::mix(a, b, fa / (fa - fb))));
        }
    }
    return best;
}

TEST(TrueSurface, AgreesWithBruteForceOnAColon) {
    PhantomOptions options;
    options.size = Size::small;
    const FilledColon colon = makeFilledColon(options);
    double sum = 0.0, largest = 0.0;
    int compared = 0;
    // A cut-out of full resolution about a polyp, and some about folds.
    for (const glm::dvec3 center :
         {colon.shape.growths()[7].center, colon.shape.path().at(500.0).position,
          colon.shape.path().at(1200.0).position}) {
        const Grid grid =
            axisAlignedGrid({64, 64, 46}, {0.75, 0.75, 1.05}, center - glm::dvec3(24.0));
        const auto field = [&](glm::dvec3 p) { return colon.shape.evaluate(p).lumenMm; };
        const TrueSurface surface({field, nullptr}, insideOf(grid, field), 2);
        Random random(3, 3);
        for (int n = 0; n < 40; ++n) {
            const auto& sample =
                surface.samples()[std::size_t(random.index(int(surface.samples().size())))];
            const glm::dvec3 p = sample.positionMm + 0.35 * random.normal3();
            if (glm::any(glm::greaterThan(glm::abs(p - center), glm::dvec3(22.0)))) continue;
            const double exact = bruteForceMm(colon.shape, p, 1.2);
            if (exact > 1.1) continue;
            const double error = surface.distanceMm(p) - exact;
            sum += std::abs(error), largest = std::max(largest, std::abs(error)), ++compared;
        }
    }
    EXPECT_GT(compared, 80);
    EXPECT_LT(sum / compared, 0.01);
    EXPECT_LT(largest, 0.1) << "at a crease";
}

TEST(SurfaceScore, AWiderSphereIsOutsideByTheDifference) {
    const TrueSurface truth = surfaceOf(ball);
    const auto score = scoreSurface(sphere(20.3), truth, {20000, 2});
    ASSERT_TRUE(score.has_value());
    for (const SurfaceDistances* way : {&score->fromMesh, &score->fromTruth}) {
        EXPECT_NEAR(way->meanMm, 0.3, 0.003);
        EXPECT_NEAR(way->p95Mm, 0.3, 0.003);
        EXPECT_NEAR(way->maxMm, 0.3, 0.003);
        EXPECT_NEAR(way->areaMm2 / (4 * std::numbers::pi * 400.0), 1.0, 0.04);
        EXPECT_EQ(way->leftOutAreaMm2, 0.0);
    }
    EXPECT_NEAR(score->biasMm, 0.3, 0.003);
    EXPECT_NEAR(scoreSurface(sphere(19.8), truth, {20000, 2})->biasMm, -0.2, 0.003);
    EXPECT_NEAR(score->hausdorffMm(), 0.3, 0.003);
}

TEST(SurfaceScore, AMissingCapIsSeenFromTheTruthAlone) {
    // Open beyond 120° from the pole: the truth's other pole is 20 · 60° of arc away.
    const auto score =
        scoreSurface(sphere(20.0, 2 * std::numbers::pi / 3), surfaceOf(ball), {20000, 2});
    EXPECT_LT(score->fromMesh.maxMm, 0.01);
    EXPECT_NEAR(score->fromTruth.maxMm, 20.0, 0.5);  // the chord
    EXPECT_LT(score->fromTruth.farthestMm.z, -19.8);
    EXPECT_GT(score->fromTruth.p95Mm, 10.0);
    EXPECT_EQ(score->hausdorffMm(), score->fromTruth.maxMm);
}

TEST(SurfaceScore, ASpikeBetweenTheSamplesCounts) {
    TriMesh mesh = sphere(20.0);
    mesh.vertices[240 * 240 + 7] *= 1.2;
    const auto score = scoreSurface(mesh, surfaceOf(ball), {500, 1});
    EXPECT_NEAR(score->fromMesh.maxMm, 4.0, 0.01);
}

TEST(SurfaceScore, WhatTheTruthLeavesOutIsNotJudged) {
    const auto upper = [](glm::dvec3 p) { return p.z > 0.0; };
    TriMesh mesh = sphere(20.1);
    for (glm::dvec3& vertex : mesh.vertices) {
        if (vertex.z > 1.0) vertex *= 1.3;
    }
    const auto score = scoreSurface(mesh, surfaceOf(ball, upper), {20000, 2});
    EXPECT_NEAR(score->fromMesh.meanMm, 0.1, 0.003);
    EXPECT_LT(score->hausdorffMm(), 0.12);
    EXPECT_NEAR(score->fromTruth.leftOutAreaMm2 / (2 * std::numbers::pi * 400.0), 1.0, 0.02);
}

TEST(SurfaceScore, IsTheSameForAnyNumberOfThreadsAndRefusesNothing) {
    const TrueSurface truth = surfaceOf(ball);
    const auto one = scoreSurface(sphere(20.05), truth, {3000, 1}),
               three = scoreSurface(sphere(20.05), truth, {3000, 3});
    EXPECT_EQ(one->fromMesh.meanMm, three->fromMesh.meanMm);
    EXPECT_EQ(one->fromTruth.meanMm, three->fromTruth.meanMm);
    EXPECT_FALSE(scoreSurface(TriMesh{}, truth).has_value());
    const TrueSurface none({ball, nullptr}, Volume<std::uint8_t>(phantomGrid, 1), 1);
    EXPECT_FALSE(scoreSurface(sphere(20.0), none).has_value());
}

}  // namespace
