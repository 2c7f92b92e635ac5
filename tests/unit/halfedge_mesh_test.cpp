#include "mesh/halfedge_mesh.h"

#include "flat_meshes.h"
#include "tube_meshes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace haustra::mesh {
namespace {

struct Parts {
    std::vector<int> opposite;
    std::vector<double> lengthMm;
};

Parts partsOf(const HalfedgeMesh& mesh) {
    Parts parts;
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        parts.opposite.push_back(mesh.opposite(h));
        parts.lengthMm.push_back(mesh.lengthMm(h));
    }
    return parts;
}

const TriMesh tube = tests::revolvedMesh(5, 4, 10.0, [](double s) { return 3.0 + s; });

TEST(HalfedgeMesh, GluedFromItsPartsIsTheSame) {
    const HalfedgeMesh mesh = *HalfedgeMesh::of(tube);
    const Parts parts = partsOf(mesh);
    const HalfedgeMesh again = *HalfedgeMesh::glued(int(tube.vertices.size()), tube.triangles,
                                                    parts.opposite, parts.lengthMm);
    ASSERT_EQ(again.halfedgeCount(), mesh.halfedgeCount());
    ASSERT_EQ(again.vertexCount(), mesh.vertexCount());
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        EXPECT_EQ(again.origin(h), mesh.origin(h));
        EXPECT_EQ(again.opposite(h), mesh.opposite(h));
    }
    for (int v = 0; v < mesh.vertexCount(); ++v)
        EXPECT_EQ(again.outgoing(v), mesh.outgoing(v));
}

TEST(HalfedgeMesh, TurningLeftFromOutgoingMeetsAllThatLeave) {
    const HalfedgeMesh mesh = *HalfedgeMesh::of(tube);
    std::vector<int> leaving(tube.vertices.size(), 0), met(tube.vertices.size(), 0);
    for (int h = 0; h < mesh.halfedgeCount(); ++h)
        ++leaving[std::size_t(mesh.origin(h))];
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        int h = mesh.outgoing(v);
        do {
            EXPECT_EQ(mesh.origin(h), v);
            ++met[std::size_t(v)];
            h = mesh.turnLeft(h);
        } while (h >= 0 && h != mesh.outgoing(v));
    }
    EXPECT_EQ(met, leaving);
}

TEST(HalfedgeMesh, RefusesPartsThatDoNotFit) {
    const HalfedgeMesh mesh = *HalfedgeMesh::of(tube);
    const Parts parts = partsOf(mesh);
    const auto glue = [&](const Parts& p) {
        return HalfedgeMesh::glued(int(tube.vertices.size()), tube.triangles, p.opposite,
                                   p.lengthMm);
    };
    int inner = 0;
    while (mesh.opposite(inner) < 0)
        ++inner;
    for (const int wrong : {-2, inner, HalfedgeMesh::next(inner), mesh.halfedgeCount()}) {
        Parts torn = parts;
        torn.opposite[std::size_t(inner)] = wrong;
        EXPECT_FALSE(glue(torn)) << wrong;
    }
    Parts stretched = parts;
    stretched.lengthMm[std::size_t(inner)] *= 2.0;
    EXPECT_FALSE(glue(stretched));
    Parts few = parts;
    few.opposite.pop_back();
    EXPECT_FALSE(glue(few));
    // Opened along every edge, the triangles meet at vertices alone.
    Parts loose = parts;
    loose.opposite.assign(loose.opposite.size(), -1);
    EXPECT_FALSE(glue(loose));
}

TEST(HalfedgeMesh, OppositesRunBetweenTheSameVerticesAndAreAllFound) {
    const TriMesh closed = tests::capsule(10.0, 20.0, 12);
    for (const TriMesh& surface : {tube, closed}) {
        const HalfedgeMesh mesh = *HalfedgeMesh::of(surface);
        for (int h = 0; h < mesh.halfedgeCount(); ++h) {
            int expected = -1;
            for (int g = 0; g < mesh.halfedgeCount(); ++g) {
                if (mesh.origin(g) == mesh.target(h) && mesh.target(g) == mesh.origin(h))
                    expected = g;
            }
            ASSERT_EQ(mesh.opposite(h), expected) << h;
            ASSERT_EQ(mesh.lengthMm(h),
                      glm::distance(surface.vertices[std::size_t(mesh.origin(h))],
                                    surface.vertices[std::size_t(mesh.target(h))]));
        }
    }
}

TEST(HalfedgeMesh, RefusesEdgesThatLieOnNoSurface) {
    const std::vector<glm::dvec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    const auto of = [&](const std::vector<glm::ivec3>& triangles) {
        return HalfedgeMesh::of(TriMesh{corners, triangles});
    };
    EXPECT_TRUE(of({{0, 1, 2}, {1, 0, 3}}));
    EXPECT_FALSE(of({{0, 1, 2}, {0, 1, 3}})) << "turned against each other";
    EXPECT_FALSE(of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}})) << "three at an edge";
    EXPECT_FALSE(of({{0, 1, 2}, {1, 0, 3}, {1, 0, 4}})) << "three at an edge";
    EXPECT_FALSE(of({{0, 1, 2}, {0, 1, 2}})) << "twice the same";
    EXPECT_FALSE(of({{0, 1, 2}, {0, 3, 4}})) << "two fans";
}

TEST(HalfedgeMesh, TakesAFanOfManyTriangles) {
    constexpr int blades = 400'000;  // their square is more than a test has time for
    TriMesh fan;
    fan.vertices.push_back({0.0, 0.0, 1.0});
    for (int n = 0; n < blades; ++n) {
        const double angle = 6.283185307179586 * n / blades;
        fan.vertices.push_back({std::cos(angle), std::sin(angle), 0.0});
        fan.triangles.push_back({0, 1 + n, 1 + (n + 1) % blades});
    }
    const auto mesh = HalfedgeMesh::of(fan);
    ASSERT_TRUE(mesh);
    for (int n = 0; n < blades; ++n) {
        EXPECT_EQ(mesh->opposite(3 * n + 2), 3 * ((n + 1) % blades));
        EXPECT_EQ(mesh->opposite(3 * n + 1), -1);
    }
}

}  // namespace
}  // namespace haustra::mesh
