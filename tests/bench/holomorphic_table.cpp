// Prints how good the holomorphic forms are: holomorphic_table [MESH…]
// Without meshes: surfaces whose period ratio is known. Of each closed mesh: its forms' laws; of
// each tube: the general algorithm beside the reduced one.
#include "core/tri_mesh.h"
#include "flatten/general/double_cover_map.h"
#include "flatten/general/fundamental_domain.h"
#include "flatten/general/period_matrix.h"
#include "flatten/general/torus_map.h"
#include "flatten/tube/conformal_tube.h"
#include "handle_meshes.h"
#include "mesh/mesh_file.h"
#include "stopwatch.h"
#include "torus_meshes.h"

#include <algorithm>
#include <cstdio>

namespace haustra {
namespace {

using flatten::ComplexForm;
using Complex = std::complex<double>;

using bench::milliseconds;

void printKnown() {
    std::printf("surface | triangles | tau | error | certificate\n");
    for (int fine = 1; fine <= 16; fine *= 2) {
        const double minor = 25.0, exact = minor / std::sqrt(30.0 * 30.0 - minor * minor);
        const auto report = [&](const char* name, const TriMesh& mesh, Complex expected) {
            const flatten::HolomorphicBasis basis = *flatten::holomorphicBasis(mesh);
            const Complex tau = flatten::periodRatio(basis).tau;
            std::printf("%s | %zu | %.6f %+.6fi | %.2e | %.2e\n", name, mesh.triangles.size(),
                        tau.real(), tau.imag(), std::abs(tau - expected), basis.certificate);
        };
        report("revolution", tests::torusMesh(30.0, minor, 24 * fine, 16 * fine),
               {0.0, std::max(exact, 1.0 / exact)});
        const tests::KnownTorus hopf = tests::hopfTorus(20 * fine, 32 * fine, [](double azimuth) {
            return 1.2 + 0.3 * std::cos(3.0 * azimuth);
        });
        report("Hopf", hopf.mesh, tests::reducedRatio(hopf.tau));
    }
}

void printClosed(const TriMesh& mesh) {
    const double start = milliseconds();
    const auto halfedges = mesh::HalfedgeMesh::ofClosed(mesh);
    if (!halfedges) return void(std::printf("%s\n", halfedges.error().message.c_str()));
    const auto basis = flatten::holomorphicBasis(*halfedges);
    if (!basis) return void(std::printf("%s\n", basis.error().message.c_str()));
    const flatten::PeriodMatrix periods = flatten::periodMatrix(*basis);
    const double seconds = 1e-3 * (milliseconds() - start);
    double dual = 0.0, skew = 0.0;
    for (std::size_t k = 0; k < basis->harmonic.size(); ++k) {
        for (std::size_t i = 0; i < basis->homology.size(); ++i) {
            double sum = i == k ? -1.0 : 0.0;
            for (const int h : basis->homology[i].halfedges)
                sum += basis->harmonic[k][std::size_t(h)];
            dual = std::max(dual, std::abs(sum));
        }
    }
    for (std::size_t i = 0; i < periods.values.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            skew = std::max(skew, std::abs(periods.values[i][j] - periods.values[j][i]));
    }
    std::printf("triangles %zu, genus %d, %d edges flipped, certificate %.2e, %.2f s\n",
                mesh.triangles.size(), basis->genus(), basis->flippedEdges, basis->certificate,
                seconds);
    std::printf("dual periods to %.1e, period matrix symmetric to %.1e\n", dual, skew);
    for (const std::vector<Complex>& row : periods.values) {
        for (const Complex value : row)
            std::printf(" %9.5f%+.5fi", value.real(), value.imag());
        std::printf("\n");
    }
    if (basis->genus() == 1) {
        const auto map = flatten::torusMap(mesh);
        if (!map) return void(std::printf("%s\n", map.error().message.c_str()));
        std::printf("tau %.6f%+.6fi, %zu flips, %zu vertices added along the trajectories\n",
                    map->tau.real(), map->tau.imag(), map->domain.flips,
                    std::size_t(std::count(map->domain.vertexOfCut.begin(),
                                           map->domain.vertexOfCut.end(), -1)));
        return;
    }
    for (const std::vector<Complex>& coefficients : periods.forms) {
        const ComplexForm form = basis->holomorphic(coefficients);
        const auto domain = flatten::fundamentalDomainMap(mesh, *halfedges, form);
        if (!domain) return void(std::printf("%s\n", domain.error().message.c_str()));
        std::printf("form: %zu flips, zeros", domain->flips);
        for (const flatten::FormZero& zero : flatten::formZeros(*halfedges, form))
            std::printf(" %d (order %d)", zero.vertex, zero.order);
        std::printf("\n");
    }
}

void printTube(const TriMesh& tube) {
    flatten::ConformalTubeOptions reduced;
    reduced.repairFlips = false;
    reduced.threads = 1;
    double start = milliseconds();
    const auto one = flatten::conformalTube(tube, -1, reduced);
    const double reducedSeconds = 1e-3 * (milliseconds() - start);
    start = milliseconds();
    const auto two = flatten::tubeMapFromDoubleCover(tube);
    const double generalSeconds = 1e-3 * (milliseconds() - start);
    if (!one || !two)
        return void(std::printf("%s\n", (one ? two.error() : one.error()).message.c_str()));
    const auto step = [&](std::size_t t, int c) {
        return two->map.corner(tube, t, c) - one->map.corner(tube, t, c);
    };
    const double shift = step(0, 0).x;
    double worst = 0.0;
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        for (int c = 0; c < 3; ++c) {
            const double turns = step(t, c).x - shift;
            worst = std::max({worst, std::abs(turns - std::round(turns)),
                              std::abs(step(t, c).y) / one->modulus});
        }
    }
    std::printf(
        "triangles %zu, modulus %.10f, differs by %.1e, maps by %.1e; reduced %.2f s, general "
        "%.2f s\n",
        tube.triangles.size(), one->modulus, std::abs(two->modulus / one->modulus - 1.0), worst,
        reducedSeconds, generalSeconds);
}

}  // namespace
}  // namespace haustra

int main(int argc, char** argv) {
    using namespace haustra;
    if (argc == 1) printKnown();
    for (int n = 1; n < argc; ++n) {
        const auto mesh = mesh::readMesh(argv[n]);
        if (!mesh) {
            std::printf("%s\n", describe(mesh.error()).c_str());
            return 1;
        }
        std::printf("\n%s\n", argv[n]);
        if (meshTopology(*mesh).boundaryEdges > 0) {
            printTube(*mesh);
        } else {
            printClosed(*mesh);
        }
    }
}
