#include "flatten/sparse_cholesky.h"

#include <algorithm>
#include <utility>

#include <suitesparse/cholmod.h>

namespace haustra::flatten {

struct SparseCholesky::State {
    cholmod_common common{};
    cholmod_factor* factor = nullptr;
    int leading = 0;

    State() {
        cholmod_start(&common);
        common.print = 0;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.final_ll = 1;
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }

    /// A copy of b, solved in place of the parts of the system that `stages` name.
    std::vector<double> solve(const std::vector<double>& b) {
        std::vector<double> x(b.size());
        const std::size_t n = factor->n;
        const int* order = static_cast<const int*>(factor->Perm);
        std::vector<double> y(n, 0.0);
        for (std::size_t k = 0; k < n; ++k) {
            if (std::size_t(order[k]) < b.size()) y[k] = b[std::size_t(order[k])];
        }
        substitute(CHOLMOD_L, y);
        // What lies beyond the leading block is held at 0 where that alone is asked for.
        for (std::size_t k = 0; k < n; ++k) {
            if (std::size_t(order[k]) >= b.size()) y[k] = 0.0;
        }
        substitute(CHOLMOD_Lt, y);
        for (std::size_t k = 0; k < n; ++k) {
            if (std::size_t(order[k]) < b.size()) x[std::size_t(order[k])] = y[k];
        }
        return x;
    }

    void substitute(int system, std::vector<double>& y) {
        cholmod_dense right{};
        right.nrow = right.nzmax = right.d = y.size();
        right.ncol = 1;
        right.x = y.data();
        right.xtype = CHOLMOD_REAL;
        right.dtype = CHOLMOD_DOUBLE;
        cholmod_dense* found = cholmod_solve(system, factor, &right, &common);
        if (found) std::copy_n(static_cast<const double*>(found->x), y.size(), y.begin());
        cholmod_free_dense(&found, &common);
    }
};

SparseCholesky::SparseCholesky(std::unique_ptr<State> state) : state_(std::move(state)) {}
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;
SparseCholesky::~SparseCholesky() = default;

Result<SparseCholesky> SparseCholesky::of(const SymmetricMatrix& matrix, int leading) {
    auto state = std::make_unique<State>();
    state->leading = leading;
    cholmod_sparse view{};
    view.nrow = view.ncol = std::size_t(matrix.size);
    view.nzmax = matrix.row.size();
    // CHOLMOD takes its input as const and its views as not.
    view.p = const_cast<int*>(matrix.columnStart.data());
    view.i = const_cast<int*>(matrix.row.data());
    view.x = const_cast<double*>(matrix.value.data());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;

    const auto size = std::size_t(matrix.size);
    std::vector<int> group(size, 0), order(size);
    std::fill(group.begin() + leading, group.end(), 1);
    cholmod_common* common = &state->common;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_GIVEN;
    if (cholmod_camd(&view, nullptr, 0, group.data(), order.data(), common))
        state->factor = cholmod_analyze_p(&view, order.data(), nullptr, 0, common);
    if (state->factor) cholmod_factorize(&view, state->factor, common);
    if (common->status == CHOLMOD_OUT_OF_MEMORY)
        return fail(ErrorKind::noResult, "there is not enough memory to flatten the surface");
    if (!state->factor || common->status != CHOLMOD_OK || state->factor->minor < size) {
        return fail(ErrorKind::noResult,
                    "the surface cannot be flattened: a triangle without area leaves its "
                    "equations singular");
    }
    return SparseCholesky(std::move(state));
}

std::vector<double> SparseCholesky::solve(const std::vector<double>& right) {
    return state_->solve(right);
}

std::vector<double> SparseCholesky::solveLeading(const std::vector<double>& right) {
    return state_->solve(right);
}

}  // namespace haustra::flatten
