// Factorisation of the Laplacian, once for all right-hand sides.
#pragma once

#include "core/result.h"
#include "flatten/cotangent_laplacian.h"

#include <memory>
#include <vector>

namespace haustra::flatten {

/// L·Lᵀ of a symmetric positive definite matrix, ordered such that its leading block's factor is
/// a part of it: both systems are solved by one factorisation.
class SparseCholesky {
public:
    /// The leading block is the first `leading` unknowns. Fails (noResult) where the matrix is not
    /// positive definite, or memory runs out. One thread.
    static Result<SparseCholesky> of(const SymmetricMatrix& matrix, int leading);
    SparseCholesky(SparseCholesky&&) noexcept;
    SparseCholesky& operator=(SparseCholesky&&) noexcept;
    ~SparseCholesky();

    std::vector<double> solve(const std::vector<double>& right);
    /// Of the leading block alone: `right` and the result have `leading` values.
    std::vector<double> solveLeading(const std::vector<double>& right);

private:
    struct State;
    explicit SparseCholesky(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace haustra::flatten
