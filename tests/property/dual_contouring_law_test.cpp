// Laws of the lumen's surface: for any labels and any HU it is a closed manifold without
// self-intersections, and its topology is that of the labels.
#include "contouring/dual_contouring.h"
#include "core/ct_scan.h"
#include "handles/self_intersection.h"
#include "label_topology.h"
#include "mesh_laws.h"

#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

using Labels = Volume<std::uint8_t>;
using Hu = Volume<std::int16_t>;

struct Case {
    Labels labels;
    Hu hu;
};

Case makeCase(glm::ivec3 size, const std::function<bool(glm::ivec3)>& inside,
              const std::function<int(glm::ivec3)>& hu) {
    const Grid grid = axisAlignedGrid(size, {0.75, 0.8, 1.05}, {-3.0, 5.0, 100.0});
    Case made{Labels(grid), Hu(grid)};
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        made.labels.writable()[n] = inside(grid.voxelAt(n)) ? 1 : 0;
        made.hu.writable()[n] = std::int16_t(hu(grid.voxelAt(n)));
    }
    return made;
}

void expectLaws(const Case& given) {
    const auto mesh = contouring::contourLumen(given.hu, given.labels, -480.0, {1});
    ASSERT_TRUE(mesh) << describe(mesh.error());
    const MeshTopology topology = meshTopology(*mesh);
    ASSERT_TRUE(topology.closed());
    ASSERT_TRUE(tests::everyVertexHasOneFan(*mesh));
    ASSERT_EQ(topology.eulerCharacteristic, 2 * tests::solidEuler(given.labels));
    // Each surface parts one component of the object from one of the background: a tree.
    ASSERT_EQ(topology.components, tests::componentCount(given.labels, true, 1) +
                                       tests::componentCount(given.labels, false, 2) - 1);
    ASSERT_GT(tests::signedVolumeMm3(*mesh), 0.0);
    ASSERT_EQ(handles::selfIntersections(*mesh).size(), 0u);
}

/// HU that make crossings anywhere, and gradients that make no sense.
std::function<int(glm::ivec3)> wildHu(std::mt19937& random) {
    return [&random](glm::ivec3) { return -1024 + int(random() % 1200); };
}

TEST(DualContouringLaw, HoldsForEveryCell) {
    std::mt19937 random(1);
    for (unsigned inside = 1; inside < 256; ++inside) {
        SCOPED_TRACE(inside);
        for (int repeat = 0; repeat < 4; ++repeat) {
            expectLaws(makeCase(
                glm::ivec3(2),
                [&](glm::ivec3 v) { return inside >> (v.x | v.y << 1 | v.z << 2) & 1; },
                wildHu(random)));
            if (HasFatalFailure()) return;
        }
    }
}

TEST(DualContouringLaw, HoldsForEveryPairOfCells) {
    std::mt19937 random(2);
    for (unsigned inside = 1; inside < 4096; ++inside) {
        SCOPED_TRACE(inside);
        expectLaws(makeCase(
            {2, 2, 3}, [&](glm::ivec3 v) { return inside >> (v.x | v.y << 1 | v.z << 2) & 1; },
            wildHu(random)));
        if (HasFatalFailure()) return;
    }
}

TEST(DualContouringLaw, HoldsForRandomLabels) {
    std::mt19937 random(3);
    for (int repeat = 0; repeat < 600; ++repeat) {
        SCOPED_TRACE(repeat);
        const glm::ivec3 size(3 + random() % 7, 3 + random() % 7, 3 + random() % 14);
        const unsigned percent = 5 + random() % 90;
        Case given = makeCase(
            size, [&](glm::ivec3) { return random() % 100 < percent; }, wildHu(random));
        given.labels.writable()[random() % given.labels.grid().voxelCount()] = 3;
        expectLaws(given);
        if (HasFatalFailure()) return;
    }
}

TEST(DualContouringLaw, HoldsForNoisyHuThresholded) {
    std::mt19937 random(4);
    for (int repeat = 0; repeat < 60; ++repeat) {
        SCOPED_TRACE(repeat);
        Case given = makeCase(
            glm::ivec3(16), [](glm::ivec3) { return false; },
            [&](glm::ivec3 v) {
                const double radius = glm::distance(glm::dvec3(v), glm::dvec3(7.6, 7.3, 7.8));
                const double noise = double(random() % 2001) / 1000.0 - 1.0;
                return int(-480.0 + 250.0 * (radius - 5.0) + 400.0 * noise);
            });
        for (std::size_t n = 0; n < given.hu.voxels().size(); ++n)
            given.labels.writable()[n] = given.hu[n] < -480 ? 1 : 0;
        expectLaws(given);
        if (HasFatalFailure()) return;
    }
}

/// Two voxels that touch along an edge alone are two balls; the background that touches so is one.
TEST(DualContouringLaw, PartsTheObjectAcrossAnAmbiguousFace) {
    auto hu = [](glm::ivec3) { return -480; };
    const Case parted = makeCase(
        {2, 2, 1}, [](glm::ivec3 v) { return v.x == v.y; }, hu);
    EXPECT_EQ(meshTopology(*contouring::contourLumen(parted.hu, parted.labels, -480.0)).components,
              2);
    const Case ring = makeCase(
        glm::ivec3(3), [](glm::ivec3 v) { return v.z == 1 && !(v.x == 1 && v.y == 1); }, hu);
    EXPECT_EQ(meshTopology(*contouring::contourLumen(ring.hu, ring.labels, -480.0)).genus(), 1);
}

