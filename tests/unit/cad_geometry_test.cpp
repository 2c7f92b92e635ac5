// Samples of the wall, derivatives of the scan, and shapes whose curvatures are known.
#include "cad/candidates.h"
#include "cad/gaussian_kernel.h"
#include "cad/lesion.h"
#include "cad/membrane.h"
#include "cad/standing_height.h"
#include "cad/wall_lift.h"
#include "cad/wall_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

// A turned grid with voxels of three different lengths.
Grid turnedGrid() {
    Grid grid = axisAlignedGrid({40, 44, 36}, {0.8, 0.7, 1.1}, {0, 0, 0});
    const double turn = 0.4;
    const glm::dmat4 rotation(std::cos(turn), std::sin(turn), 0, 0, -std::sin(turn), std::cos(turn),
                              0, 0, 0, 0, 1, 0, -5, 3, 12, 1);
    grid.patientFromVoxel = rotation * grid.patientFromVoxel;
    return grid;
}

template <class Field>
Volume<std::int16_t> sampled(const Grid& grid, const Field& field) {
    Volume<std::int16_t> volume(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        volume.writable()[n] = std::int16_t(
            std::lround(field(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))))));
    return volume;
}

glm::dvec3 middleOf(const Grid& grid) {
    return grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size - 1));
}

cad::SmoothScan wholeScan(const Volume<std::int16_t>& volume, double sigmaMm) {
    glm::dvec3 low(1e9), high(-1e9);
    for (int n = 0; n < 8; ++n) {
        const glm::dvec3 corner = volume.grid().patientFromVoxelPoint(
            glm::dvec3(volume.grid().size - 1) * glm::dvec3(n & 1, n >> 1 & 1, n >> 2 & 1));
        low = glm::min(low, corner), high = glm::max(high, corner);
    }
    return {volume, low, high, sigmaMm, 2};
}

TEST(SmoothScan, KeepsTheDerivativesOfAQuadraticField) {
    // Smoothing adds a constant to it and leaves gradient and Hessian.
    const Grid grid = turnedGrid();
    const glm::dvec3 center = middleOf(grid);
    const glm::dmat3 hessian(6, 1, -2, 1, -4, 3, -2, 3, 8);
    const glm::dvec3 slope(20, -10, 15);
    const auto field = [&](glm::dvec3 p) {
        const glm::dvec3 q = p - center;
        return 10.0 * (glm::dot(slope, q) + 0.5 * glm::dot(q, hessian * q));
    };
    for (const double sigma : {0.0, 1.0, 1.6}) {
        const cad::SmoothScan scan = wholeScan(sampled(grid, field), sigma);
        for (const glm::dvec3 off : {glm::dvec3(0.0), glm::dvec3(1.3, -0.7, 0.4)}) {
            const cad::Derivatives found = scan.derivatives(center + off);
            EXPECT_LT(glm::length(found.gradient - 10.0 * (slope + hessian * off)), 1.5);
            for (int c = 0; c < 3; ++c)
                EXPECT_LT(glm::length(found.hessian[c] - 10.0 * hessian[c]), 1.5);
            EXPECT_LT(glm::length(scan.gradient(center + off) - found.gradient), 25.0);
        }
    }
}

TEST(SmoothScan, FourPlacesAtOnceAreEachAsItIsAlone) {
    const Grid grid = turnedGrid();
    std::mt19937 random(3);
    Volume<std::int16_t> noise(grid);
    for (std::int16_t& hu : noise.writable())
        hu = std::int16_t(int(random() % 2000) - 1000);
    const cad::SmoothScan scan = wholeScan(noise, 1.0);
    const glm::vec3 most(scan.grid().size - 1);
    const auto somewhere = [&] {
        cad::FourFloats voxel{};
        for (int c = 0; c < 3; ++c)
            voxel[c] = 0.999f * most[c] * float(random() % 100000) / 1e5f;
        return voxel;
    };
    for (int round = 0; round < 1000; ++round) {
        const std::array<cad::FourFloats, 4> voxels{somewhere(), somewhere(), somewhere(),
                                                    somewhere()};
        const cad::FourFloats all = scan.linearWithin(voxels);
        for (int n = 0; n < 4; ++n) {
            const cad::FourFloats& voxel = voxels[std::size_t(n)];
            ASSERT_EQ(all[n], scan.linearWithin(voxel));
            ASSERT_EQ(all[n], scan.linear({voxel[0], voxel[1], voxel[2]}));
        }
    }
}

// Gas inside, tissue outside, or the other way; the edge is a few millimetres wide.
double edge(double insideMm) {
    return 20.0 - 1000.0 / (1.0 + std::exp(insideMm / 0.7));
}

