#include "flatten/general/holomorphic_forms.h"

#include "flatten/general/fundamental_domain.h"
#include "flatten/general/homology_basis.h"
#include "flatten/general/period_matrix.h"
#include "handle_meshes.h"
#include "torus_meshes.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

/// A sphere with bridges and tunnels; each adds one to the genus.
TriMesh handledSphere(int genus, int side = 16) {
    tests::HandledSphere sphere(40.0, side);
    const int apart = side / 2, width = 2, at = side / 8;
    for (int k = 0; k < genus; ++k)
        sphere.addTube(k, at, at + k, apart, width, 3.0, k % 2 == 0);
    return sphere.mesh();
}

std::complex<double> along(const mesh::Loop& loop, const ComplexForm& form) {
    std::complex<double> sum;
    for (const int h : loop.halfedges)
        sum += form[std::size_t(h)];
    return sum;
}

/// ½ cot of the angle across from h, from the corners' places.
double halfCotangent(const TriMesh& mesh, int h) {
    const glm::ivec3& t = mesh.triangles[std::size_t(h / 3)];
    const glm::dvec3 apex = mesh.vertices[std::size_t(t[(h + 2) % 3])];
    const glm::dvec3 a = mesh.vertices[std::size_t(t[h % 3])] - apex,
                     b = mesh.vertices[std::size_t(t[(h + 1) % 3])] - apex;
    return 0.5 * glm::dot(a, b) / glm::length(glm::cross(a, b));
}

class OfGenus : public testing::TestWithParam<int> {};

TEST_P(OfGenus, LoopsAreClosedWalksAndIntegerFormsAreTheirDuals) {
    const HalfedgeMesh mesh = *HalfedgeMesh::ofClosed(handledSphere(GetParam()));
    const HomologyBasis basis = *homologyBasis(mesh);
    ASSERT_EQ(basis.loops.size(), std::size_t(2 * GetParam()));
    for (std::size_t i = 0; i < basis.loops.size(); ++i) {
        const std::vector<int>& loop = basis.loops[i].halfedges;
        for (std::size_t n = 0; n < loop.size(); ++n)
            ASSERT_EQ(mesh.target(loop[n]), mesh.origin(loop[(n + 1) % loop.size()]));
        for (std::size_t k = 0; k < basis.dual.size(); ++k) {
            int sum = 0;
            for (const int h : loop)
                sum += basis.dual[k][std::size_t(h)];
            EXPECT_EQ(sum, i == k);
        }
    }
    for (const std::vector<std::int8_t>& form : basis.dual) {
        for (int h = 0; h < mesh.halfedgeCount(); ++h) {
            ASSERT_EQ(form[std::size_t(h)], -form[std::size_t(mesh.opposite(h))]);
            if (h % 3 == 0) {
                ASSERT_EQ(
                    form[std::size_t(h)] + form[std::size_t(h + 1)] + form[std::size_t(h + 2)], 0);
            }
        }
    }
}

TEST_P(OfGenus, HarmonicFormsAreDualClosedAndCoclosed) {
    const TriMesh surface = handledSphere(GetParam());
    HolomorphicOptions options;
    // On the surface's own triangles the residual can be told without the code under test.
    options.intrinsicDelaunay = false;
    const HolomorphicBasis basis = *holomorphicBasis(surface, options);
    ASSERT_EQ(basis.genus(), GetParam());
    for (std::size_t k = 0; k < basis.harmonic.size(); ++k) {
        const OneForm& form = basis.harmonic[k];
        for (std::size_t i = 0; i < basis.homology.size(); ++i) {
            double sum = 0.0;
            for (const int h : basis.homology[i].halfedges)
                sum += form[std::size_t(h)];
            EXPECT_NEAR(sum, i == k ? 1.0 : 0.0, 1e-12);
        }
        std::vector<double> out(surface.vertices.size(), 0.0), size(surface.vertices.size(), 1e-30);
        for (int h = 0; h < int(form.size()); ++h) {
            const glm::ivec3& t = surface.triangles[std::size_t(h / 3)];
            const double flow = halfCotangent(surface, h) * form[std::size_t(h)];
            out[std::size_t(t[h % 3])] += flow;
            out[std::size_t(t[(h + 1) % 3])] -= flow;
            size[std::size_t(t[h % 3])] += std::abs(flow);
            if (h % 3 == 0) {
                ASSERT_NEAR(
                    form[std::size_t(h)] + form[std::size_t(h + 1)] + form[std::size_t(h + 2)], 0.0,
                    1e-13);
            }
        }
        const double largest = *std::max_element(size.begin(), size.end());
        for (const double flow : out)
            ASSERT_NEAR(flow, 0.0, 1e-12 * largest);
    }
}

TEST_P(OfGenus, ConjugateIsARotationOfTheHarmonicForms) {
    const HolomorphicBasis basis = *holomorphicBasis(handledSphere(GetParam()));
    const std::size_t count = basis.star.size();
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
            double twice = 0.0;
            for (std::size_t k = 0; k < count; ++k)
                twice += basis.star[i][k] * basis.star[k][j];
            EXPECT_NEAR(twice, i == j ? -1.0 : 0.0, 1e-11);
        }
    }
    EXPECT_GE(basis.certificate, 0.0);
    EXPECT_LT(basis.certificate, 0.1);
}

