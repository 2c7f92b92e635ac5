// The general algorithm (dissertation §4.2.2): holomorphic 1-forms of a surface of any genus.
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "core/tri_mesh.h"
#include "mesh/halfedge_mesh.h"

#include <complex>
#include <vector>

namespace haustra::flatten {

/// Values on half-edges; the opposite half-edge has the negative value.
using OneForm = std::vector<double>;
using ComplexForm = std::vector<std::complex<double>>;

/// Two copies of an open surface glued along its whole boundary (§4.2.2.1). Triangle t of the
/// second copy is triangle t + n, turned over. Boundary vertices are shared.
struct DoubleCover {
    TriMesh mesh;
    std::vector<int> vertexOfCopy;  ///< per vertex of `mesh`: the surface's
};
/// Fails (badInput) where the mesh is closed or not manifold.
Result<DoubleCover> doubleCover(const TriMesh& open);

struct HolomorphicBasis {
    /// 2g loops that generate the first homology, as half-edges.
    std::vector<mesh::Loop> homology;
    /// Harmonic forms dual to them: the integral of form k over loop i is δ_ik
    /// (equations 4.1, 4.2).
    std::vector<OneForm> harmonic;
    /// form k + i·(its conjugate, equation 4.3), for each harmonic form; they span the g complex
    /// dimensions twice over.
    std::vector<ComplexForm> holomorphic;
};

struct HolomorphicOptions {
    int threads = 0;
    Progress progress;
};

/// Of a closed connected manifold mesh of genus ≥ 1. The Laplacian is factored once for all forms.
/// The conjugate of a harmonic form is the combination of harmonic forms that best agrees with its
/// rotation about the normal (equation 4.3), so that it is closed and harmonic itself. Fails
/// (badInput) on genus 0 or a mesh that is not closed and manifold. O(g · solve).
Result<HolomorphicBasis> holomorphicBasis(const TriMesh& mesh,
                                          const HolomorphicOptions& options = {});

/// A closed genus-one surface over the plane: its universal cover modulo the lattice of 1 and τ.
struct TorusMap {
    std::complex<double> tau;  ///< the period ratio, Im τ > 0, in the fundamental region
    std::vector<std::complex<double>> flat;  ///< per vertex of `cut`, in periods of the first loop
    TriMesh cut;                             ///< cut along its horizontal and vertical trajectories
    std::vector<int> vertexOfCut;    ///< per vertex of `cut`: of the mesh, −1 where a trajectory
                                     ///< crosses an edge
    std::vector<int> triangleOfCut;  ///< per triangle of `cut`: of the mesh
};
/// §4.2.2.3: integrates a holomorphic form over a fundamental domain, traces the horizontal and the
/// vertical trajectory through `base`, and cuts along them: the image is a parallelogram, a
/// rectangle where τ is imaginary.
Result<TorusMap> torusMap(const TriMesh& torus, int base = 0,
                          const HolomorphicOptions& options = {});

}  // namespace haustra::flatten