TEST(WallShape, OfBallsTubesAndSaddles) {
    const Grid grid = axisAlignedGrid({64, 64, 64}, {0.7, 0.7, 0.7}, {-22, -22, -22});
    const double radius = 5.0;
    // Tissue that bulges into gas as a ball does: a cap.
    const auto ball =
        wholeScan(sampled(grid, [&](glm::dvec3 p) { return edge(radius - glm::length(p)); }), 0.8);
    // A lumen: a cup seen from within.
    const auto lumen =
        wholeScan(sampled(grid, [&](glm::dvec3 p) { return edge(glm::length(p) - 12.0); }), 0.8);
    // A rod of tissue: a ridge.
    const auto rod = wholeScan(
        sampled(grid, [&](glm::dvec3 p) { return edge(radius - std::hypot(p.x, p.y)); }), 0.8);
    // z = (x² − y²)/16: a saddle with curvatures of ±1/8.
    const auto saddle = wholeScan(
        sampled(grid, [&](glm::dvec3 p) { return edge((p.x * p.x - p.y * p.y) / 16.0 - p.z); }),
        0.8);
    for (const glm::dvec3 direction :
         {glm::dvec3(1, 0, 0), glm::dvec3(0.6, 0.8, 0), glm::dvec3(0.48, 0.6, 0.64)}) {
        const cad::WallShape cap = cad::shapeOf(ball.derivatives(radius * direction));
        EXPECT_NEAR(cap.k1, 1.0 / radius, 0.03);
        EXPECT_NEAR(cap.k2, 1.0 / radius, 0.03);
        EXPECT_GT(cap.shapeIndex(), 0.95);
        EXPECT_NEAR(cap.curvedness(), 1.0 / radius, 0.03);
        EXPECT_LT(glm::dot(glm::dvec3(cap.intoWall), direction), -0.99);
        const cad::WallShape cup = cad::shapeOf(lumen.derivatives(12.0 * direction));
        EXPECT_NEAR(cup.k1, -1.0 / 12.0, 0.02);
        EXPECT_LT(cup.shapeIndex(), 0.05);
    }
    const cad::WallShape ridge = cad::shapeOf(rod.derivatives({radius, 0, 1.2}));
    EXPECT_NEAR(ridge.k1, 1.0 / radius, 0.03);
    EXPECT_NEAR(ridge.k2, 0.0, 0.01);
    EXPECT_NEAR(ridge.shapeIndex(), 0.75, 0.03);
    const cad::WallShape pass = cad::shapeOf(saddle.derivatives({0, 0, 0}));
    EXPECT_NEAR(pass.k1, 0.125, 0.02);
    EXPECT_NEAR(pass.k2, -0.125, 0.02);
    EXPECT_NEAR(pass.shapeIndex(), 0.5, 0.03);
    const cad::WallShape flat = cad::shapeOf({});
    EXPECT_EQ(flat.shapeIndex(), 0.5f);
}

// Eight octahedron faces, each divided; outward.
TriMesh sphere(double radius, int divisions) {
    TriMesh mesh;
    const auto add = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
        for (int i = 0; i < divisions; ++i) {
            for (int j = 0; i + j < divisions; ++j) {
                const auto at = [&](int u, int v) {
                    return a + (b - a) * (double(u) / divisions) +
                           (c - a) * (double(v) / divisions);
                };
                const auto triangle = [&](glm::dvec3 p, glm::dvec3 q, glm::dvec3 r) {
                    const int first = int(mesh.vertices.size());
                    mesh.vertices.insert(mesh.vertices.end(), {p, q, r});
                    mesh.triangles.push_back({first, first + 1, first + 2});
                };
                triangle(at(i, j), at(i + 1, j), at(i, j + 1));
                if (i + j < divisions - 1) triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            }
        }
    };
    for (int n = 0; n < 8; ++n) {
        const glm::dvec3 x(n & 1 ? -1 : 1, 0, 0), y(0, n & 2 ? -1 : 1, 0), z(0, 0, n & 4 ? -1 : 1);
        const bool flip = (n & 1) ^ (n >> 1 & 1) ^ (n >> 2 & 1);
        flip ? add(x, z, y) : add(x, y, z);
    }
    for (glm::dvec3& v : mesh.vertices)
        v = radius * glm::normalize(v);
    return mesh;
}

TEST(WallSamples, AnEdgeIsCutIntoNoMorePiecesThanItTakes) {
    // 1.05 mm takes three pieces of at most 0.5 mm, where halves of halves would be four.
    TriMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1.05, 0, 0}, {0.5, 0.1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const cad::WallSamples samples = cad::sampleWall(mesh, 0.5);
    std::vector<double> along;
    for (const glm::dvec3& v : samples.mesh.vertices)
        if (v.y == 0.0) along.push_back(v.x);
    std::sort(along.begin(), along.end());
    ASSERT_EQ(along.size(), 4u);
    for (std::size_t n = 1; n < along.size(); ++n)
        EXPECT_NEAR(along[n] - along[n - 1], 0.35, 1e-9);
}

TEST(WallSamples, LieCloseOnTheSurfaceItself) {
    // One large and one narrow triangle with an edge between them, and a closed tetrahedron.
    TriMesh mesh;
    mesh.vertices = {{0, 0, 0}, {4, 0, 0},  {0, 3, 0}, {4.2, 3.1, 0.3},
                     {9, 0, 0}, {11, 0, 0}, {9, 2, 0}, {9, 0, 1.5}};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 6, 5}, {4, 5, 7}, {5, 6, 7}, {6, 4, 7}};
    const cad::WallSamples samples = cad::sampleWall(mesh, 0.5);
    const MeshTopology before = meshTopology(mesh), after = meshTopology(samples.mesh);
    EXPECT_EQ(after.eulerCharacteristic, before.eulerCharacteristic);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.nonManifoldEdges, 0);
    double area = 0.0, areaBefore = 0.0;
    for (const float mm2 : samples.areaMm2)
        area += mm2;
    for (const glm::ivec3& t : mesh.triangles)
        areaBefore += 0.5 * glm::length(glm::cross(
                                mesh.vertices[std::size_t(t.y)] - mesh.vertices[std::size_t(t.x)],
                                mesh.vertices[std::size_t(t.z)] - mesh.vertices[std::size_t(t.x)]));
    EXPECT_NEAR(area, areaBefore, 1e-4);
    for (std::size_t n = 0; n < samples.mesh.triangles.size(); ++n) {
        const glm::ivec3 t = samples.mesh.triangles[n],
                         s = mesh.triangles[std::size_t(samples.sourceTriangle[n])];
        const glm::dvec3 a = mesh.vertices[std::size_t(s.x)],
                         normal = glm::normalize(glm::cross(mesh.vertices[std::size_t(s.y)] - a,
                                                            mesh.vertices[std::size_t(s.z)] - a));
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 p = samples.mesh.vertices[std::size_t(t[c])];
            EXPECT_LE(glm::distance(p, samples.mesh.vertices[std::size_t(t[(c + 1) % 3])]), 0.5);
            EXPECT_NEAR(glm::dot(normal, p - a), 0.0, 1e-9);
        }
    }
    for (std::uint32_t v = 0; v < samples.mesh.vertices.size(); ++v) {
        // Each triangle that has it as a corner, and each other corner of these, once.
        std::vector<std::uint32_t> triangles;
        std::set<std::uint32_t> corners;
        for (std::uint32_t t = 0; t < samples.mesh.triangles.size(); ++t) {
            const glm::ivec3 each = samples.mesh.triangles[t];
            if (!glm::any(glm::equal(each, glm::ivec3(int(v))))) continue;
            triangles.push_back(t);
            for (int n = 0; n < 3; ++n)
                corners.insert(std::uint32_t(each[n]));
        }
        corners.erase(v);
        EXPECT_TRUE(std::ranges::equal(samples.trianglesAround(v), triangles));
        EXPECT_TRUE(std::ranges::equal(samples.around(v), corners));
    }
}

