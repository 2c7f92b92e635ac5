#include "flatten/general/torus_map.h"

#include "data_folder.h"
#include "flatten/distortion.h"
#include "handle_meshes.h"
#include "mesh/mesh_file.h"
#include "torus_meshes.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

using Complex = std::complex<double>;

/// At the two sizes after the first, the error's quotient.
std::vector<double> quotients(const std::function<double(int)>& errorAt) {
    const double coarse = errorAt(1), middle = errorAt(2), fine = errorAt(4);
    EXPECT_LT(fine, 0.02);
    return {coarse / middle, middle / fine};
}

double wave(double azimuth) {
    return 1.2 + 0.3 * std::cos(3.0 * azimuth);
}

TEST(TorusMap, TorusOfRevolutionHasItsPeriodRatioToSecondOrder) {
    for (const double minor : {10.0, 25.0}) {
        const double exact = minor / std::sqrt(30.0 * 30.0 - minor * minor);
        const auto error = [&](int fine) {
            const TriMesh torus = tests::torusMesh(30.0, minor, 24 * fine, 16 * fine);
            const Complex tau = periodRatio(*holomorphicBasis(torus)).tau;
            EXPECT_NEAR(tau.real(), 0.0, 1e-3);
            return std::abs(tau - std::max(exact, 1.0 / exact) * Complex(0.0, 1.0));
        };
        for (const double quotient : quotients(error)) {
            EXPECT_GT(quotient, 3.6);
            EXPECT_LT(quotient, 4.4);
        }
    }
}

TEST(TorusMap, HopfTorusHasItsObliquePeriodRatioToSecondOrder) {
    const auto error = [](int fine) {
        const tests::KnownTorus torus = tests::hopfTorus(20 * fine, 32 * fine, wave);
        const Complex exact = tests::reducedRatio(torus.tau);
        EXPECT_GT(std::abs(exact.real()), 0.1);
        const Complex tau = periodRatio(*holomorphicBasis(torus.mesh)).tau;
        return std::abs(tau - exact);
    };
    for (const double quotient : quotients(error)) {
        EXPECT_GT(quotient, 3.5);
        EXPECT_LT(quotient, 4.6);
    }
}

/// Glues the parallelogram's sides and compares with the torus: each cut triangle's source covers
/// the same area in space, and all vertices over one place of the torus are a lattice step apart.
void expectParallelogramOf(const TriMesh& torus, const TorusMap& map, std::size_t mostFlips = 0) {
    const FundamentalDomain& domain = map.domain;
    const MeshTopology topology = meshTopology(domain.cut);
    EXPECT_EQ(topology.eulerCharacteristic, 1);
    EXPECT_EQ(topology.nonManifoldEdges, 0);
    EXPECT_LE(domain.flips, mostFlips);
    EXPECT_GE(std::abs(map.tau), 1.0 - 1e-12);
    EXPECT_LE(std::abs(map.tau.real()), 0.5 + 1e-12);
    EXPECT_GT(map.tau.imag(), 0.0);

    const auto lattice = [&](Complex z) {
        const double up = z.imag() / map.tau.imag();
        return glm::dvec2(z.real() - up * map.tau.real(), up);
    };
    // On the rim all vertices are on the parallelogram's sides, and no vertex is outside.
    std::map<std::array<double, 3>, std::vector<std::size_t>> places;
    for (std::size_t v = 0; v < domain.flat.size(); ++v) {
        const glm::dvec2 at = lattice(domain.flat[v]);
        EXPECT_GT(std::min({at.x, at.y, 1.0 - at.x, 1.0 - at.y}), -1e-9);
        const glm::dvec3& p = domain.cut.vertices[v];
        places[{p.x, p.y, p.z}].push_back(v);
    }
    const Complex corners[] = {0.0, 1.0, map.tau, 1.0 + map.tau};
    std::size_t atCorners = 0;
    for (const auto& [place, copies] : places) {
        for (const std::size_t v : copies) {
            const glm::dvec2 step = lattice(domain.flat[v]) - lattice(domain.flat[copies.front()]);
            EXPECT_NEAR(glm::distance(step, glm::round(step)), 0.0, 1e-10);
            EXPECT_TRUE(v == copies.front() || glm::length(step) > 0.5);
        }
        if (copies.size() == 1) continue;
        EXPECT_TRUE(copies.size() == 2 || copies.size() == 4);
        for (const std::size_t v : copies) {
            for (const Complex corner : corners)
                atCorners += std::abs(domain.flat[v] - corner) < 1e-10;
            const glm::dvec2 at = lattice(domain.flat[v]);
            EXPECT_LT(std::min({std::abs(at.x), std::abs(at.y), std::abs(1.0 - at.x),
                                std::abs(1.0 - at.y)}),
                      1e-9);
        }
    }
    EXPECT_EQ(atCorners, 4u);

    // Glued by place, the torus is whole again: its vertices, and each triangle's area.
    EXPECT_EQ(domain.cut.triangles.size() - torus.triangles.size(),
              2 * (places.size() - torus.vertices.size()));
    std::vector<double> area(torus.triangles.size(), 0.0);
    const auto areaOf = [](const TriMesh& mesh, std::size_t t) {
        const glm::ivec3& c = mesh.triangles[t];
        return 0.5 * glm::length(glm::cross(
                         mesh.vertices[std::size_t(c.y)] - mesh.vertices[std::size_t(c.x)],
                         mesh.vertices[std::size_t(c.z)] - mesh.vertices[std::size_t(c.x)]));
    };
    double flatArea = 0.0;
    for (std::size_t t = 0; t < domain.cut.triangles.size(); ++t) {
        area[std::size_t(domain.triangleOfCut[t])] += areaOf(domain.cut, t);
        const glm::ivec3& c = domain.cut.triangles[t];
        const Complex a = domain.flat[std::size_t(c.x)];
        flatArea += 0.5 * std::imag(std::conj(domain.flat[std::size_t(c.y)] - a) *
                                    (domain.flat[std::size_t(c.z)] - a));
    }
    for (std::size_t t = 0; t < torus.triangles.size(); ++t)
        EXPECT_NEAR(area[t], areaOf(torus, t), 1e-10 * (1.0 + areaOf(torus, t)));
    EXPECT_NEAR(flatArea, map.tau.imag(), 1e-9);
    std::set<int> sources(domain.vertexOfCut.begin(), domain.vertexOfCut.end());
    sources.erase(-1);
    EXPECT_EQ(sources.size(), torus.vertices.size());
    for (std::size_t v = 0; v < domain.vertexOfCut.size(); ++v) {
        const int source = domain.vertexOfCut[v];
        EXPECT_TRUE(source < 0 || domain.cut.vertices[v] == torus.vertices[std::size_t(source)]);
    }
}

