// Handles of known girth are cut where they are thinnest, and nothing else changes.
#include "handles/handle_removal.h"

#include "data_folder.h"
#include "handle_meshes.h"
#include "handles/self_intersection.h"
#include "mesh/mesh_file.h"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

namespace haustra::handles {
namespace {

void expectSphere(const TriMesh& mesh) {
    const MeshTopology topology = meshTopology(mesh);
    EXPECT_EQ(topology.eulerCharacteristic, 2);
    EXPECT_EQ(topology.components, 1);
    EXPECT_TRUE(topology.closed());
}

/// Vertices that are no corner of a loop keep their bits; those that are stay within `nearMm`.
void expectOnlyLoopsMoved(const TriMesh& before, const HandleRemoval& removal, double nearMm) {
    ASSERT_GE(removal.mesh.vertices.size(), before.vertices.size());
    std::size_t moved = 0, corners = 0;
    for (std::size_t v = 0; v < before.vertices.size(); ++v) {
        if (before.vertices[v] == removal.mesh.vertices[v]) continue;
        ++moved;
        EXPECT_LT(glm::distance(before.vertices[v], removal.mesh.vertices[v]), nearMm);
    }
    for (const RemovedHandle& handle : removal.handles)
        corners += handle.loopMm.size();
    EXPECT_LE(moved, corners);
}

double lengthOf(const std::vector<glm::dvec3>& loop) {
    double length = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i)
        length += glm::distance(loop[i], loop[(i + 1) % loop.size()]);
    return length;
}

TEST(HandleRemoval, LeavesASphereAsItIs) {
    const TriMesh sphere = tests::HandledSphere(10.0, 12).mesh();
    const auto removal = removeHandles(sphere);
    ASSERT_TRUE(removal) << describe(removal.error());
    EXPECT_TRUE(removal->handles.empty());
    EXPECT_EQ(removal->mesh.vertices, sphere.vertices);
    EXPECT_EQ(removal->mesh.triangles, sphere.triangles);
    EXPECT_EQ(removal->areaChangeMm2, 0.0);
}

TEST(HandleRemoval, CutsAThinTorusThroughItsTube) {
    const TriMesh torus = tests::torusMesh(20.0, 5.0, 120, 48);
    const auto removal = removeHandles(torus);
    ASSERT_TRUE(removal) << describe(removal.error());
    ASSERT_EQ(removal->handles.size(), 1u);
    const RemovedHandle& handle = removal->handles[0];
    const double girth = 2.0 * 48 * 5.0 * std::sin(std::numbers::pi / 48);
    EXPECT_NEAR(handle.lengthMm, girth, 1e-9 * girth);
    EXPECT_NEAR(handle.lengthMm, lengthOf(handle.loopMm), 1e-9 * girth);
    EXPECT_NEAR(handle.filledAreaMm2, 2.0 * std::numbers::pi * 25.0, 3.0);
    expectSphere(removal->mesh);
    expectOnlyLoopsMoved(torus, *removal, 1.0);
    EXPECT_TRUE(selfIntersections(removal->mesh).empty());
}

TEST(HandleRemoval, PlugsATorusWhoseHoleIsNarrow) {
    const TriMesh torus = tests::torusMesh(20.0, 15.0, 120, 90);
    const auto removal = removeHandles(torus);
    ASSERT_TRUE(removal) << describe(removal.error());
    ASSERT_EQ(removal->handles.size(), 1u);
    const double girth = 2.0 * 120 * 5.0 * std::sin(std::numbers::pi / 120);
    EXPECT_NEAR(removal->handles[0].lengthMm, girth, 1e-9 * girth);
    expectSphere(removal->mesh);
    EXPECT_TRUE(selfIntersections(removal->mesh).empty());
}

TEST(HandleRemoval, RemovesPlantedBridgesAndTunnels) {
    for (int handles = 1; handles <= 6; ++handles) {
        tests::HandledSphere sphere(50.0, 64);
        std::vector<double> girths;
        for (int i = 0; i < handles; ++i)
            girths.push_back(sphere.addTube(i, 16, 20, 16, 4, 1.5 + 0.1 * i, i % 2 == 0));
        std::sort(girths.begin(), girths.end());
        const TriMesh mesh = sphere.mesh();
        ASSERT_EQ(meshTopology(mesh).genus(), handles);
        ASSERT_TRUE(selfIntersections(mesh).empty());
        const auto removal = removeHandles(mesh);
        ASSERT_TRUE(removal) << describe(removal.error());
        ASSERT_EQ(removal->handles.size(), girths.size());
        for (std::size_t i = 0; i < girths.size(); ++i) {
            EXPECT_LE(removal->handles[i].lengthMm, girths[i] * (1.0 + 1e-9));
            EXPECT_GT(removal->handles[i].lengthMm, girths[i] * 0.995);
        }
        expectSphere(removal->mesh);
        expectOnlyLoopsMoved(mesh, *removal, 1.0);
        EXPECT_TRUE(selfIntersections(removal->mesh).empty());
    }
}

TEST(HandleRemoval, PassesOverATunnelThatSomethingGoesThrough) {
    // A torus whose hole is narrower than its tube, and a finger that reaches through the hole.
    TriMesh mesh = tests::torusMesh(20.0, 12.0, 60, 40);
    const auto ringOf = [&](int around, int along) { return around * 40 + along; };
    const int from = ringOf(0, 13);  // on top, towards the hole
    std::vector<int> rim;            // round the vertex, counter-clockwise
    for (int next = -1; rim.empty() || next != rim.front();) {
        for (const glm::ivec3& t : mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner) {
                if (t[corner] != from || (next >= 0 && t[(corner + 1) % 3] != next)) continue;
                if (rim.empty()) rim.push_back(t[(corner + 1) % 3]);
                next = t[(corner + 2) % 3];
                if (next != rim.front()) rim.push_back(next);
                corner = 3;
            }
        }
    }
    std::erase_if(mesh.triangles,
                  [&](const glm::ivec3& t) { return t.x == from || t.y == from || t.z == from; });
    glm::dvec3 center(0.0);
    for (const int v : rim)
        center += mesh.vertices[v] / double(rim.size());
    const glm::dvec3 over(0.0, 0.0, 22.0), down(0.0, 0.0, -22.0);
    const auto ringAt = [&](const glm::dvec3& at) {
        std::vector<int> ring;
        for (const int v : std::vector(rim)) {
            ring.push_back(int(mesh.vertices.size()));
            mesh.vertices.push_back(at + mesh.vertices[v] - center);
        }
        return ring;
    };
    std::vector<std::vector<int>> rings{rim};
    for (int s = 1; s <= 12; ++s)
        rings.push_back(ringAt(glm::mix(center, over, s / 12.0)));
    // Down the axis the ring lies across it, turned half over so that it keeps its sense.
    for (int s = 0; s <= 40; ++s) {
        std::vector<int> ring;
        for (std::size_t i = 0; i < rim.size(); ++i) {
            const glm::dvec3 arm = mesh.vertices[rim[i]] - center;
            ring.push_back(int(mesh.vertices.size()));
            mesh.vertices.push_back(glm::mix(over, down, s / 40.0) +
                                    glm::dvec3(-arm.x, arm.y, 0.0) - glm::dvec3(3.0, 0.0, 1.5));
        }
        rings.push_back(ring);
    }
    for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
        for (std::size_t i = 0; i < rim.size(); ++i) {
            const std::size_t j = (i + 1) % rim.size();
            mesh.triangles.push_back({rings[r][i], rings[r][j], rings[r + 1][j]});
            mesh.triangles.push_back({rings[r][i], rings[r + 1][j], rings[r + 1][i]});
        }
    }
    const int tip = int(mesh.vertices.size());
    mesh.vertices.push_back(down - glm::dvec3(3.0, 0.0, 3.0));
    for (std::size_t i = 0; i < rim.size(); ++i)
        mesh.triangles.push_back({rings.back()[i], rings.back()[(i + 1) % rim.size()], tip});
    ASSERT_EQ(meshTopology(mesh).genus(), 1);
    ASSERT_TRUE(meshTopology(mesh).closed());
    ASSERT_TRUE(selfIntersections(mesh).empty());

    const auto removal = removeHandles(mesh);
    ASSERT_TRUE(removal) << describe(removal.error());
    ASSERT_EQ(removal->handles.size(), 1u);
    const double tubeMm = 2.0 * std::numbers::pi * 12.0, holeMm = 2.0 * std::numbers::pi * 8.0;
    EXPECT_GT(removal->handles[0].lengthMm, 1.2 * holeMm);
    EXPECT_NEAR(removal->handles[0].lengthMm, tubeMm, 0.02 * tubeMm);
    expectSphere(removal->mesh);
    EXPECT_TRUE(selfIntersections(removal->mesh).empty());
}