TEST(WallSamples, AreJoinedOnceToEachNeighbourWhateverTheMesh) {
    // An edge of three triangles, two fans at one vertex, a corner that a triangle has twice, and
    // one that no triangle has; and nothing.
    cad::WallSamples samples;
    samples.mesh.vertices.resize(10, glm::dvec3(0.0));
    samples.mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {4, 5, 6}, {7, 8, 8}};
    cad::joinSamples(samples);
    for (std::uint32_t v = 0; v < samples.mesh.vertices.size(); ++v) {
        std::set<std::uint32_t> others;
        for (const glm::ivec3& t : samples.mesh.triangles)
            if (glm::any(glm::equal(t, glm::ivec3(int(v)))))
                for (int n = 0; n < 3; ++n)
                    others.insert(std::uint32_t(t[n]));
        others.erase(v);
        EXPECT_TRUE(std::ranges::equal(samples.around(v), others)) << v;
    }
    cad::WallSamples none;
    cad::joinSamples(none);
    EXPECT_TRUE(none.neighbours.empty());
}

TEST(SampleNumbers, HoldWhatWasAddedSinceTheyWereEmptied) {
    cad::SampleNumbers numbers(10, 40);  // marks are made anew every few rounds
    std::mt19937 random(5);
    for (int round = 0; round < 50; ++round) {
        numbers.clear();
        std::vector<std::uint32_t> added;
        for (std::uint32_t n = 0; n < 12; ++n) {
            const std::uint32_t sample = random() % 10;
            numbers.add(sample);
            if (std::ranges::find(added, sample) == added.end()) added.push_back(sample);
            ASSERT_EQ(numbers.count(), added.size());
        }
        for (std::uint32_t sample = 0; sample < 10; ++sample) {
            const auto at = std::ranges::find(added, sample);
            ASSERT_EQ(numbers.has(sample), at != added.end());
            if (at == added.end()) continue;
            ASSERT_EQ(numbers.number(sample), at - added.begin());
            ASSERT_EQ(numbers.sample(numbers.number(sample)), sample);
        }
    }
}

TEST(Membrane, LiesInThePlaneThatItsRimLiesIn) {
    // Whatever stands within a plane rim, the film is the plane, and its places stay within the
    // rim. A large film, found on two levels, takes no more steps than a small one, which has a
    // tenth of its width; by one level it would take some ten times as many.
    TriMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    int fewSteps = 0;
    for (const double spacing : {0.05, 0.005}) {
        cad::WallSamples samples = cad::sampleWall(mesh, spacing);
        cad::SampleNumbers inside(samples.mesh.vertices.size());
        const auto planeAt = [](glm::dvec3 p) { return 0.1 * p.x - 0.3 * p.y; };
        for (std::uint32_t v = 0; v < samples.mesh.vertices.size(); ++v) {
            glm::dvec3& p = samples.mesh.vertices[v];
            if (std::max(std::abs(p.x - 0.5), std::abs(p.y - 0.5)) < 0.499) inside.add(v);
            p.z = inside.has(v)
                      ? std::sin(std::numbers::pi * p.x) * std::sin(std::numbers::pi * p.y)
                      : planeAt(p);
            p *= 20.0;
        }
        const bool large = spacing < 0.01;
        ASSERT_EQ(inside.count() >= cad::Membrane::largeFilm, large);
        const cad::Membrane film(samples, inside);
        for (std::uint32_t n = 0; n < inside.count(); ++n) {
            const glm::dvec3 p = film.at(n);
            ASSERT_NEAR(p.z, planeAt(p), 0.02);
            ASSERT_TRUE(p.x > 0.0 && p.x < 20.0 && p.y > 0.0 && p.y < 20.0);
        }
        if (large)
            EXPECT_LE(film.steps(), fewSteps);
        else
            fewSteps = film.steps();
    }
}