Case noisyBall(std::uint32_t seed) {
    std::mt19937 random(seed);
    Case given = makeCase(
        {24, 26, 40}, [](glm::ivec3) { return false; },
        [&](glm::ivec3 v) {
            const double radius = glm::distance(glm::dvec3(v), glm::dvec3(11.6, 12.3, 17.8));
            return int(-480.0 + 250.0 * (radius - 8.0)) + int(random() % 200) - 100;
        });
    for (std::size_t n = 0; n < given.hu.voxels().size(); ++n)
        given.labels.writable()[n] = given.hu[n] < -480 ? 1 : 0;
    return given;
}

TEST(DualContouringLaw, IsTheSameForAnyNumberOfThreads) {
    const Case given = noisyBall(5);
    const TriMesh one = *contouring::contourLumen(given.hu, given.labels, -480.0, {1});
    for (int threads : {2, 3, 7}) {
        const TriMesh several =
            *contouring::contourLumen(given.hu, given.labels, -480.0, {threads});
        EXPECT_EQ(one.vertices, several.vertices);
        EXPECT_EQ(one.triangles, several.triangles);
    }
}

TEST(DualContouringLaw, MovesWithTheGrid) {
    const Case given = noisyBall(6);
    const TriMesh mesh = *contouring::contourLumen(given.hu, given.labels, -480.0);
    // The patient moves: the same triangles, every vertex shifted.
    Grid shifted = given.hu.grid();
    const glm::dvec3 shift(17.0, -230.0, 11.5);
    shifted.patientFromVoxel[3] += glm::dvec4(shift, 0.0);
    const auto none = std::shared_ptr<const void>();
    const TriMesh moved = *contouring::contourLumen(
        Hu::view(shifted, given.hu.voxels().data(), none),
        Labels::view(shifted, given.labels.voxels().data(), none), -480.0);
    ASSERT_EQ(mesh.triangles, moved.triangles);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        ASSERT_LT(glm::distance(mesh.vertices[v] + shift, moved.vertices[v]), 1e-9);
}

TEST(DualContouringLaw, TheSameBoundaryElsewhereInAScanIsTheSameToTheLastBit) {
    constexpr double ballMm = 9.0;
    std::vector<TriMesh> meshes;
    for (const glm::ivec3 at : {glm::ivec3(20, 21, 22), glm::ivec3(33, 18, 41)}) {
        const auto depth = [&](glm::ivec3 v) {
            return ballMm - glm::length(glm::dvec3(v - at) * glm::dvec3(0.75, 0.8, 1.05));
        };
        const Case made = makeCase(
            {60, 60, 60}, [&](glm::ivec3 v) { return depth(v) > 0.0; },
            [&](glm::ivec3 v) {
                const glm::ivec3 w = v - at;  // grain that goes with the ball
                return int(-480 - 300.0 * depth(v)) + (w.x * 7 + w.y * 13 + w.z * 29) % 31;
            });
        auto mesh = contouring::contourLumen(made.hu, made.labels, -480.0, {2});
        ASSERT_TRUE(mesh) << describe(mesh.error());
        meshes.push_back(*std::move(mesh));
    }
    ASSERT_EQ(meshes[0].vertices.size(), meshes[1].vertices.size());
    EXPECT_EQ(meshes[0].triangles, meshes[1].triangles);
    for (std::size_t v = 0; v < meshes[0].vertices.size(); ++v)
        ASSERT_EQ(onMeshLattice(meshes[0].vertices[v] - meshes[0].vertices[0]),
                  onMeshLattice(meshes[1].vertices[v] - meshes[1].vertices[0]));
}

TEST(DualContouringLaw, MirroredGridsGiveTheSameSolid) {
    const Case given = noisyBall(7);
    const TriMesh mesh = *contouring::contourLumen(given.hu, given.labels, -480.0);
    for (int axis = 0; axis < 3; ++axis) {
        Grid mirrored = given.hu.grid();
        mirrored.patientFromVoxel[axis] = -mirrored.patientFromVoxel[axis];
        const auto none = std::shared_ptr<const void>();
        const TriMesh other = *contouring::contourLumen(
            Hu::view(mirrored, given.hu.voxels().data(), none),
            Labels::view(mirrored, given.labels.voxels().data(), none), -480.0);
        EXPECT_NEAR(tests::signedVolumeMm3(other), tests::signedVolumeMm3(mesh), 1e-6);
    }
}

TEST(DualContouringLaw, RefusesWhatHasNoSurface) {
    const Grid grid = axisAlignedGrid({4, 4, 4}, glm::dvec3(1.0));
    const auto empty = contouring::contourLumen(Hu(grid, 0), Labels(grid, 0), -480.0);
    ASSERT_FALSE(empty);
    EXPECT_EQ(empty.error().kind, ErrorKind::noResult);
    const auto apart = contouring::contourLumen(Hu(axisAlignedGrid({4, 4, 4}, glm::dvec3(2.0)), 0),
                                                Labels(grid, 1), -480.0);
    ASSERT_FALSE(apart);
    EXPECT_EQ(apart.error().kind, ErrorKind::badInput);
}

}  // namespace
}  // namespace haustra