TEST(TorusMap, ParallelogramGluesBackToTheTorus) {
    const tests::KnownTorus torus = tests::hopfTorus(40, 70, wave);
    for (const int base : {-1, 0, 1234}) {
        const Result<TorusMap> map = torusMap(torus.mesh, base);
        ASSERT_TRUE(map) << map.error().message;
        expectParallelogramOf(torus.mesh, *map);
    }
}

TEST(TorusMap, TorusOfRevolutionBecomesARectangleThroughItsVertices) {
    // The trajectories run along the mesh's own lines, and through its vertices.
    const TriMesh torus = tests::torusMesh(30.0, 10.0, 48, 24);
    const Result<TorusMap> map = torusMap(torus, 5);
    ASSERT_TRUE(map) << map.error().message;
    expectParallelogramOf(torus, *map);
}

TEST(TorusMap, BumpyTorusGluesBackAndKeepsAngles) {
    TriMesh torus = tests::torusMesh(30.0, 12.0, 160, 80);
    for (glm::dvec3& p : torus.vertices) {
        p += 1.5 * glm::dvec3(std::sin(0.25 * p.y + 0.1 * p.z), std::sin(0.2 * p.z + 0.15 * p.x),
                              std::sin(0.22 * p.x + 0.12 * p.y));
    }
    const Result<TorusMap> map = torusMap(torus, 17);
    ASSERT_TRUE(map) << map.error().message;
    EXPECT_GT(std::abs(map->tau.real()), 1e-4);
    expectParallelogramOf(torus, *map);
    const FundamentalDomain& domain = map->domain;
    const Distortion distortion = measureDistortion(domain.cut, [&](std::size_t t, int c) {
        const Complex z = domain.flat[std::size_t(domain.cut.triangles[t][c])];
        return glm::dvec2(z.real(), z.imag());
    });
    EXPECT_LT(distortion.angleErrorDegrees.mean, 1.0);
}

TEST(TorusMap, RealColonWithAHandleGluesBack) {
    HAUSTRA_REAL_DATA(file, "meshes/colon00090_genus1_100k.ply");
    const TriMesh colon = *mesh::readMesh(file);
    const Result<TorusMap> map = torusMap(colon);
    ASSERT_TRUE(map) << map.error().message;
    expectParallelogramOf(colon, *map, 100000);
}

TEST(TorusMap, RefusesWhatIsNoTorus) {
    tests::HandledSphere sphere(40.0, 16);
    EXPECT_EQ(torusMap(sphere.mesh()).error().kind, ErrorKind::badInput);
    sphere.addTube(0, 2, 2, 8, 2, 3.0, true);
    sphere.addTube(1, 2, 2, 8, 2, 3.0, true);
    EXPECT_EQ(torusMap(sphere.mesh()).error().kind, ErrorKind::badInput);
    EXPECT_EQ(torusMap(tests::torusMesh(30.0, 10.0, 12, 12), 144).error().kind,
              ErrorKind::badInput);
}

}  // namespace
}  // namespace haustra::flatten
