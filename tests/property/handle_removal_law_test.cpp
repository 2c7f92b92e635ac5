// Laws of the loops that handles are cut along: against CGAL's exact search, and of the cover.
#include "data_folder.h"
#include "handle_meshes.h"
#include "handles/covering_space.h"
#include "handles/handle_removal.h"
#include "handles/loop_coarsening.h"
#include "handles/loop_homology.h"
#include "handles/loop_search.h"
#include "mesh/mesh_file.h"

#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include <CGAL/Curves_on_surface_topology.h>
#include <CGAL/Path_on_surface.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

namespace haustra::handles {
namespace {

using CgalMesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;

/// CGAL's shortest cycle that cannot be shrunk to a point, by the edges' lengths.
class CgalCycles {
public:
    explicit CgalCycles(const TriMesh& mesh) {
        std::vector<CgalMesh::Vertex_index> made(mesh.vertices.size());
        for (const glm::ivec3& t : mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner) {
                const glm::dvec3& p = mesh.vertices[t[corner]];
                if (!made[t[corner]].is_valid())
                    made[t[corner]] = mesh_.add_vertex({p.x, p.y, p.z});
            }
            mesh_.add_face(made[t.x], made[t.y], made[t.z]);
        }
        vertices_ = made;
        curves_ = std::make_unique<Curves>(mesh_);
    }

    double throughMm(int vertex) const {
        const Weight weight{&mesh_};
        return lengthOf(curves_->compute_shortest_non_contractible_cycle_with_base_point(
            mesh_.halfedge(vertices_[vertex]), weight));
    }
    double shortestMm() const {
        return lengthOf(curves_->compute_shortest_non_contractible_cycle(Weight{&mesh_}));
    }

private:
    using Curves = CGAL::Surface_mesh_topology::Curves_on_surface_topology<CgalMesh>;
    struct Weight {
        using Weight_t = double;
        const CgalMesh* mesh;
        double operator()(CgalMesh::Halfedge_index h) const {
            return std::sqrt(
                CGAL::squared_distance(mesh->point(mesh->source(h)), mesh->point(mesh->target(h))));
        }
    };
    double lengthOf(const CGAL::Surface_mesh_topology::Path_on_surface<CgalMesh>& path) const {
        double length = 0.0;
        for (std::size_t i = 0; i < path.length(); ++i)
            length += Weight{&mesh_}(path[i]);
        return length > 0.0 ? length : std::numeric_limits<double>::infinity();
    }