TEST_P(OfGenus, PeriodMatrixIsSymmetricWithPositiveDefiniteImaginaryPart) {
    const HolomorphicBasis basis = *holomorphicBasis(handledSphere(GetParam()));
    const PeriodMatrix periods = periodMatrix(basis);
    const int genus = GetParam();
    std::vector<ComplexForm> measured = periods.values;
    for (int j = 0; j < genus; ++j) {
        // Integrated along the loops themselves, not taken from the algebra.
        const ComplexForm form = basis.holomorphic(periods.forms[std::size_t(j)]);
        for (int i = 0; i < 2 * genus; ++i) {
            std::complex<double> sum;
            for (std::size_t k = 0; k < basis.homology.size(); ++k)
                sum += double(periods.loops[std::size_t(i)][k]) * along(basis.homology[k], form);
            if (i < genus) {
                EXPECT_NEAR(std::abs(sum - (i == j ? 1.0 : 0.0)), 0.0, 1e-10);
            } else {
                measured[std::size_t(i - genus)][std::size_t(j)] = sum;
                EXPECT_NEAR(std::abs(sum - periods.values[std::size_t(i - genus)][std::size_t(j)]),
                            0.0, 1e-10);
            }
        }
    }
    Eigen::MatrixXd imaginary(genus, genus);
    for (int i = 0; i < genus; ++i) {
        for (int j = 0; j < genus; ++j) {
            const std::complex<double> value = measured[std::size_t(i)][std::size_t(j)];
            EXPECT_NEAR(std::abs(value - measured[std::size_t(j)][std::size_t(i)]), 0.0, 1e-10);
            imaginary(i, j) = value.imag();
        }
    }
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(imaginary).eigenvalues().minCoeff(),
              1e-3);
}

INSTANTIATE_TEST_SUITE_P(Genera, OfGenus, testing::Values(1, 2, 3, 5));

TEST(HolomorphicForms, FlatTorusHasItsOwnPeriodRatio) {
    for (const std::complex<double> tau :
         {std::complex<double>(0.0, 1.0), {0.3, 1.2}, {-0.45, 0.95}, {2.7, 0.4}, {0.4, 6.0}}) {
        for (const bool delaunay : {false, true}) {
            HolomorphicOptions options;
            options.intrinsicDelaunay = delaunay;
            const HolomorphicBasis basis = *holomorphicBasis(tests::flatTorus(tau, 7, 9), options);
            const PeriodMatrix periods = periodMatrix(basis);
            const std::complex<double> found = tests::reducedRatio(periods.values[0][0]);
            EXPECT_NEAR(std::abs(found - tests::reducedRatio(tau)), 0.0, 1e-11) << tau;
            EXPECT_LT(basis.certificate, 1e-11);
        }
    }
}

TEST(HolomorphicForms, TranslationSurfaceHasItsOwnForm) {
    // dz is linear on each triangle and harmonic, whatever the triangles.
    for (const std::complex<double> up : {std::complex<double>(0.0, 1.0), {1.7, 0.6}}) {
        const tests::TranslationSurface surface = tests::glueL(1.0, up, 6);
        const Result<HolomorphicBasis> basis = holomorphicBasis(surface.halfedges);
        ASSERT_TRUE(basis) << basis.error().message;
        ASSERT_EQ(basis->genus(), 2);
        EXPECT_TRUE(up.real() == 0.0 || basis->flippedEdges > 100);
        std::vector<std::complex<double>> periods;
        for (const mesh::Loop& loop : basis->homology)
            periods.push_back(along(loop, surface.form).real());
        const ComplexForm found = basis->holomorphic(periods);
        for (std::size_t h = 0; h < found.size(); ++h)
            ASSERT_NEAR(std::abs(found[h] - surface.form[h]), 0.0, 1e-12);
        const std::vector<FormZero> zeros = formZeros(surface.halfedges, found);
        ASSERT_EQ(zeros.size(), 1u);
        EXPECT_EQ(zeros[0].order, 2);
    }
}

TEST(HolomorphicForms, IntrinsicDelaunayGivesTheSameClassesAndLessEnergy) {
    // A coarse and oblique grid: many angles are obtuse.
    const TriMesh torus = tests::hopfTorus(60, 20, [](double azimuth) {
                              return 1.2 + 0.3 * std::cos(2.0 * azimuth);
                          }).mesh;
    HolomorphicOptions plain;
    plain.intrinsicDelaunay = false;
    const HolomorphicBasis coarse = *holomorphicBasis(torus, plain),
                           basis = *holomorphicBasis(torus);
    EXPECT_EQ(coarse.flippedEdges, 0);
    EXPECT_GT(basis.flippedEdges, 100);
    EXPECT_LT(basis.certificate, coarse.certificate);
    for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t i = 0; i < 2; ++i) {
            double sum = 0.0;
            for (const int h : basis.homology[i].halfedges)
                sum += basis.harmonic[k][std::size_t(h)];
            EXPECT_NEAR(sum, i == k ? 1.0 : 0.0, 1e-12);
        }
    }
}

TEST(HolomorphicForms, RefusesWhatHasNone) {
    tests::HandledSphere sphere(40.0, 4);
    EXPECT_EQ(holomorphicBasis(sphere.mesh()).error().kind, ErrorKind::badInput);
    TriMesh open = tests::torusMesh(30.0, 10.0, 12, 12);
    open.triangles.pop_back();
    EXPECT_EQ(holomorphicBasis(open).error().kind, ErrorKind::badInput);
    TriMesh two = tests::torusMesh(30.0, 10.0, 12, 12);
    const TriMesh other = two;
    for (const glm::ivec3& t : other.triangles)
        two.triangles.push_back(t + int(other.vertices.size()));
    two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
    EXPECT_EQ(holomorphicBasis(two).error().kind, ErrorKind::badInput);
    EXPECT_EQ(holomorphicBasis(TriMesh{}).error().kind, ErrorKind::badInput);
}

}  // namespace
}  // namespace haustra::flatten
