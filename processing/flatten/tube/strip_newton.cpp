#include "flatten/tube/strip_newton.h"

#include "core/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <suitesparse/cholmod.h>

namespace haustra::flatten {
namespace {

/// Per vertex a rank, the larger the larger its triangles are in the plane for their area.
std::vector<int> sizeRanks(const TriMesh& tube, const std::vector<double>& stretch) {
    std::vector<double> sorted = stretch;
    const double middle = medianOf(sorted);
    constexpr int most = 100;
    std::vector<int> ranks(tube.vertices.size(), most);
    for (std::size_t t = 0; t < stretch.size(); ++t) {
        // Three decades in area a rank leave their sum half of a double's digits and more.
        const int rank = most - int(std::clamp(std::log10(middle / stretch[t]) / 3.0, 0.0, 90.0));
        for (int c = 0; c < 3; ++c) {
            int& of = ranks[std::size_t(tube.triangles[t][c])];
            of = std::min(of, rank);
        }
    }
    return ranks;
}

}  // namespace

struct StripNewton::State {
    const TriMesh& tube;
    std::vector<std::array<int, 2>> unknownOf;  ///< per vertex, x and y; −1: held
    /// The lower triangle by columns.
    std::vector<int> columnStart, row;
    std::vector<double> value;
    std::vector<std::array<int, 21>> slots;  ///< per triangle, where its Hessian goes; −1: not
    cholmod_common common{};
    cholmod_factor* factor = nullptr;

    explicit State(const TriMesh& of) : tube(of) {
        cholmod_start(&common);
        common.print = 0;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.final_ll = 1;
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_GIVEN;
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }

    int size() const { return int(columnStart.size()) - 1; }

    cholmod_sparse view() {
        cholmod_sparse view{};
        view.nrow = view.ncol = std::size_t(size());
        view.nzmax = row.size();
        view.p = columnStart.data();
        view.i = row.data();
        view.x = value.data();
        view.stype = -1;
        view.itype = CHOLMOD_INT;
        view.xtype = CHOLMOD_REAL;
        view.dtype = CHOLMOD_DOUBLE;
        view.sorted = view.packed = 1;
        return view;
    }

    /// Calls visit(entry of the Hessian, row, column) for those between unknowns.
    template <class Visit>
    void forEachEntry(std::size_t triangle, const Visit& visit) const {
        const std::array<int, 6> at = unknowns(triangle);
        std::size_t entry = 0;
        for (std::size_t r = 0; r < 6; ++r) {
            for (std::size_t c = 0; c <= r; ++c, ++entry) {
                if (at[r] >= 0 && at[c] >= 0)
                    visit(entry, std::max(at[r], at[c]), std::min(at[r], at[c]));
            }
        }
    }

    std::array<int, 6> unknowns(std::size_t triangle) const {
        std::array<int, 6> all;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto& [x, y] = unknownOf[std::size_t(tube.triangles[triangle][int(c)])];
            all[2 * c] = x, all[2 * c + 1] = y;
        }
        return all;
    }

    void makePattern(int unknownCount) {
        std::vector<std::pair<int, int>> entries;  // column, row
        entries.reserve(tube.triangles.size() * 21);
        for (std::size_t t = 0; t < tube.triangles.size(); ++t)
            forEachEntry(t, [&](std::size_t, int r, int c) { entries.emplace_back(c, r); });
        std::sort(entries.begin(), entries.end());
        entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
        columnStart.assign(std::size_t(unknownCount) + 1, 0);
        for (const auto& [c, r] : entries) {
            ++columnStart[std::size_t(c) + 1];
            row.push_back(r);
        }
        for (std::size_t c = 1; c < columnStart.size(); ++c)
            columnStart[c] += columnStart[c - 1];
        value.assign(row.size(), 0.0);
        slots.resize(tube.triangles.size());
        for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
            slots[t].fill(-1);
            forEachEntry(t, [&](std::size_t entry, int r, int c) {
                const auto begin = row.begin() + columnStart[std::size_t(c)];
                const auto end = row.begin() + columnStart[std::size_t(c) + 1];
                slots[t][entry] = int(std::lower_bound(begin, end, r) - row.begin());
            });
        }
    }

    /// Where rounding leaves a pivot that is not positive, the diagonal grows until none is.
    bool factorize() {
        cholmod_sparse matrix = view();
        double grown = 0.0;
        for (double more = 1e-14; more < 1e-4; more *= 100.0) {
            common.status = CHOLMOD_OK;
            cholmod_factorize(&matrix, factor, &common);
            if (common.status == CHOLMOD_OK && factor->minor == factor->n) return true;
            if (common.status < CHOLMOD_OK) return false;
            for (int c = 0; c < size(); ++c)
                value[std::size_t(columnStart[std::size_t(c)])] *= (1.0 + more) / (1.0 + grown);
            grown = more;
        }
        return false;
    }

    std::vector<double> solve(std::vector<double> right) {
        cholmod_dense view{};
        view.nrow = view.nzmax = view.d = right.size();
        view.ncol = 1;
        view.x = right.data();
        view.xtype = CHOLMOD_REAL;
        view.dtype = CHOLMOD_DOUBLE;
        cholmod_dense* found = cholmod_solve(CHOLMOD_A, factor, &view, &common);
        std::vector<double> solved(right.size(), 0.0);
        if (found) std::copy_n(static_cast<const double*>(found->x), right.size(), solved.begin());
        cholmod_free_dense(&found, &common);
        return solved;
    }
};

