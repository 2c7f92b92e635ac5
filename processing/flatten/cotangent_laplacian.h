// The Dirichlet energy of piecewise linear functions as a sparse matrix.
#pragma once

#include "flatten/intrinsic_delaunay.h"

#include <vector>

namespace haustra::flatten {

/// The lower triangle of a symmetric matrix by columns, rows ascending, the diagonal first.
struct SymmetricMatrix {
    int size = 0;
    std::vector<int> columnStart;  ///< size + 1
    std::vector<int> row;
    std::vector<double> value;
};

/// L with xᵀLx = Σ over edges of ½(cot α + cot β)(x_i − x_j)², whatever the cotangents' sign, over
/// the vertices with unknownOf ≥ 0; the others are held at 0. `unknownOf` numbers 0 … size − 1.
SymmetricMatrix cotangentLaplacian(const IntrinsicMesh& mesh, const std::vector<int>& unknownOf,
                                   int size);

/// −Lx at the unknowns for an x (per vertex, 0 at the unknowns) that the ends are held at.
std::vector<double> pullOfFixed(const IntrinsicMesh& mesh, const std::vector<int>& unknownOf,
                                int size, const std::vector<double>& fixed);

/// The right-hand side of the harmonic form in the class of `mesh.turns`.
std::vector<double> pullOfTurns(const IntrinsicMesh& mesh, const std::vector<int>& unknownOf,
                                int size);

/// Σ over edges of ½(cot α + cot β)(x_j − x_i + turns)², turns taken as 0 unless `around`.
double dirichletEnergy(const IntrinsicMesh& mesh, const std::vector<double>& x, bool around);

}  // namespace haustra::flatten