/// The big torus lies round z; the thread is linked with it, the core runs inside its tube.
TriMesh bigTorus() {
    return tests::torusMesh(20.0, 14.0, 60, 44);
}

TriMesh thread() {
    TriMesh ring = tests::torusMesh(20.0, 3.0, 60, 12);
    for (glm::dvec3& p : ring.vertices)
        p = {p.x + 20.0, -p.z, p.y};
    return ring;
}

TriMesh core() {
    return tests::torusMesh(20.0, 2.0, 60, 12);
}

TriMesh together(const std::vector<TriMesh>& pieces) {
    TriMesh mesh;
    for (const TriMesh& piece : pieces) {
        const int first = int(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), piece.vertices.begin(), piece.vertices.end());
        for (const glm::ivec3& t : piece.triangles)
            mesh.triangles.push_back(t + first);
    }
    return mesh;
}

TEST(HandleRemoval, PassesOverATunnelThatAnotherPieceGoesThrough) {
    const double tubeMm = 2.0 * 44 * 14.0 * std::sin(std::numbers::pi / 44),
                 threadMm = 2.0 * 12 * 3.0 * std::sin(std::numbers::pi / 12);
    for (const bool threadFirst : {false, true}) {
        const TriMesh mesh =
            threadFirst ? together({thread(), bigTorus()}) : together({bigTorus(), thread()});
        ASSERT_TRUE(selfIntersections(mesh).empty());
        const auto removal = removeHandles(mesh);
        ASSERT_TRUE(removal) << describe(removal.error());
        ASSERT_EQ(removal->handles.size(), 2u);
        EXPECT_NEAR(removal->handles[threadFirst ? 1 : 0].lengthMm, tubeMm, 1e-9 * tubeMm);
        EXPECT_NEAR(removal->handles[threadFirst ? 0 : 1].lengthMm, threadMm, 1e-9 * threadMm);
        for (const RemovedHandle& handle : removal->handles)
            EXPECT_EQ(handle.crossings, 0u);
        EXPECT_EQ(meshTopology(removal->mesh).genus(), 0);
        EXPECT_EQ(meshTopology(removal->mesh).components, 2);
        EXPECT_TRUE(selfIntersections(removal->mesh).empty());
    }
}