    CgalMesh mesh_;
    std::vector<CgalMesh::Vertex_index> vertices_;
    std::unique_ptr<Curves> curves_;
};

/// The mesh with each vertex pushed about, so that no two loops are equally long by construction.
TriMesh shaken(TriMesh mesh, double byMm) {
    std::uint32_t state = 1;
    for (glm::dvec3& p : mesh.vertices) {
        for (int axis = 0; axis < 3; ++axis) {
            state = state * 1664525u + 1013904223u;
            p[axis] += byMm * (double(state >> 8) / double(1 << 24) - 0.5);
        }
    }
    return mesh;
}

mesh::Loop loopOf(const TriMesh& mesh) {
    const mesh::HalfedgeMesh halves = mesh::HalfedgeMesh::ofClosed(mesh).value();
    return shortestLoop(halves, homologyMarks(halves), {}, {});
}

TEST(HandleRemovalLaw, TheLoopIsTheShortestOfAllThatCgalFinds) {
    tests::HandledSphere sphere(20.0, 10);
    sphere.addTube(0, 1, 3, 5, 2, 1.6, true);
    sphere.addTube(2, 1, 3, 5, 2, 1.7, false);
    for (const TriMesh& mesh :
         {shaken(tests::torusMesh(20.0, 8.0, 30, 15), 0.4),
          shaken(tests::torusMesh(20.0, 14.0, 26, 18), 0.4), shaken(sphere.mesh(), 0.1)}) {
        const double oursMm = loopOf(mesh).lengthMm;
        EXPECT_NEAR(oursMm, CgalCycles(mesh).shortestMm(), 1e-9 * oursMm);
        const auto removal = removeHandles(mesh);
        ASSERT_TRUE(removal);
        EXPECT_NEAR(removal->handles[0].lengthMm, oursMm, 1e-9 * oursMm);
    }
}

TEST(HandleRemovalLaw, NoCycleOfCgalsThroughTheColonIsShorter) {
    HAUSTRA_REAL_DATA(file, "meshes/colon00090_genus1_100k.ply");
    const TriMesh mesh = mesh::readMesh(file).value();
    const auto removal = removeHandles(mesh);
    ASSERT_TRUE(removal);
    const double oursMm = removal->handles[0].lengthMm;
    const CgalCycles cgal(mesh);
    const auto& loop = removal->handles[0].loopMm;
    for (std::size_t i = 0; i < loop.size(); i += 7) {
        const auto at = std::find(mesh.vertices.begin(), mesh.vertices.end(), loop[i]);
        // CGAL's front keeps no exact order, so that its cycles may be a little longer than need
        // be.
        const double cgalMm = cgal.throughMm(int(at - mesh.vertices.begin()));
        EXPECT_GE(cgalMm, oursMm * (1.0 - 1e-9));
        EXPECT_LE(cgalMm, oursMm * 1.02);
    }
    // Some vertices spread over the whole mesh.
    for (std::size_t v = 0; v < mesh.vertices.size(); v += mesh.vertices.size() / 5)
        EXPECT_GE(cgal.throughMm(int(v)), oursMm * (1.0 - 1e-9));
}

TEST(HandleRemovalLaw, ANeckBetweenHandlesIsNotCut) {
    // Two tori joined by a neck that is much thinner than either: cutting it would leave two
    // pieces.
    TriMesh mesh = tests::torusMesh(20.0, 6.0, 60, 30);
    const TriMesh other = mesh;
    const int count = int(mesh.vertices.size());
    for (const glm::dvec3& p : other.vertices)
        mesh.vertices.push_back({-p.x + 60.0, p.y, -p.z});  // half a turn about y: faces the first
    for (const glm::ivec3& t : other.triangles)
        mesh.triangles.push_back(t + count);
    // Each loses one triangle at its outermost point; three walls join the holes.
    const glm::ivec3 a = mesh.triangles[0], b = mesh.triangles[other.triangles.size()];
    std::erase_if(mesh.triangles, [&](const glm::ivec3& t) { return t == a || t == b; });
    int turn = 0;
    double best = std::numeric_limits<double>::infinity();
    const auto across = [&](int i, int k) { return b[(k + 3 - i) % 3]; };
    for (int k = 0; k < 3; ++k) {
        double length = 0.0;
        for (int i = 0; i < 3; ++i)
            length += glm::distance(mesh.vertices[a[i]], mesh.vertices[across(i, k)]);
        if (length < best) best = length, turn = k;
    }
    for (int i = 0; i < 3; ++i) {
        const int p = a[i], q = a[(i + 1) % 3], pp = across(i, turn), qq = across(i + 1, turn);
        mesh.triangles.push_back({p, q, qq});
        mesh.triangles.push_back({p, qq, pp});
    }
    ASSERT_TRUE(meshTopology(mesh).closed());
    ASSERT_EQ(meshTopology(mesh).genus(), 2);
    const double girthMm = 2.0 * 30 * 6.0 * std::sin(std::numbers::pi / 30);
    EXPECT_LT(CgalCycles(mesh).throughMm(a[0]), 0.5 * girthMm);  // the neck
    const auto removal = removeHandles(mesh);
    ASSERT_TRUE(removal) << describe(removal.error());
    ASSERT_EQ(removal->handles.size(), 2u);
    for (const RemovedHandle& handle : removal->handles)
        EXPECT_NEAR(handle.lengthMm, girthMm, 0.01 * girthMm);
    EXPECT_EQ(meshTopology(removal->mesh).components, 1);
    EXPECT_EQ(meshTopology(removal->mesh).eulerCharacteristic, 2);
}

TriMesh handled(int handles) {
    tests::HandledSphere sphere(30.0, 24);
    for (int i = 0; i < handles; ++i)
        sphere.addTube(i, 5, 8, 9, 3, 1.5, i % 2 == 0);
    return sphere.mesh();
}

TEST(HandleRemovalLaw, CoarseningKeepsTheTopologyAndThePlaces) {
    for (int handles = 0; handles <= 4; ++handles) {
        const TriMesh mesh = handled(handles);
        const CoarseMesh coarse = coarsen(mesh, 300);
        const MeshTopology topology = meshTopology(coarse.mesh);
        EXPECT_TRUE(topology.closed());
        EXPECT_TRUE(mesh::HalfedgeMesh::ofClosed(coarse.mesh));
        EXPECT_EQ(topology.genus(), handles);
        EXPECT_LE(coarse.mesh.vertices.size(), 300u);
        for (std::size_t v = 0; v < coarse.fineVertex.size(); ++v)
            EXPECT_EQ(coarse.mesh.vertices[v], mesh.vertices[std::size_t(coarse.fineVertex[v])]);
    }
}

TEST(HandleRemovalLaw, CoarseningEndsAtATetrahedronWhateverTheTrianglesOrder) {
    for (unsigned seed = 0; seed < 5; ++seed) {
        TriMesh mesh = handled(0);
        std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(seed));
        mesh.vertices.emplace_back(0.0);  // which no triangle uses
        const CoarseMesh coarse = coarsen(mesh, 1);
        EXPECT_EQ(coarse.mesh.vertices.size(), 4u);
        EXPECT_EQ(coarse.mesh.triangles.size(), 4u);
        EXPECT_TRUE(mesh::HalfedgeMesh::ofClosed(coarse.mesh));
    }
}

