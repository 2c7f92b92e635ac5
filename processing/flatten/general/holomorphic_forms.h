// The general algorithm (dissertation §4.2.2.2): holomorphic 1-forms of a closed surface of any
// genus. Double covers are in double_cover.h, maps in torus_map.h and fundamental_domain.h.
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "core/tri_mesh.h"
#include "mesh/halfedge_mesh.h"

#include <complex>
#include <span>
#include <vector>

namespace haustra::flatten {

/// Values on half-edges; the opposite half-edge has the negative value.
using OneForm = std::vector<double>;
using ComplexForm = std::vector<std::complex<double>>;

struct HolomorphicBasis {
    /// 2g loops that generate the first homology.
    std::vector<mesh::Loop> homology;
    /// Harmonic forms dual to them: the integral of form k over loop i is δ_ik (equations 4.1,
    /// 4.2).
    std::vector<OneForm> harmonic;
    /// ∫ form i ∧ form j: integers, skew, of determinant 1.
    std::vector<std::vector<int>> wedge;
    /// The conjugate of harmonic form k (equation 4.3) is Σ_j star[k][j]·harmonic[j]: closed and
    /// harmonic itself, and its own conjugate is −form k (see hodge_star.h).
    std::vector<std::vector<double>> star;
    /// ≥ 0, and falls with the edges' length squared: how far the nearest harmonic form is from the
    /// rotated one, at worst. For a tube's double cover it is E(u)·E(v) − 1 of conformalTube.
    double certificate = 0.0;
    int flippedEdges = 0;  ///< by the intrinsic Delaunay triangulation

    int genus() const { return int(harmonic.size() / 2); }
    /// Σ_k coefficients[k]·(harmonic[k] + i·conjugate of harmonic[k]), 2g coefficients. Where it is
    /// not zero, its integral keeps angles and orientation.
    ComplexForm holomorphic(std::span<const std::complex<double>> coefficients) const;
    /// harmonic[k] + i·its conjugate. The 2g of them span the g complex dimensions twice over.
    ComplexForm holomorphic(std::size_t k) const;
};

struct HolomorphicOptions {
    /// Flips edges until no cotangent weight is negative, in the intrinsic metric (Fisher et al.
    /// 2007). The surface's triangles stay as they are.
    bool intrinsicDelaunay = true;
    /// Per half-edge, both of a pair: edges that are not flipped. Empty: none.
    std::vector<char> kept;
    Progress progress;
};

/// Of a closed surface in one piece of genus ≥ 1. Minimises Σ ½(cot α + cot β)·ω² (cotangents never
/// clamped) over the closed forms with each loop's period 1: an integer form of that class, and the
/// gradient that makes it harmonic, from one factorisation of the Laplacian for all 2g forms. Fails
/// (badInput) on genus 0 or where the surface is not closed, manifold and in one piece, (noResult)
/// where a triangle without area leaves the system singular. O(g · solve + g²·n); about 70 bytes
/// · g a triangle. One thread.
Result<HolomorphicBasis> holomorphicBasis(const mesh::HalfedgeMesh& mesh,
                                          const HolomorphicOptions& options = {});
Result<HolomorphicBasis> holomorphicBasis(const TriMesh& mesh,
                                          const HolomorphicOptions& options = {});

}  // namespace haustra::flatten
