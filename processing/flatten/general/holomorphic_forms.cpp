#include "flatten/general/holomorphic_forms.h"

#include "flatten/cotangent_laplacian.h"
#include "flatten/general/hodge_star.h"
#include "flatten/general/homology_basis.h"
#include "flatten/intrinsic_delaunay.h"
#include "flatten/sparse_cholesky.h"

#include <cstdint>
#include <utility>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;
using IntegerForm = std::vector<std::int8_t>;

/// The unknowns are the vertices that triangles use, but the first of them, which is held at 0.
std::vector<int> numberUnknowns(const HalfedgeMesh& mesh, int& size) {
    std::vector<int> unknownOf(std::size_t(mesh.vertexCount()), -1);
    int used = 0;
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        if (mesh.outgoing(v) >= 0) unknownOf[std::size_t(v)] = used++ - 1;
    }
    size = used - 1;
    return unknownOf;
}

/// ½ cot of the angle across from each half-edge.
std::vector<double> halfWeights(const IntrinsicMesh& mesh) {
    std::vector<double> weight(std::size_t(mesh.halfedgeCount()));
    for (int h = 0; h < mesh.halfedgeCount(); ++h)
        weight[std::size_t(h)] = 0.5 * cotangent(mesh, h);
    return weight;
}

class HarmonicSolver {
public:
    static Result<HarmonicSolver> of(const HalfedgeMesh& surface, const IntrinsicMesh& mesh) {
        int size = 0;
        std::vector<int> unknownOf = numberUnknowns(surface, size);
        auto factor = TRY(SparseCholesky::of(cotangentLaplacian(mesh, unknownOf, size)));
        return HarmonicSolver(mesh, std::move(unknownOf), size, std::move(factor));
    }

    const std::vector<double>& weight() const { return weight_; }

    /// f with form + df harmonic, per vertex; `form` is on the intrinsic mesh's half-edges.
    std::vector<double> potential(const IntegerForm& form) {
        std::vector<double> right(std::size_t(size_), 0.0);
        for (int h = 0; h < mesh_.halfedgeCount(); ++h) {
            if (form[std::size_t(h)] == 0) continue;
            const double pull = weight_[std::size_t(h)] * form[std::size_t(h)];
            const int from = unknown(mesh_.origin[std::size_t(h)]), to = unknown(mesh_.target(h));
            if (from >= 0) right[std::size_t(from)] += pull;
            if (to >= 0) right[std::size_t(to)] -= pull;
        }
        const std::vector<double> solved = factor_.solve(right);
        std::vector<double> f(unknownOf_.size(), 0.0);
        for (std::size_t v = 0; v < f.size(); ++v) {
            if (unknownOf_[v] >= 0) f[v] = solved[std::size_t(unknownOf_[v])];
        }
        return f;
    }

private:
    HarmonicSolver(const IntrinsicMesh& mesh, std::vector<int> unknownOf, int size,
                   SparseCholesky factor)
        : mesh_(mesh),
          weight_(halfWeights(mesh)),
          unknownOf_(std::move(unknownOf)),
          size_(size),
          factor_(std::move(factor)) {}

    int unknown(int vertex) const { return unknownOf_[std::size_t(vertex)]; }

    const IntrinsicMesh& mesh_;
    std::vector<double> weight_;
    std::vector<int> unknownOf_;
    int size_;
    SparseCholesky factor_;
};

/// ∫ ω_i ∧ *ω_j = Σ ½(cot α + cot β)·ω_i·ω_j over edges, of the forms integer[k] + d potential[k].
Matrix scalarProducts(const IntrinsicMesh& mesh, const std::vector<double>& weight,
                      const std::vector<IntegerForm>& integer,
                      const std::vector<std::vector<double>>& potential) {
    const std::size_t count = integer.size(), halfedges = weight.size();
    const auto value = [&](std::size_t k, std::size_t h) {
        return integer[k][h] + potential[k][std::size_t(mesh.target(int(h)))] -
               potential[k][std::size_t(mesh.origin[h])];
    };
    Matrix product(count, std::vector<double>(count));
    std::vector<double> weighted(halfedges);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t h = 0; h < halfedges; ++h)
            weighted[h] = weight[h] * value(i, h);
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = 0.0;
            for (std::size_t h = 0; h < halfedges; ++h)
                sum += weighted[h] * value(j, h);
            product[i][j] = product[j][i] = sum;
        }
    }
    return product;
}

}  // namespace