TEST(WallShape, ABroadScaleAsksForNoMoreAroundTheWallThanItsKernelReaches) {
    // So that a smaller box gives the same.
    const Grid grid = axisAlignedGrid({64, 64, 64}, {0.7, 0.7, 1.1}, {-22, -22, -35});
    const auto scan = sampled(grid, [&](glm::dvec3 p) {
        return edge(glm::length(p) - 12.0) + 30.0 * std::sin(p.x) * std::cos(1.7 * p.y + p.z);
    });
    const double reach = cad::kernelDeviations * cad::broadSigmaMm + 1.1;
    const auto around = [&](double mm) {
        return cad::SmoothScan(scan, glm::dvec3(-3.0 - mm), glm::dvec3(3.0 + mm), cad::broadSigmaMm,
                               1);
    };
    const cad::SmoothScan narrow = around(reach), wide = around(reach + 8.0),
                          short_ = around(reach - 5.0);
    double off = 0.0;
    for (const glm::dvec3 p : {glm::dvec3(-3.0), glm::dvec3(3.0), glm::dvec3(3.0, -3.0, 0.4)}) {
        EXPECT_NEAR(narrow.derivatives(p).hu, wide.derivatives(p).hu, 1e-2);
        EXPECT_LT(glm::distance(narrow.derivatives(p).gradient, wide.derivatives(p).gradient),
                  1e-2);
        off = std::max(off, std::abs(short_.derivatives(p).hu - wide.derivatives(p).hu));
    }
    EXPECT_GT(off, 1e-2);
}

// A closed wall 120 mm long and 20 mm wide, a cigar, each sample of which bulges where asked.
struct Cigar {
    cad::WallEvidence evidence;
    template <class Bulges>
    explicit Cigar(const Bulges& bulges) {
        TriMesh mesh;
        mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
        mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                          {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
        mesh = cad::sampleWall(mesh, 0.05).mesh;
        for (glm::dvec3& v : mesh.vertices)
            v = glm::dvec3(10, 10, 60) * glm::normalize(v);
        evidence.samples = cad::sampleWall(mesh, 0.5);
        const std::size_t count = evidence.samples.mesh.vertices.size();
        evidence.unseen.resize(count, 0);
        for (const glm::dvec3& v : evidence.samples.mesh.vertices) {
            const float k = bulges(v) ? 0.1f : -0.1f;
            evidence.shapes.push_back({.k1 = k, .k2 = k});
        }
    }
    // Whether the only patch has the place.
    bool holds(const std::vector<cad::Patch>& patches, glm::dvec3 place) const {
        EXPECT_EQ(patches.size(), 1u);
        if (patches.empty()) return false;
        std::uint32_t nearest = 0;
        const auto& places = evidence.samples.mesh.vertices;
        for (std::uint32_t v = 0; v < places.size(); ++v)
            if (glm::distance(places[v], place) < glm::distance(places[nearest], place))
                nearest = v;
        return std::ranges::binary_search(patches[0].samples, nearest);
    }
};

TEST(Candidates, WhatAPatchEnclosesIsPartOfIt) {
    const auto fromSide = [](glm::dvec3 p) { return glm::length(glm::dvec2(p.y, p.z)); };
    // A ring on one side has its middle, and not the other side; so has one with two holes.
    const Cigar ring([&](glm::dvec3 p) { return p.x > 0 && fromSide(p) > 2 && fromSide(p) < 5; });
    const auto filled = cad::patchesByShape(ring.evidence, cad::Generator::shape, 2);
    EXPECT_TRUE(ring.holds(filled, {10, 0, 0}));
    EXPECT_FALSE(ring.holds(filled, {-10, 0, 0}));
    EXPECT_FALSE(ring.holds(filled, {0, 0, 60}));
    const Cigar eight([&](glm::dvec3 p) {
        return p.x > 0 && fromSide(p) < 6 && glm::length(glm::dvec2(p.y, p.z - 3)) > 1.5 &&
               glm::length(glm::dvec2(p.y, p.z + 3)) > 1.5;
    });
    const auto both = cad::patchesByShape(eight.evidence, cad::Generator::shape, 2);
    EXPECT_TRUE(eight.holds(both, {9.5, 0, 3}));
    EXPECT_TRUE(eight.holds(both, {9.5, 0, -3}));
    EXPECT_FALSE(eight.holds(both, {-10, 0, 0}));
    // A belt encloses nothing: the wall goes on at both its sides.
    const Cigar belt([](glm::dvec3 p) { return std::abs(p.z) < 3; });
    const auto round = cad::patchesByShape(belt.evidence, cad::Generator::shape, 2);
    EXPECT_FALSE(belt.holds(round, {0, 0, 60}));
    EXPECT_FALSE(belt.holds(round, {0, 0, -60}));
    // One around the tip does.
    const Cigar cap([](glm::dvec3 p) { return p.z > 50 && p.z < 58; });
    const auto tip = cad::patchesByShape(cap.evidence, cad::Generator::shape, 2);
    EXPECT_TRUE(cap.holds(tip, {0, 0, 60}));
    EXPECT_FALSE(cap.holds(tip, {0, 0, -60}));
}

TEST(Candidates, OtherLevelsAreTheSamePatchByAnotherLimit) {
    // Two bumps on one side with a saddle between, whose k2 lies between the limits.
    const auto k2At = [](glm::dvec3 p) {
        const auto bump = [&](double z) {
            return 0.1 * std::exp(-0.5 * (p.y * p.y + (p.z - z) * (p.z - z)) / 4.0);
        };
        return p.x > 0 ? std::max(bump(-4.0), bump(4.0)) - 0.0035 : -0.1;
    };
    Cigar two([](glm::dvec3) { return false; });
    const auto& places = two.evidence.samples.mesh.vertices;
    for (std::size_t v = 0; v < places.size(); ++v)
        two.evidence.shapes[v].k1 = two.evidence.shapes[v].k2 = float(k2At(places[v]));
    // The saddle has 0.1 exp(−2) − 0.0035 = 0.010: less than the limit of 0.012, more than half.
    const auto patches = cad::patchesByShape(two.evidence, cad::Generator::shape, 2);
    ASSERT_EQ(patches.size(), 2u);
    const std::vector<const cad::Patch*> asked{&patches[0], &patches[1]};
    const auto levels = cad::otherLevels(two.evidence, asked, 2);
    const auto above = [&](double k2, double side) {
        std::vector<std::uint32_t> samples;
        for (std::uint32_t v = 0; v < places.size(); ++v)
            if (two.evidence.shapes[v].k2 >= float(k2) && side * places[v].z >= 0.0)
                samples.push_back(v);
        return samples;
    };
    for (std::size_t n = 0; n < 2; ++n) {
        const double side = places[patches[n].samples[0]].z > 0.0 ? 1.0 : -1.0;
        EXPECT_EQ(patches[n].samples, above(0.012, side));
        ASSERT_EQ(levels[n].size(), 2u);
        EXPECT_EQ(levels[n][0].samples, above(0.006, 0.0)) << "both bumps are one";
        EXPECT_EQ(levels[n][1].samples, above(0.024, side));
        for (const cad::Patch& level : levels[n])
            EXPECT_EQ(level.by, cad::Generator::shape);
    }
    // At the broad scale likewise, by its own limits.
    two.evidence.broadShapes = two.evidence.shapes;
    for (cad::WallShape& shape : two.evidence.broadShapes)
        shape.k2 -= 0.0325f;  // the saddle has −0.0225, less than −0.02 and more than −0.03
    const auto broad = cad::patchesByShape(two.evidence, cad::Generator::broadShape, 2);
    ASSERT_EQ(broad.size(), 2u);
    const std::vector<const cad::Patch*> first{&broad[0]};
    const auto broadLevels = cad::otherLevels(two.evidence, first, 2);
    const double side = places[broad[0].samples[0]].z > 0.0 ? 1.0 : -1.0;
    ASSERT_EQ(broadLevels[0].size(), 2u);
    EXPECT_EQ(broadLevels[0][0].samples, above(-0.03 + 0.0325, 0.0));
    EXPECT_EQ(broadLevels[0][1].samples, above(-0.01 + 0.0325, side));
    EXPECT_EQ(broadLevels[0][0].by, cad::Generator::broadShape);
    // By narrower limits one patch may be two; a wide one that is too large is none.
    for (std::size_t v = 0; v < places.size(); ++v)
        two.evidence.shapes[v].k2 += places[v].x > 0 ? 0.010f : 0.107f;
    const auto one = cad::patchesByShape(two.evidence, cad::Generator::shape, 2);
    ASSERT_EQ(one.size(), 1u);
    const std::vector<const cad::Patch*> only{&one[0]};
    const auto parts = cad::otherLevels(two.evidence, only, 1);
    ASSERT_EQ(parts[0].size(), 2u) << "all the wall reaches 0.006: 7,000 mm²";
    EXPECT_EQ(parts[0][0].samples.size() + parts[0][1].samples.size(), above(0.024, 0.0).size());
}

// A stretch of a tube's wall with a plateau on it, and perhaps another beside: lumen inside, scan
// and mesh of the same field.
struct Plateau {
    static constexpr double radiusMm = 15.0;
    double widthMm = 14.0, heightMm = 2.0;
    double longer = 1.0;     // how often as long along the tube as wide
    double besideMm = 0.0;   // how far from the first's middle the other's is; 0: there is none
    double foldMm = 0.0;     // of a fold around the tube, beneath the first
    double meshOffMm = 0.0;  // every other vertex of the mesh lies so far inside the lumen
    cad::WallEvidence evidence = {};