StripNewton::StripNewton(const TriMesh& tube, const std::vector<int>& lower,
                         const std::vector<int>& upper, const std::vector<double>& stretch)
    : state_(std::make_unique<State>(tube)) {
    const std::size_t vertices = tube.vertices.size();
    std::vector<char> used(vertices, 0), rim(vertices, 0);
    for (const glm::ivec3& t : tube.triangles) {
        for (int c = 0; c < 3; ++c)
            used[std::size_t(t[c])] = 1;
    }
    for (const int v : lower)
        rim[std::size_t(v)] = 1;
    for (const int v : upper)
        rim[std::size_t(v)] = 2;
    const std::vector<int> ranks = sizeRanks(tube, stretch);
    constexpr int height = 0;
    std::vector<int> group{101};
    state_->unknownOf.assign(vertices, {-1, -1});
    const auto add = [&](std::size_t v) {
        group.push_back(ranks[v]);
        return int(group.size()) - 1;
    };
    for (std::size_t v = 0; v < vertices; ++v) {
        if (!used[v]) continue;
        // One vertex keeps its x: the strip may turn freely.
        if (int(v) != lower.front()) state_->unknownOf[v][0] = add(v);
        state_->unknownOf[v][1] = rim[v] == 0 ? add(v) : rim[v] == 2 ? height : -1;
    }
    state_->makePattern(int(group.size()));

    // CAMD wants its groups numbered from 0.
    std::vector<int> present = group;
    std::sort(present.begin(), present.end());
    present.erase(std::unique(present.begin(), present.end()), present.end());
    for (int& g : group)
        g = int(std::lower_bound(present.begin(), present.end(), g) - present.begin());
    std::vector<int> order(group.size());
    cholmod_sparse matrix = state_->view();
    if (cholmod_camd(&matrix, nullptr, 0, group.data(), order.data(), &state_->common))
        state_->factor = cholmod_analyze_p(&matrix, order.data(), nullptr, 0, &state_->common);
}

StripNewton::~StripNewton() = default;

Result<StripNewton::Step> StripNewton::step(const std::vector<StripEnergy::Derivatives>& triangles,
                                            double scaleCurvature) {
    auto& value = state_->value;
    std::fill(value.begin(), value.end(), 0.0);
    const auto size = std::size_t(state_->size());
    std::vector<double> slope(size, 0.0), mixed(size, 0.0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const StripEnergy::Derivatives& triangle = triangles[t];
        const std::array<int, 6> at = state_->unknowns(t);
        std::size_t entry = 0;
        for (std::size_t r = 0; r < 6; ++r) {
            for (std::size_t c = 0; c <= r; ++c, ++entry) {
                const int slot = state_->slots[t][entry];
                if (slot < 0) continue;
                // Off the diagonal of a triangle's corners, yet on that of the shared height.
                const bool twice = r != c && at[r] == at[c];
                value[std::size_t(slot)] += (twice ? 2.0 : 1.0) * triangle.hessian[entry];
            }
            if (at[r] < 0) continue;
            slope[std::size_t(at[r])] -= triangle.gradient[r];
            mixed[std::size_t(at[r])] += triangle.scaleMixed[r];
        }
    }
    if (!state_->factor || !state_->factorize()) {
        return fail(ErrorKind::noResult,
                    "areas cannot be evened out: memory or a double's digits do not suffice");
    }
    std::vector<double> direction = state_->solve(slope);
    const std::vector<double> answer = state_->solve(mixed);
    const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0.0;
        for (std::size_t n = 0; n < a.size(); ++n)
            sum += a[n] * b[n];
        return sum;
    };
    const double left = scaleCurvature - dot(mixed, answer);
    // What the projection to positive curvatures took away may leave none for the scale.
    if (left > 1e-3 * scaleCurvature) {
        const double share = dot(mixed, direction) / left;
        for (std::size_t n = 0; n < size; ++n)
            direction[n] += share * answer[n];
    }

    Step step;
    step.slope = -dot(slope, direction);
    if (!std::isfinite(step.slope)) {
        return fail(ErrorKind::noResult,
                    "areas cannot be evened out: a double's digits do not suffice");
    }
    const auto moveOf = [&](int unknown) {
        return unknown < 0 ? 0.0 : direction[std::size_t(unknown)];
    };
    step.move.reserve(state_->unknownOf.size());
    for (const auto& [x, y] : state_->unknownOf)
        step.move.push_back({moveOf(x), moveOf(y)});
    return step;
}

}  // namespace haustra::flatten
