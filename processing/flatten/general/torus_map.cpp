#include "flatten/general/torus_map.h"

#include "flatten/general/period_matrix.h"
#include "flatten/general/trajectory.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace haustra::flatten {
namespace {

/// Vertices to start from, the largest in the plane first, and then ever farther from the largest.
/// Far from its handle a surface shrinks exponentially there, below rounding where it is long.
std::vector<int> goodBases(const CarvedSurface& surface) {
    std::vector<double> area(surface.mesh().vertices.size(), 0.0);
    for (int h = 0; h < surface.halfedgeCount(); ++h) {
        const std::complex<double> back = surface.form(mesh::HalfedgeMesh::previous(h));
        area[std::size_t(surface.origin(h))] += std::imag(std::conj(surface.form(h)) * -back);
    }
    std::vector<int> order(area.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return area[std::size_t(a)] > area[std::size_t(b)]; });
    std::vector<int> bases;
    for (std::size_t rank = 0; rank < order.size(); rank = 2 * rank + 1) {
        if (area[std::size_t(order[rank])] > 0.0) bases.push_back(order[rank]);
    }
    return bases;
}

Result<CarvedSurface> carveTrajectories(CarvedSurface surface, int base, std::complex<double> tau) {
    for (const std::complex<double> direction : {std::complex<double>(1.0), tau}) {
        TRY(traceTrajectory(surface, base, direction));
    }
    return surface;
}

}  // namespace

PeriodRatio periodRatio(const HolomorphicBasis& basis) {
    const PeriodMatrix periods = periodMatrix(basis);
    // Lagrange and Gauss's reduction; (first, second) stay a basis of the lattice, turned left.
    std::complex<double> first = 1.0, second = periods.values[0][0];
    for (;;) {
        second -= std::round((second / first).real()) * first;
        // Periods that differ by rounding alone are not exchanged for ever.
        if (std::norm(second) >= (1.0 - 1e-12) * std::norm(first)) break;
        const std::complex<double> turned = -first;
        first = second;
        second = turned;
    }
    PeriodRatio ratio{second / first, basis.holomorphic(periods.forms[0])};
    for (std::complex<double>& value : ratio.form)
        value /= first;
    return ratio;
}

Result<TorusMap> torusMap(const TriMesh& torus, int base, const HolomorphicOptions& options) {
    auto halfedges = TRY(mesh::HalfedgeMesh::ofClosed(torus));
    if (base < -1 || base >= halfedges.vertexCount() || (base >= 0 && halfedges.outgoing(base) < 0))
        return fail(ErrorKind::badInput, "no triangle uses the vertex to cut the torus at");
    auto basis = TRY(holomorphicBasis(halfedges, options));
    if (basis.genus() != 1)
        return fail(ErrorKind::badInput, "the surface is not of genus one, but of genus " +
                                             std::to_string(basis.genus()));
    PeriodRatio ratio = periodRatio(basis);
    const CarvedSurface whole(torus, halfedges, std::move(ratio.form));
    const std::vector<int> bases = base >= 0 ? std::vector<int>{base} : goodBases(whole);
    Result<FundamentalDomain> domain =
        fail(ErrorKind::noResult, "no triangle of the torus keeps its orientation in the plane");
    for (const int from : bases) {
        const Result<CarvedSurface> carved = carveTrajectories(whole, from, ratio.tau);
        domain = carved ? layOut(*carved) : tl::make_unexpected(carved.error());
        base = from;
        if (domain) break;
    }
    if (!domain) return tl::make_unexpected(domain.error());

    // `base` has four copies, at the corners: the one of the least sum of lattice coordinates is 0.
    const auto along = [&](std::complex<double> z) {
        const double across = z.imag() / ratio.tau.imag();
        return across + z.real() - across * ratio.tau.real();
    };
    std::complex<double> corner;
    bool found = false;
    for (std::size_t v = 0; v < domain->flat.size(); ++v) {
        if (domain->vertexOfCut[v] != base) continue;
        if (!found || along(domain->flat[v]) < along(corner)) corner = domain->flat[v];
        found = true;
    }
    for (std::complex<double>& z : domain->flat)
        z -= corner;
    return TorusMap{ratio.tau, std::move(*domain), basis.certificate};
}

}  // namespace haustra::flatten