TEST(HandleRemoval, PlugsATubeThatAnotherPieceRunsInside) {
    const TriMesh outer = tests::torusMesh(20.0, 6.0, 60, 24);
    const auto removal = removeHandles(together({outer, core()}));
    ASSERT_TRUE(removal) << describe(removal.error());
    ASSERT_EQ(removal->handles.size(), 2u);
    const double holeMm = 2.0 * 60 * 14.0 * std::sin(std::numbers::pi / 60);
    EXPECT_NEAR(removal->handles[0].lengthMm, holeMm, 1e-9 * holeMm);
    EXPECT_EQ(removal->handles[0].crossings + removal->handles[1].crossings, 0u);
    EXPECT_EQ(meshTopology(removal->mesh).genus(), 0);
    EXPECT_TRUE(selfIntersections(removal->mesh).empty());
}

TEST(HandleRemoval, TellsOfTheCrossingsWhereNoCutIsClean) {
    const TriMesh mesh = together({bigTorus(), thread(), core()});
    ASSERT_TRUE(selfIntersections(mesh).empty());
    const auto removal = removeHandles(mesh);
    ASSERT_TRUE(removal) << describe(removal.error());
    ASSERT_EQ(removal->handles.size(), 3u);
    EXPECT_GT(removal->handles[0].crossings, 0u);
    std::size_t told = 0;
    for (const RemovedHandle& handle : removal->handles)
        told += handle.crossings;
    const std::size_t found = selfIntersections(removal->mesh).size();
    EXPECT_GT(found, 0u);
    EXPECT_LE(found, told);
    EXPECT_EQ(meshTopology(removal->mesh).genus(), 0);
}

