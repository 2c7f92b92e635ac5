#include "flatten/general/double_cover.h"

#include "data_folder.h"
#include "flatten/general/double_cover_map.h"
#include "flatten/general/fundamental_domain.h"
#include "flatten/tube/conformal_tube.h"
#include "handles/handle_removal.h"
#include "mesh/mesh_file.h"
#include "tube_meshes.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

double haustra(double s) {
    return 20.0 + 4.0 * std::sin(40.0 * s) + 3.0 * std::cos(11.0 * s);
}

/// Bent, with folds that do not go all around.
TriMesh colonLike(int around, int along) {
    return tests::tubeMesh(around, along, [](double a, double s) {
        const double angle = 2.0 * std::numbers::pi * a, bend = 2.5 * s;
        const double r =
            18.0 + 5.0 * std::sin(60.0 * s) * std::cos(angle + 4.0 * s) + std::cos(3.0 * angle);
        const glm::dvec3 across(std::cos(bend), 0.0, std::sin(bend));
        return 120.0 * across +
               r * (std::cos(angle) * across + std::sin(angle) * glm::dvec3(0.0, -1.0, 0.0));
    });
}

/// Takes away the triangles within `steps` edges of a vertex.
void punch(TriMesh& mesh, int vertex, int steps) {
    std::vector<char> near(mesh.vertices.size(), 0);
    near[std::size_t(vertex)] = 1;
    for (int step = 1; step < steps; ++step) {
        std::vector<char> grown = near;
        for (const glm::ivec3& t : mesh.triangles) {
            if (!near[std::size_t(t.x)] && !near[std::size_t(t.y)] && !near[std::size_t(t.z)])
                continue;
            grown[std::size_t(t.x)] = grown[std::size_t(t.y)] = grown[std::size_t(t.z)] = 1;
        }
        near = std::move(grown);
    }
    std::erase_if(mesh.triangles, [&](const glm::ivec3& t) {
        return near[std::size_t(t.x)] || near[std::size_t(t.y)] || near[std::size_t(t.z)];
    });
}

TEST(DoubleCover, OfATubeIsATorusOfTwoCopies) {
    const TriMesh tube = tests::revolvedMesh(12, 20, 100.0, haustra);
    const DoubleCover cover = *doubleCover(tube);
    const MeshTopology topology = meshTopology(cover.mesh);
    EXPECT_TRUE(topology.closed());
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.genus(), 1);
    const std::size_t count = tube.triangles.size();
    ASSERT_EQ(cover.mesh.triangles.size(), 2 * count);
    EXPECT_EQ(cover.mesh.vertices.size(), 2 * tube.vertices.size() - 24);
    for (std::size_t t = 0; t < count; ++t) {
        const glm::ivec3 first = cover.mesh.triangles[t], second = cover.mesh.triangles[t + count];
        EXPECT_EQ(first, tube.triangles[t]);
        const auto of = [&](int v) { return cover.vertexOfCopy[std::size_t(v)]; };
        EXPECT_EQ(glm::ivec3(of(second.y), of(second.x), of(second.z)), first);
    }
    for (std::size_t v = 0; v < cover.mesh.vertices.size(); ++v) {
        EXPECT_EQ(cover.mesh.vertices[v], tube.vertices[std::size_t(cover.vertexOfCopy[v])]);
    }
}

TEST(DoubleCover, GluesMirroredHalfedges) {
    const TriMesh tube = tests::revolvedMesh(12, 20, 100.0, haustra);
    const DoubleCover cover = *doubleCover(tube);
    const mesh::HalfedgeMesh& mesh = cover.halfedges;
    const int count = int(tube.triangles.size()) * 3;
    const auto of = [&](int v) { return cover.vertexOfCopy[std::size_t(v)]; };
    for (int h = 0; h < count; ++h) {
        const int twin = mirrored(h, count);
        EXPECT_EQ(of(mesh.origin(twin)), of(mesh.target(h)));
        EXPECT_EQ(of(mesh.target(twin)), of(mesh.origin(h)));
        EXPECT_EQ(mesh.opposite(twin),
                  mesh.opposite(h) == twin ? h : mirrored(mesh.opposite(h), count));
    }
}

