#include "flatten/sparse_cholesky.h"

#include "flatten/blas_threads.h"

#include <new>
#include <utility>

#include <suitesparse/cholmod.h>

namespace haustra::flatten {

struct SparseCholesky::State {
    cholmod_common common{};
    cholmod_factor* factor = nullptr;
    cholmod_dense *found = nullptr, *work[2] = {nullptr, nullptr};
    std::vector<double> permuted;

    State() {
        cholmod_start(&common);
        common.print = 0;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.nmethods = 1;
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        cholmod_free_dense(&found, &common);
        cholmod_free_dense(&work[0], &common);
        cholmod_free_dense(&work[1], &common);
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }

    const int* order() const { return static_cast<const int*>(factor->Perm); }

    void substitute(int system, std::vector<double>& x) {
        const SequentialOpenMp sequential;
        const std::size_t n = x.size();
        permuted.resize(n);
        for (std::size_t k = 0; k < n; ++k)
            permuted[k] = x[std::size_t(order()[k])];
        cholmod_dense right{};
        right.nrow = right.nzmax = right.d = n;
        right.ncol = 1;
        right.x = permuted.data();
        right.xtype = CHOLMOD_REAL;
        right.dtype = CHOLMOD_DOUBLE;
        if (!cholmod_solve2(system, factor, &right, nullptr, &found, nullptr, &work[0], &work[1],
                            &common))
            throw std::bad_alloc();  // its only failure with sound arguments
        const double* values = static_cast<const double*>(found->x);
        for (std::size_t k = 0; k < n; ++k)
            x[std::size_t(order()[k])] = values[k];
    }
};

SparseCholesky::SparseCholesky(std::unique_ptr<State> state) : state_(std::move(state)) {}
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;
SparseCholesky::~SparseCholesky() = default;

Result<SparseCholesky> SparseCholesky::of(const SymmetricMatrix& matrix,
                                          const std::vector<int>& groupEnds) {
    const SequentialOpenMp sequential;
    auto state = std::make_unique<State>();
    const auto size = std::size_t(matrix.size);
    cholmod_sparse view{};
    view.nrow = view.ncol = size;
    view.nzmax = matrix.row.size();
    // CHOLMOD leaves its input as it is, but has no type for a view of constants.
    view.p = const_cast<int*>(matrix.columnStart.data());
    view.i = const_cast<int*>(matrix.row.data());
    view.x = const_cast<double*>(matrix.value.data());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;

    std::vector<int> group(size, 0), order(size);
    for (const int end : groupEnds) {
        for (std::size_t n = std::size_t(end); n < size; ++n)
            ++group[n];
    }
    cholmod_common* common = &state->common;
    // AMD is the faster where nothing constrains it.
    const bool ordered = groupEnds.empty()
                             ? cholmod_amd(&view, nullptr, 0, order.data(), common)
                             : cholmod_camd(&view, nullptr, 0, group.data(), order.data(), common);
    common->method[0].ordering = CHOLMOD_GIVEN;
    if (ordered) state->factor = cholmod_analyze_p(&view, order.data(), nullptr, 0, common);
    if (state->factor) cholmod_factorize(&view, state->factor, common);
    if (common->status == CHOLMOD_OUT_OF_MEMORY || common->status == CHOLMOD_TOO_LARGE)
        return fail(ErrorKind::noResult, "there is not enough memory to flatten the surface");
    if (!state->factor || common->status != CHOLMOD_OK || state->factor->minor < size)
        return singularSystem();
    return SparseCholesky(std::move(state));
}

void SparseCholesky::forward(std::vector<double>& x) {
    state_->substitute(CHOLMOD_L, x);
}

void SparseCholesky::backward(std::vector<double>& x) {
    state_->substitute(CHOLMOD_Lt, x);
}

std::vector<double> SparseCholesky::solve(std::vector<double> right) {
    forward(right);
    backward(right);
    return right;
}

tl::unexpected<Error> singularSystem() {
    return fail(ErrorKind::noResult,
                "the surface cannot be flattened: a triangle without area leaves its equations "
                "singular");
}

std::vector<double> SparseCholesky::trailing(int first) const {
    const cholmod_factor& factor = *state_->factor;
    const int* order = state_->order();
    const auto* firstColumn = static_cast<const int*>(factor.super);
    const auto* firstRow = static_cast<const int*>(factor.pi);
    const auto* firstValue = static_cast<const int*>(factor.px);
    const auto* rows = static_cast<const int*>(factor.s);
    const auto* values = static_cast<const double*>(factor.x);
    const std::size_t side = factor.n - std::size_t(first);
    std::vector<double> block(side * side, 0.0);
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
        const int height = firstRow[s + 1] - firstRow[s];
        for (int c = firstColumn[s]; c < firstColumn[s + 1]; ++c) {
            const int column = order[c] - first;
            if (column < 0) continue;
            const int offset = c - firstColumn[s];
            const double* value = values + firstValue[s] + std::ptrdiff_t(offset) * height;
            // What a supernode holds above its diagonal is not of the factor.
            for (int n = offset; n < height; ++n) {
                const int row = order[rows[firstRow[s] + n]] - first;
                if (row >= 0) block[std::size_t(column) * side + std::size_t(row)] = value[n];
            }
        }
    }
    return block;
}

}  // namespace haustra::flatten