    static glm::dvec2 along(glm::dvec3 p) { return {radiusMm * std::atan2(p.y, p.x), p.z}; }
    double offMm(glm::dvec2 place) const { return glm::length(place / glm::dvec2(1.0, longer)); }
    double wallAt(glm::dvec2 place) const {
        const auto rises = [&](double offMm) {
            return heightMm / (1.0 + std::exp((offMm - 0.5 * widthMm) / 0.4));
        };
        double height = rises(offMm(place));
        if (besideMm > 0.0) height += rises(glm::distance(place, {0.0, besideMm}));
        height += foldMm * std::exp(-0.5 * std::pow(place.y / 3.0, 2.0));
        return radiusMm - height;
    }
    void make() {
        const Grid grid = axisAlignedGrid({36, 72, 72}, {0.7, 0.7, 0.7}, {-2, -25, -25});
        evidence.smooth = std::make_unique<const cad::SmoothScan>(wholeScan(
            sampled(grid,
                    [&](glm::dvec3 p) { return edge(std::hypot(p.x, p.y) - wallAt(along(p))); }),
            0.6));
        TriMesh mesh;
        constexpr int count = 60;
        for (int i = 0; i < count; ++i) {
            for (int j = 0; j < count; ++j) {
                const glm::dvec2 place = 0.6 * (glm::dvec2(i, j) - 0.5 * (count - 1));
                const double r = wallAt(place) - ((i + j) % 2 ? meshOffMm : 0.0);
                const double turn = place.x / radiusMm;
                mesh.vertices.push_back({r * std::cos(turn), r * std::sin(turn), place.y});
                const int n = i * count + j;
                if (i + 1 < count && j + 1 < count) {
                    mesh.triangles.push_back({n, n + count, n + 1});
                    mesh.triangles.push_back({n + 1, n + count, n + count + 1});
                }
            }
        }
        evidence.samples = cad::sampleWall(mesh, 0.5);
        evidence.shapes = cad::shapesOf(evidence.samples, *evidence.smooth, 2);
        evidence.statistics = {20.0, -100.0, 10.0};
        evidence.unseen.assign(evidence.samples.mesh.vertices.size(), 0);
        evidence.untagged = evidence.unseen;
    }
    cad::Patch patchWithin(double mm) const {
        cad::Patch patch;
        for (std::uint32_t v = 0; v < evidence.samples.mesh.vertices.size(); ++v)
            if (offMm(along(evidence.samples.mesh.vertices[v])) < mm) patch.samples.push_back(v);
        return patch;
    }
    double meanWithin(double mm) const {
        double sum = 0.0, area = 0.0;
        for (const std::uint32_t v : patchWithin(mm).samples) {
            sum += evidence.samples.areaMm2[v] *
                   (radiusMm - wallAt(along(evidence.samples.mesh.vertices[v])));
            area += evidence.samples.areaMm2[v];
        }
        return sum / area;
    }
    cad::WallLift liftWithin(double mm) const {
        cad::SampleNumbers numbers(evidence.samples.mesh.vertices.size());
        return cad::liftOf(evidence, patchWithin(mm), numbers);
    }
};

TEST(WallLift, IsTheHeightAboveTheTubeThatALesionStandsOn) {
    for (const double height : {0.0, 1.5, 2.5}) {
        Plateau plateau{.heightMm = height};
        plateau.make();
        const cad::WallLift lift = plateau.liftWithin(7.5);
        EXPECT_NEAR(lift.meanMm, plateau.meanWithin(7.5), 0.15);
        EXPECT_NEAR(lift.topMm, height, 0.2);
        EXPECT_LT(lift.roughMm, 0.1);
    }
}

TEST(WallLift, SeesWhatASoapFilmSpansOver) {
    // The film has no mean curvature, the tube has: over the tube's wall it is a hill of up to
    // d²/16r. Beneath a patch that is only the lesion's middle it hangs from the lesion itself.
    Plateau plateau;
    plateau.make();
    const auto lesionWithin = [&](double mm) {
        cad::SampleNumbers numbers(plateau.evidence.samples.mesh.vertices.size());
        return cad::standUp(plateau.evidence, plateau.patchWithin(mm),
                            plateau.evidence.smooth->grid(), numbers);
    };
    const auto whole = lesionWithin(7.5), middle = lesionWithin(5.0);
    ASSERT_TRUE(whole && middle);
    EXPECT_LT(whole->axis.x, -0.99);
    EXPECT_LT(whole->heightMm, 0.7 * plateau.heightMm);
    EXPECT_GT(plateau.liftWithin(7.5).topMm, 0.9 * plateau.heightMm);
    EXPECT_LT(middle->heightMm, 0.3 * plateau.heightMm);
    EXPECT_GT(plateau.liftWithin(5.0).topMm, 1.5 * middle->heightMm);
}

TEST(WallLift, HoldsBesideAnotherLesionAndOnARoughMesh) {
    Plateau beside{.widthMm = 8.0, .besideMm = 12.0};
    beside.make();
    // All places weighed alike, the other plateau would make it 0.12 mm too high.
    EXPECT_NEAR(beside.liftWithin(4.5).topMm, beside.heightMm, 0.06);
    Plateau rough{.meshOffMm = 0.5};
    rough.make();
    EXPECT_NEAR(rough.liftWithin(7.5).topMm, rough.heightMm, 0.15);
    EXPECT_LT(rough.liftWithin(7.5).roughMm, 0.1);
    // Nothing is told where there is nothing around.
    const cad::WallLift none = rough.liftWithin(1e3);
    EXPECT_EQ(none.meanMm, 0.0);
    EXPECT_EQ(none.topMm, 0.0);
    EXPECT_EQ(none.roughMm, 0.0);
}

TEST(WallLift, LeavesOutWallThatNobodyHasSeen) {
    for (const auto which : {&cad::WallEvidence::unseen, &cad::WallEvidence::untagged}) {
        Plateau plateau;
        plateau.make();
        auto& vertices = plateau.evidence.samples.mesh.vertices;
        std::vector<std::uint8_t>& marked = plateau.evidence.*which;
        // On one side the wall is told where it is not, by more than a sample is brought back.
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            const glm::dvec2 place = plateau.along(vertices[v]);
            marked[v] = place.y > 2.0 && glm::length(place) > 8.0;
            if (marked[v]) vertices[v] *= glm::dvec3(0.7, 0.7, 1.0);
        }
        EXPECT_NEAR(plateau.liftWithin(7.5).topMm, plateau.heightMm, 0.25);
        marked.assign(vertices.size(), 0);
        EXPECT_GT(std::abs(plateau.liftWithin(7.5).topMm - plateau.heightMm), 0.5);
    }
}

