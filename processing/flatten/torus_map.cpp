#include "flatten/torus_map.h"

#include "flatten/period_matrix.h"
#include "flatten/trajectory.h"

#include <algorithm>
#include <cmath>

namespace haustra::flatten {
namespace {

/// Away from a handle a surface shrinks exponentially, below rounding where it is long.
int largestInThePlane(const TriMesh& mesh, const ComplexForm& form) {
    std::vector<double> area(mesh.vertices.size(), 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const double twice = std::imag(std::conj(form[3 * t]) * -form[3 * t + 2]);
        for (int corner = 0; corner < 3; ++corner)
            area[std::size_t(mesh.triangles[t][corner])] += twice;
    }
    return int(std::max_element(area.begin(), area.end()) - area.begin());
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
    Result<mesh::HalfedgeMesh> halfedges = mesh::HalfedgeMesh::ofClosed(torus);
    if (!halfedges) return tl::make_unexpected(halfedges.error());
    if (base < -1 || base >= halfedges->vertexCount() ||
        (base >= 0 && halfedges->outgoing(base) < 0))
        return fail(ErrorKind::badInput, "no triangle uses the vertex to cut the torus at");
    Result<HolomorphicBasis> basis = holomorphicBasis(*halfedges, options);
    if (!basis) return tl::make_unexpected(basis.error());
    if (basis->genus() != 1)
        return fail(ErrorKind::badInput, "the surface is not of genus one, but of genus " +
                                             std::to_string(basis->genus()));
    PeriodRatio ratio = periodRatio(*basis);
    if (base < 0) base = largestInThePlane(torus, ratio.form);
    CarvedSurface surface(torus, *halfedges, std::move(ratio.form));
    for (const std::complex<double> direction : {std::complex<double>(1.0), ratio.tau}) {
        const Result<std::vector<int>> line = traceTrajectory(surface, base, direction);
        if (!line) return tl::make_unexpected(line.error());
    }
    Result<FundamentalDomain> domain = layOut(surface);
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
    return TorusMap{ratio.tau, std::move(*domain), basis->certificate};
}

}  // namespace haustra::flatten