TEST(HandleRemoval, GivesTheSameBytesForAnyNumberOfThreads) {
    tests::HandledSphere sphere(50.0, 48);
    sphere.addTube(0, 10, 14, 14, 4, 2.0, true);
    sphere.addTube(3, 10, 14, 14, 4, 2.5, false);
    const auto one = removeHandles(sphere.mesh(), {1, {}}),
               three = removeHandles(sphere.mesh(), {3, {}});
    ASSERT_TRUE(one && three);
    EXPECT_EQ(one->mesh.vertices, three->mesh.vertices);
    EXPECT_EQ(one->mesh.triangles, three->mesh.triangles);
}

TEST(HandleRemoval, RefusesWhatIsNotOneClosedManifold) {
    TriMesh open = tests::torusMesh(20.0, 5.0, 24, 12), twice = open, flipped = open, sheets = open;
    open.triangles.pop_back();
    const int count = int(twice.vertices.size());
    for (int v = 0; v < count; ++v)
        twice.vertices.push_back(twice.vertices[v] + glm::dvec3(100.0, 0.0, 0.0));
    for (const glm::ivec3 t : std::vector(twice.triangles))
        twice.triangles.push_back(t + count);
    std::swap(flipped.triangles[7].x, flipped.triangles[7].y);
    TriMesh joined = twice;  // two tori that share one vertex
    for (glm::ivec3& t : joined.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            if (t[corner] == count) t[corner] = 0;
    }
    sheets.triangles.push_back(sheets.triangles[0]);
    TriMesh outside = tests::torusMesh(20.0, 5.0, 24, 12);
    outside.triangles[3].y = 100000;
    for (const TriMesh& mesh : {open, flipped, joined, sheets, outside, TriMesh{}}) {
        const auto removal = removeHandles(mesh);
        ASSERT_FALSE(removal);
        EXPECT_EQ(removal.error().kind, ErrorKind::badInput);
    }
}

TEST(HandleRemoval, OpensTheRealColonsHandle) {
    HAUSTRA_REAL_DATA(file, "meshes/colon00090_genus1_100k.ply");
    const auto mesh = mesh::readMesh(file);
    ASSERT_TRUE(mesh) << describe(mesh.error());
    ASSERT_EQ(meshTopology(*mesh).genus(), 1);
    const auto removal = removeHandles(*mesh);
    ASSERT_TRUE(removal) << describe(removal.error());
    ASSERT_EQ(removal->handles.size(), 1u);
    EXPECT_LT(removal->handles[0].lengthMm, 41.9);
    expectSphere(removal->mesh);
    expectOnlyLoopsMoved(*mesh, *removal, 2.0);
    EXPECT_TRUE(selfIntersections(removal->mesh).empty());
}

}  // namespace
}  // namespace haustra::handles