TEST(Lesion, HasItsCentreInItsBodyEvenWhereThatCancels) {
    // Over a low plateau the film is a hill of its own: with some height in between, as much of the
    // body lies beneath its base as above.
    const auto lesionOf = [](double heightMm) {
        Plateau plateau{.heightMm = heightMm};
        plateau.make();
        cad::SampleNumbers numbers(plateau.evidence.samples.mesh.vertices.size());
        return cad::standUp(plateau.evidence, plateau.patchWithin(9.0),
                            plateau.evidence.smooth->grid(), numbers);
    };
    double low = -1.0, high = 6.0;
    ASSERT_LT(lesionOf(low)->volumeMm3, 0.0);
    ASSERT_GT(lesionOf(high)->volumeMm3, 0.0);
    for (int n = 0; n < 16; ++n) {
        const double middle = 0.5 * (low + high);
        const auto lesion = lesionOf(middle);
        (lesion->volumeMm3 > 0.0 ? high : low) = middle;
        const glm::dvec3 wall(Plateau::radiusMm - std::max(0.0, middle), 0.0, 0.0);
        EXPECT_LT(glm::distance(lesion->centerMm, wall), 2.0)
            << middle << " mm high: " << lesion->volumeMm3 << " mm³";
    }
}

std::optional<cad::Lesion> lesionOf(const cad::WallEvidence& evidence, cad::Patch patch) {
    cad::SampleNumbers numbers(evidence.samples.mesh.vertices.size());
    return cad::standUp(evidence, std::move(patch), evidence.smooth->grid(), numbers);
}