TEST(DoubleCover, OfADiscWithHolesHasTheirNumberAsGenus) {
    TriMesh tube = tests::revolvedMesh(24, 40, 100.0, haustra);
    punch(tube, 24 * 10 + 3, 2);
    punch(tube, 24 * 25 + 9, 2);
    EXPECT_EQ(meshTopology(doubleCover(tube)->mesh).genus(), 3);
    TriMesh closed = doubleCover(tube)->mesh;
    EXPECT_EQ(doubleCover(closed).error().kind, ErrorKind::badInput);
}

/// The general algorithm and the reduced one, up to a rotation.
void expectAgreement(const TriMesh& tube, bool intrinsicDelaunay) {
    ConformalTubeOptions reduced;
    reduced.intrinsicDelaunay = intrinsicDelaunay;
    reduced.repairFlips = false;
    HolomorphicOptions general;
    general.intrinsicDelaunay = intrinsicDelaunay;
    const Result<ConformalTube> one = conformalTube(tube, -1, reduced);
    ASSERT_TRUE(one) << one.error().message;
    const Result<DoubleCoverMap> two = tubeMapFromDoubleCover(tube, -1, general);
    ASSERT_TRUE(two) << two.error().message;
    EXPECT_NEAR(two->modulus / one->modulus, 1.0, 1e-8);
    EXPECT_NEAR(two->certificate, one->certificate, 1e-8);
    const double shift = two->map.corner(tube, 0, 0).x - one->map.corner(tube, 0, 0).x;
    double worst = 0.0, unturned = 0.0;
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        for (int c = 0; c < 3; ++c) {
            const glm::dvec2 a = one->map.corner(tube, t, c), b = two->map.corner(tube, t, c);
            const double turns = b.x - a.x - shift;
            worst = std::max(
                {worst, std::abs(turns - std::round(turns)), std::abs(b.y - a.y) / one->modulus});
            const glm::dvec2 side =
                (b - two->map.corner(tube, t, 0)) - (a - one->map.corner(tube, t, 0));
            unturned = std::max(unturned, std::abs(side.x));
        }
    }
    EXPECT_LT(worst, 1e-8);
    EXPECT_LT(unturned, 1e-8);
}

TEST(DoubleCoverMap, AgreesWithTheReducedPathOnAHaustratedTube) {
    for (const bool delaunay : {false, true})
        expectAgreement(colonLike(60, 300), delaunay);
}

/// Ears: triangles with two sides on the boundary, whose third side both copies have between the
/// same two vertices.
TriMesh earedTube() {
    TriMesh tube = tests::revolvedMesh(24, 30, 60.0, haustra);
    // Every third square of the first row.
    std::erase_if(tube.triangles, [](const glm::ivec3& t) { return t.x < 24 && t.x % 3 == 1; });
    return tube;
}

TEST(DoubleCoverMap, AgreesWhereEdgesCrossFromRimToRim) {
    expectAgreement(earedTube(), true);
    expectAgreement(earedTube(), false);
}

TEST(DoubleCoverMap, FundamentalDomainOfACoverWithDoubledEdges) {
    const DoubleCover cover = *doubleCover(earedTube());
    EXPECT_FALSE(mesh::HalfedgeMesh::ofClosed(cover.mesh));
    const HolomorphicBasis basis = *holomorphicBasis(cover.halfedges);
    const auto domain =
        fundamentalDomainMap(cover.mesh, cover.halfedges, basis.holomorphic(std::size_t(0)));
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_EQ(domain->cut.triangles.size(), cover.mesh.triangles.size());
}

TEST(DoubleCoverMap, AgreesOnAModelledTube) {
    HAUSTRA_REAL_DATA(file, "meshes/tube_open.stl");
    expectAgreement(*mesh::readMesh(file), true);
}

TEST(DoubleCoverMap, AgreesOnARealColon) {
    HAUSTRA_REAL_DATA(file, "meshes/colon00090_genus1_100k.ply");
    TriMesh colon = handles::removeHandles(*mesh::readMesh(file))->mesh;
    // Lowest and highest vertex stand in for the colon's ends.
    const auto [low, high] =
        std::minmax_element(colon.vertices.begin(), colon.vertices.end(),
                            [](const glm::dvec3& a, const glm::dvec3& b) { return a.z < b.z; });
    const int ends[] = {int(low - colon.vertices.begin()), int(high - colon.vertices.begin())};
    for (const int end : ends)
        punch(colon, end, 4);
    expectAgreement(colon, true);
}

}  // namespace
}  // namespace haustra::flatten