ComplexForm HolomorphicBasis::holomorphic(
    std::span<const std::complex<double>> coefficients) const {
    // Σ_k c_k (ω_k + i Σ_j star_kj ω_j), gathered by harmonic form.
    std::vector<std::complex<double>> gathered(harmonic.size());
    for (std::size_t k = 0; k < harmonic.size(); ++k) {
        gathered[k] += coefficients[k];
        for (std::size_t j = 0; j < harmonic.size(); ++j)
            gathered[j] += std::complex<double>(0.0, star[k][j]) * coefficients[k];
    }
    ComplexForm form(harmonic.empty() ? 0 : harmonic.front().size());
    for (std::size_t k = 0; k < harmonic.size(); ++k) {
        for (std::size_t h = 0; h < form.size(); ++h)
            form[h] += gathered[k] * harmonic[k][h];
    }
    return form;
}

ComplexForm HolomorphicBasis::holomorphic(std::size_t k) const {
    std::vector<std::complex<double>> coefficients(harmonic.size());
    coefficients[k] = 1.0;
    return holomorphic(coefficients);
}

Result<HolomorphicBasis> holomorphicBasis(const HalfedgeMesh& mesh,
                                          const HolomorphicOptions& options) {
    auto homology = TRY(homologyBasis(mesh));
    const std::size_t count = homology.loops.size();
    if (count == 0) {
        return fail(ErrorKind::badInput,
                    "the surface is of genus 0 and closed: it has no holomorphic forms");
    }
    IntrinsicMesh intrinsic =
        intrinsicMesh(mesh, std::vector<std::int8_t>(std::size_t(mesh.halfedgeCount()), 0));
    intrinsic.kept = options.kept;
    std::vector<EdgeFlip> flips;
    if (options.intrinsicDelaunay) makeDelaunay(intrinsic, &flips);

    auto solver = TRY(HarmonicSolver::of(mesh, intrinsic));
    HolomorphicBasis basis;
    basis.flippedEdges = int(flips.size());
    std::vector<std::vector<double>> potential;
    std::vector<IntegerForm> carried;
    for (std::size_t k = 0; k < count; ++k) {
        const IntegerForm& dual = homology.dual[k];
        carried.push_back(dual);
        carryThroughFlips(flips, carried.back());
        potential.push_back(solver.potential(carried.back()));
        OneForm& form = basis.harmonic.emplace_back(dual.size());
        for (int h = 0; h < mesh.halfedgeCount(); ++h) {
            form[std::size_t(h)] = dual[std::size_t(h)] +
                                   potential[k][std::size_t(mesh.target(h))] -
                                   potential[k][std::size_t(mesh.origin(h))];
        }
        if (options.progress) options.progress(double(k + 1) / double(count));
    }
    Matrix wedge(count);
    for (std::size_t i = 0; i < count; ++i)
        wedge[i].assign(homology.wedge[i].begin(), homology.wedge[i].end());
    HodgeStar star =
        hodgeStar(scalarProducts(intrinsic, solver.weight(), carried, potential), wedge);
    basis.star = std::move(star.star);
    basis.certificate = star.certificate;
    basis.homology = std::move(homology.loops);
    basis.wedge = std::move(homology.wedge);
    return basis;
}

Result<HolomorphicBasis> holomorphicBasis(const TriMesh& mesh, const HolomorphicOptions& options) {
    auto halfedges = TRY(HalfedgeMesh::ofClosed(mesh));
    return holomorphicBasis(halfedges, options);
}

}  // namespace haustra::flatten