double standingOf(const cad::WallEvidence& evidence, const cad::Lesion& lesion) {
    cad::SampleNumbers numbers(evidence.samples.mesh.vertices.size());
    return cad::standingHeightMm(evidence, lesion, numbers);
}

TEST(StandingHeight, OfAFlatLesionIsAboveTheTubeThoughThePatchIsItsMiddle) {
    for (const double height : {1.5, 2.5}) {
        Plateau plateau{.heightMm = height};
        plateau.make();
        for (const double patch : {7.5, 5.0}) {
            const auto lesion = lesionOf(plateau.evidence, plateau.patchWithin(patch));
            ASSERT_TRUE(lesion);
            EXPECT_LT(lesion->heightMm, 0.7 * height);
            EXPECT_NEAR(standingOf(plateau.evidence, *lesion), height, 0.3) << patch;
        }
    }
}

// What is long and low has a base that is narrow beside its length.
TEST(StandingHeight, OfALongLesionIsNotItsLength) {
    for (const double longer : {2.0, 3.0, 4.5}) {
        Plateau plateau{.widthMm = 6.0, .longer = longer};
        plateau.make();
        const auto lesion = lesionOf(plateau.evidence, plateau.patchWithin(3.2));
        ASSERT_TRUE(lesion);
        EXPECT_FALSE(cad::standsOnStalk(*lesion));
        EXPECT_GT(lesion->diameter.mm, 6.0 * longer) << "down to its foot";
        EXPECT_NEAR(standingOf(plateau.evidence, *lesion), plateau.heightMm, 0.4) << longer;
    }
}

// A ball on a stalk, upright on a flat wall.
struct Mushroom {
    static constexpr double headMm = 4.0, stalkMm = 1.5, discMm = 22.0;
    double centerMm = 9.0;  // of the ball, over the wall
    cad::WallEvidence evidence = {};

    // Of the tissue's surface, inwards.
    double depth(glm::dvec3 p) const {
        const double r = std::hypot(p.x, p.y);
        return std::max({-p.z, headMm - glm::distance(p, {0.0, 0.0, centerMm}),
                         p.z < centerMm ? stalkMm - r : -1e9});
    }
    void make() {
        const Grid grid = axisAlignedGrid({80, 80, 40}, {0.6, 0.6, 0.6}, {-23.7, -23.7, -4.0});
        evidence.smooth = std::make_unique<const cad::SmoothScan>(
            wholeScan(sampled(grid, [&](glm::dvec3 p) { return edge(depth(p)); }), 0.6));
        // Circles along the outline, from the wall's edge to the ball's pole.
        std::vector<glm::dvec2> outline;  // radius, z
        for (double r = discMm; r > stalkMm; r -= 0.4)
            outline.push_back({r, 0.0});
        const double neck = centerMm - std::sqrt(headMm * headMm - stalkMm * stalkMm);
        for (double z = 0.0; z < neck; z += 0.4)
            outline.push_back({stalkMm, z});
        const double from = std::asin(stalkMm / headMm);
        for (int n = 0; n <= 28; ++n) {
            const double t = from + (std::numbers::pi - 0.02 - from) * n / 28.0;
            outline.push_back({headMm * std::sin(t), centerMm - headMm * std::cos(t)});
        }
        constexpr int around = 72;
        TriMesh mesh;
        for (const glm::dvec2 ring : outline)
            for (int n = 0; n < around; ++n) {
                const double turn = 2.0 * std::numbers::pi * n / around;
                mesh.vertices.push_back({ring.x * std::cos(turn), ring.x * std::sin(turn), ring.y});
            }
        for (int k = 0; k + 1 < int(outline.size()); ++k)
            for (int n = 0; n < around; ++n) {
                const int next = (n + 1) % around, a = k * around, b = a + around;
                mesh.triangles.push_back({a + n, b + n, a + next});
                mesh.triangles.push_back({a + next, b + n, b + next});
            }
        evidence.samples = cad::sampleWall(mesh, 0.5);
        evidence.shapes = cad::shapesOf(evidence.samples, *evidence.smooth, 2);
        evidence.statistics = {20.0, -100.0, 10.0};
        evidence.unseen.assign(evidence.samples.mesh.vertices.size(), 0);
        evidence.untagged = evidence.unseen;
    }
    cad::Patch head() const {
        cad::Patch patch;
        for (std::uint32_t v = 0; v < evidence.samples.mesh.vertices.size(); ++v)
            if (evidence.samples.mesh.vertices[v].z > centerMm - 0.8 * headMm)
                patch.samples.push_back(v);
        return patch;
    }
};

TEST(StandingHeight, OfAHeadOnAStalkHoldsTheStalk) {
    for (const double center : {7.0, 9.0, 12.0}) {
        Mushroom mushroom{.centerMm = center};
        mushroom.make();
        const auto lesion = lesionOf(mushroom.evidence, mushroom.head());
        ASSERT_TRUE(lesion);
        EXPECT_TRUE(cad::standsOnStalk(*lesion));
        const double height = center + Mushroom::headMm;
        EXPECT_NEAR(standingOf(mushroom.evidence, *lesion), height, 0.5) << center;
        // Its base, a film across the stalk, is no wall.
        EXPECT_LT(lesion->heightMm, 2.0 * Mushroom::headMm + 2.5) << center;
    }
}

