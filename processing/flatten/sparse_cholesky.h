// Factorisation of a sparse symmetric matrix, once for all right-hand sides.
#pragma once

#include "core/result.h"
#include "flatten/cotangent_laplacian.h"

#include <memory>
#include <vector>

namespace haustra::flatten {

/// P·A·Pᵀ = L·Lᵀ with P chosen to keep L sparse (approximate minimum degree) and its dense parts
/// worked on as such (CHOLMOD). Vectors are in the order of A's unknowns throughout. One thread;
/// several factors may be made and used at once.
class SparseCholesky {
public:
    /// Where `groupEnds` is not empty, all unknowns below groupEnds[0] are eliminated before all
    /// from there to groupEnds[1], and so on; those from the last end on come last. Fails
    /// (noResult) where the matrix is not positive definite, or memory runs out.
    static Result<SparseCholesky> of(const SymmetricMatrix& matrix,
                                     const std::vector<int>& groupEnds = {});
    SparseCholesky(SparseCholesky&&) noexcept;
    SparseCholesky& operator=(SparseCholesky&&) noexcept;
    ~SparseCholesky();

    std::vector<double> solve(std::vector<double> right);
    /// x becomes L⁻¹x, and L⁻ᵀx.
    void forward(std::vector<double>& x);
    void backward(std::vector<double>& x);
    /// The rows and columns of L from unknown `first` on, which must begin a group: dense, columns
    /// one after the other, zero above the diagonal of the elimination's order.
    std::vector<double> trailing(int first) const;

private:
    struct State;
    explicit SparseCholesky(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// The failure where a system has no unique solution.
tl::unexpected<Error> singularSystem();

}  // namespace haustra::flatten