TEST(HandleRemovalLaw, TheCutGraphLeavesOneDiscWhoseSidesPair) {
    for (int handles = 1; handles <= 4; ++handles) {
        const mesh::HalfedgeMesh mesh =
            mesh::HalfedgeMesh::ofClosed(coarsen(handled(handles), 400).mesh).value();
        const mesh::CutGraph graph = mesh::makeCutGraph(mesh, 0);
        EXPECT_EQ(int(graph.basis.size()), 2 * handles);
        for (const mesh::Loop& loop : graph.basis) {
            for (std::size_t i = 0; i < loop.halfedges.size(); ++i) {
                EXPECT_EQ(mesh.target(loop.halfedges[i]),
                          mesh.origin(loop.halfedges[(i + 1) % loop.halfedges.size()]));
            }
            EXPECT_EQ(mesh.origin(loop.halfedges[0]), 0);
        }
        const FundamentalDomain domain = slice(mesh, graph);
        std::size_t onSides = 0, onGraph = 0;
        for (std::size_t s = 0; s < domain.sides.size(); ++s) {
            const auto &side = domain.sides[s],
                       &other = domain.sides[std::size_t(domain.partner[s])];
            ASSERT_EQ(side.size(), other.size());
            for (std::size_t i = 0; i < side.size(); ++i)
                EXPECT_EQ(mesh.opposite(side[i]), other[side.size() - 1 - i]);
            onSides += side.size();
        }
        for (const char cut : graph.cut)
            onGraph += std::size_t(cut);
        EXPECT_EQ(onSides, onGraph);  // one walk takes in the whole boundary: one disc
    }
}

TEST(HandleRemovalLaw, TheCoverIsSimplyConnectedAndItsRingsClose) {
    for (int handles = 1; handles <= 3; ++handles) {
        const mesh::HalfedgeMesh mesh =
            mesh::HalfedgeMesh::ofClosed(coarsen(handled(handles), 300).mesh).value();
        const FundamentalDomain domain = slice(mesh, mesh::makeCutGraph(mesh, 0));
        const int sides = int(domain.sides.size());
        CoveringSpace cover(mesh, domain);
        for (int copy = 0; copy < 60; ++copy) {
            for (int side = 0; side < sides; ++side)
                cover.across(copy, side);
        }
        // Lifted branch points and sides of the portion: a disc has V − E + F = 1.
        std::vector<int> parent(std::size_t(cover.copies() * sides));
        for (std::size_t i = 0; i < parent.size(); ++i)
            parent[i] = int(i);
        const auto root = [&](int v) {
            while (parent[v] != v)
                v = parent[v];
            return v;
        };
        long glued = 0;
        for (int copy = 0; copy < cover.copies(); ++copy) {
            for (int side = 0; side < sides; ++side) {
                const int other = cover.neighbour(copy, side);
                if (other < 0) continue;
                EXPECT_EQ(cover.neighbour(other, domain.partner[side]), copy);
                ++glued;
                parent[root(copy * sides + side)] = root(other * sides + domain.nextCorner(side));
            }
        }
        std::set<int> points;
        for (int i = 0; i < int(parent.size()); ++i)
            points.insert(root(i));
        const long edges = long(cover.copies()) * sides - glued / 2;
        EXPECT_EQ(long(points.size()) - edges + cover.copies(), 1);
        // Round a triangle, and so round anything that shrinks to a point, a walk ends where it
        // began.
        for (int t = 0; t < mesh.halfedgeCount() / 3; ++t) {
            int copy = 0;
            for (int corner = 0; corner < 3; ++corner)
                copy = cover.along(copy, 3 * t + corner);
            EXPECT_EQ(copy, 0);
        }
    }
}

TEST(HandleRemovalLaw, LoopsInTheCoverAgreeWithTheSearchOnTheMesh) {
    for (int handles = 1; handles <= 4; ++handles) {
        const mesh::HalfedgeMesh mesh =
            mesh::HalfedgeMesh::ofClosed(coarsen(shaken(handled(handles), 0.05), 500).mesh).value();
        const auto marks = homologyMarks(mesh);
        const auto loops = coveringLoops(mesh, marks, 1.2);
        ASSERT_FALSE(loops.empty());
        EXPECT_NEAR(loops[0].lengthMm, shortestLoop(mesh, marks, {}, {}).lengthMm, 1e-9);
        for (const mesh::Loop& loop : loops) {
            std::uint64_t sum = 0;
            for (const int h : loop.halfedges)
                sum ^= marks[h];
            EXPECT_NE(sum, 0u);
        }
    }
}

}  // namespace
}  // namespace haustra::handles