// Its flanks are beneath whatever stands on a fold's crest: they are not told as its height.
TEST(StandingHeight, OnAFoldIsNotTheFolds) {
    Plateau onFold{.widthMm = 8.0, .foldMm = 6.0};
    onFold.make();
    const auto lesion = lesionOf(onFold.evidence, onFold.patchWithin(4.5));
    ASSERT_TRUE(lesion);
    const double height = standingOf(onFold.evidence, *lesion);
    EXPECT_LE(height, lesion->heightMm);
    EXPECT_GT(height, 0.9 * onFold.heightMm);
    EXPECT_LT(height, onFold.heightMm + 0.4 * onFold.foldMm);
}

TEST(StandingHeight, IsTheFilmsWhereNobodyHasSeenTheWallAround) {
    Plateau plateau;
    plateau.make();
    const auto lesion = lesionOf(plateau.evidence, plateau.patchWithin(7.5));
    ASSERT_TRUE(lesion);
    plateau.evidence.unseen.assign(plateau.evidence.unseen.size(), 1);
    EXPECT_EQ(standingOf(plateau.evidence, *lesion), lesion->heightMm);
}

TEST(Lesion, VoxelsWithinABodyAreThoseWhoseCentresItHolds) {
    const Grid grid = turnedGrid();
    const double radius = 6.0;
    TriMesh body = sphere(radius, 24);
    const glm::dvec3 center = middleOf(grid) + glm::dvec3(0.21, -0.13, 0.37);
    for (glm::dvec3& v : body.vertices)
        v += center;
    Volume<std::uint8_t> held(grid, 0);
    for (const VoxelRun& run : cad::voxelsWithin(body, grid))
        for (int n = 0; n < run.count; ++n)
            ++held.writable()[grid.index(run.first + glm::ivec3(n, 0, 0))];
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const double mm =
            glm::distance(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))), center);
        if (mm < radius - 0.05) {
            EXPECT_EQ(held[n], 1) << mm;
        }
        if (mm > radius) {
            EXPECT_EQ(held[n], 0) << mm;
        }
    }
    // Beyond the grid there are none.
    for (glm::dvec3& v : body.vertices)
        v += glm::dvec3(500.0);
    EXPECT_TRUE(cad::voxelsWithin(body, grid).empty());
}

TEST(Lesion, VoxelsWithinABoxAreAllThereWhereverItsCornersLie) {
    // One face is cut in two, a hair from a plane of voxels.
    const Grid grid = axisAlignedGrid({8, 8, 8}, glm::dvec3(1.0));
    for (const int axis : {1, 2})
        for (const double off : {-3e-6, -1e-9, 0.0, 1e-9, 1e-6, 2e-6, 3e-6}) {
            const double low = 1.5, high = 5.5, cut = 3.0 + off;
            TriMesh box;
            for (int corner = 0; corner < 8; ++corner)
                box.vertices.push_back(
                    {corner & 1 ? high : low, corner & 2 ? high : low, corner & 4 ? high : low});
            const auto side = [&](int a, int b, int c, int d) {
                box.triangles.push_back({a, b, c}), box.triangles.push_back({a, c, d});
            };
            side(1, 3, 7, 5), side(0, 1, 5, 4), side(2, 6, 7, 3), side(0, 2, 3, 1),
                side(4, 5, 7, 6);
            // The face at low x, across which the cut runs.
            const int first = int(box.vertices.size());
            for (const bool far : {false, true}) {
                glm::dvec3 at(low, far ? high : low, far ? high : low);
                at[axis] = cut;
                box.vertices.push_back(at);
            }
            if (axis == 2)
                side(0, first, first + 1, 2), side(first, 4, 6, first + 1);
            else
                side(0, 4, first + 1, first), side(first, first + 1, 6, 2);
            int voxels = 0;
            for (const VoxelRun& run : cad::voxelsWithin(box, grid))
                voxels += run.count;
            EXPECT_EQ(voxels, 64) << axis << ' ' << off;
        }
}

TEST(Lesion, ADiameterIsTheGreatestDistance) {
    cad::WallSamples wall;
    std::vector<std::uint32_t> all;
    for (int n = 0; n < 200; ++n) {
        const double z = 1.0 - (2.0 * n + 1.0) / 200, r = std::sqrt(1.0 - z * z);
        wall.mesh.vertices.push_back(
            {500.0 + 5.0 * r * std::cos(2.4 * n), 3.0 * r * std::sin(2.4 * n), 2.0 * z - 700.0});
        all.push_back(std::uint32_t(n));
    }
    double most = 0.0;
    for (const glm::dvec3& a : wall.mesh.vertices)
        for (const glm::dvec3& b : wall.mesh.vertices)
            most = std::max(most, glm::distance(a, b));
    const cad::Diameter found = cad::diameterOf(wall, all);
    EXPECT_LE(found.mm, most);
    EXPECT_GT(found.mm, 0.99 * most);
    EXPECT_DOUBLE_EQ(glm::distance(wall.mesh.vertices[found.from], wall.mesh.vertices[found.to]),
                     found.mm);
    EXPECT_EQ(cad::diameterOf(wall, {}).mm, 0.0);
    EXPECT_EQ(cad::diameterOf(wall, std::vector<std::uint32_t>{7}).mm, 0.0);
    EXPECT_EQ(cad::diameterOf(wall, std::vector<std::uint32_t>{7, 7}).mm, 0.0);
}

}  // namespace
