// A closed surface cut open and laid out in the plane by a holomorphic form.
#pragma once

#include "flatten/general/carved_surface.h"

#include <cstddef>

namespace haustra::flatten {

struct FundamentalDomain {
    TriMesh cut;                   ///< one disc
    std::vector<int> vertexOfCut;  ///< per vertex of `cut`: the surface's, −1 where one was added
    std::vector<int> triangleOfCut;          ///< per triangle of `cut`: the surface's
    std::vector<std::complex<double>> flat;  ///< per vertex of `cut`: the form's integral
    std::size_t flips = 0;                   ///< triangles of no or negative flat area
};

/// Cuts along the carved lines and integrates the form over what is left (dissertation §4.2.2.3,
/// steps 1 to 3), from 0 at the first triangle's first corner. Fails (noResult) where that is not
/// one disc. O(n).
Result<FundamentalDomain> layOut(const CarvedSurface& surface);

/// Along the cut graph of the first vertex that a triangle uses; `form` is on the half-edges of
/// `mesh`, whose gluing is `halfedges` (a double cover's is not told by its corners alone). For a
/// genus of 2 or more the plane is covered several times over: around each zero of the form the
/// surface winds 2 or more times. Fails (badInput) where the surface is not closed and in one
/// piece, the form not of it, or the genus 0. O(n log n).
Result<FundamentalDomain> fundamentalDomainMap(const TriMesh& mesh,
                                               const mesh::HalfedgeMesh& halfedges,
                                               const ComplexForm& form);
/// Fails as HalfedgeMesh::ofClosed, too.
Result<FundamentalDomain> fundamentalDomainMap(const TriMesh& mesh, const ComplexForm& form);

struct FormZero {
    int vertex = 0;
    int order = 0;  ///< negative where the form's discretisation makes the real part an extremum
};

/// Vertices around which the form's real part changes its sign 2 + 2·order times, order ≠ 0, by
/// number. The orders of any form add up to 2g − 2 (Poincaré and Hopf; Gortler, Gotsman and
/// Thurston 2006). O(n).
std::vector<FormZero> formZeros(const mesh::HalfedgeMesh& mesh, const ComplexForm& form);

}  // namespace haustra::flatten
