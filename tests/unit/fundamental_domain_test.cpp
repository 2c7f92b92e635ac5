#include "flatten/general/fundamental_domain.h"

#include "flatten/general/period_matrix.h"
#include "handle_meshes.h"
#include "torus_meshes.h"

#include <numbers>

#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

using Complex = std::complex<double>;

TriMesh handledSphere(int genus) {
    tests::HandledSphere sphere(40.0, 24);
    for (int k = 0; k < genus; ++k)
        sphere.addTube(k, 3, 5 + k, 12, 4, 5.0, k % 2 == 0);
    return sphere.mesh();
}

class DomainOfGenus : public testing::TestWithParam<int> {};

TEST_P(DomainOfGenus, IntegralOverTheDomainGivesTheFormBack) {
    const TriMesh surface = handledSphere(GetParam());
    const HolomorphicBasis basis = *holomorphicBasis(surface);
    const ComplexForm form = basis.holomorphic(periodMatrix(basis).forms[0]);
    const Result<FundamentalDomain> domain = fundamentalDomainMap(surface, form);
    ASSERT_TRUE(domain) << domain.error().message;
    const MeshTopology topology = meshTopology(domain->cut);
    EXPECT_EQ(topology.eulerCharacteristic, 1);
    EXPECT_EQ(topology.components, 1);
    ASSERT_EQ(domain->cut.triangles.size(), surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        EXPECT_EQ(domain->triangleOfCut[t], int(t));
        for (int c = 0; c < 3; ++c) {
            const int v = domain->cut.triangles[t][c], w = domain->cut.triangles[t][(c + 1) % 3];
            EXPECT_EQ(domain->vertexOfCut[std::size_t(v)], surface.triangles[t][c]);
            EXPECT_NEAR(std::abs(domain->flat[std::size_t(w)] - domain->flat[std::size_t(v)] -
                                 form[3 * t + std::size_t(c)]),
                        0.0, 1e-10);
        }
    }
}

TEST_P(DomainOfGenus, ZerosOfEveryFormAddUpToTheEulerCharacteristic) {
    const TriMesh surface = handledSphere(GetParam());
    const mesh::HalfedgeMesh halfedges = *mesh::HalfedgeMesh::ofClosed(surface);
    const HolomorphicBasis basis = *holomorphicBasis(surface);
    const PeriodMatrix periods = periodMatrix(basis);
    for (const std::vector<Complex>& coefficients : periods.forms) {
        int sum = 0;
        for (const FormZero& zero : formZeros(halfedges, basis.holomorphic(coefficients)))
            sum += zero.order;
        EXPECT_EQ(sum, 2 * GetParam() - 2);
    }
    // A form that is harmonic on Delaunay triangles has no extremum, so that none is negative; here
    // the triangles are the surface's own.
    ComplexForm arbitrary = basis.holomorphic(std::size_t(0));
    for (int h = 0; h < halfedges.halfedgeCount(); ++h) {
        const auto bump = [&](int v) { return std::sin(0.7 * v); };
        arbitrary[std::size_t(h)] += bump(halfedges.target(h)) - bump(halfedges.origin(h));
    }
    int sum = 0, negative = 0;
    for (const FormZero& zero : formZeros(halfedges, arbitrary)) {
        sum += zero.order;
        negative += zero.order < 0;
    }
    EXPECT_EQ(sum, 2 * GetParam() - 2);
    EXPECT_GT(negative, 0);
}

TEST_P(DomainOfGenus, FlatAngleAroundEachVertexIsWholeTurns) {
    // A zero of order m is a vertex that the flat surface winds around m + 1 times; each flipped
    // triangle takes one turn away from the sum.
    const TriMesh surface = handledSphere(GetParam());
    const HolomorphicBasis basis = *holomorphicBasis(surface);
    const ComplexForm form = basis.holomorphic(periodMatrix(basis).forms[0]);
    const FundamentalDomain domain = *fundamentalDomainMap(surface, form);
    constexpr double unused = -1e9;
    std::vector<double> angle(surface.vertices.size(), unused);
    for (const glm::ivec3& t : surface.triangles)
        angle[std::size_t(t.x)] = angle[std::size_t(t.y)] = angle[std::size_t(t.z)] = 0.0;
    int turnedOver = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        double sum = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double corner = std::arg(-form[3 * t + (c + 2) % 3] / form[3 * t + c]);
            angle[std::size_t(surface.triangles[t][int(c)])] += corner;
            sum += corner;
        }
        turnedOver += sum < 0.0;
    }
    int order = 0;
    for (std::size_t v = 0; v < angle.size(); ++v) {
        if (angle[v] == unused) continue;
        const double turns = angle[v] / (2.0 * std::numbers::pi);
        EXPECT_NEAR(turns, std::round(turns), 1e-9);
        order += int(std::lround(turns)) - 1;
    }
    EXPECT_EQ(order + turnedOver, 2 * GetParam() - 2);
    // Slivers where the tubes are joined, and triangles that hold a zero, may be turned over.
    EXPECT_LE(int(domain.flips), 8);
}

INSTANTIATE_TEST_SUITE_P(Genera, DomainOfGenus, testing::Values(1, 2, 3));

TEST(FundamentalDomain, RefusesAFormOfAnotherSurface) {
    EXPECT_EQ(fundamentalDomainMap(handledSphere(1), ComplexForm(6)).error().kind,
              ErrorKind::badInput);
    EXPECT_EQ(fundamentalDomainMap(TriMesh{}, {}).error().kind, ErrorKind::badInput);
    const TriMesh sphere = handledSphere(0);
    EXPECT_EQ(fundamentalDomainMap(sphere, ComplexForm(sphere.triangles.size() * 3)).error().kind,
              ErrorKind::badInput);
}

}  // namespace
}  // namespace haustra::flatten
