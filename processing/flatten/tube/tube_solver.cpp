#include "flatten/tube/tube_solver.h"

#include "core/parallel.h"
#include "flatten/blas_threads.h"
#include "flatten/sparse_cholesky.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace haustra::flatten {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Rim and ring together; where two factors are as fast as one with dense blocks of this side.
constexpr std::size_t mostDense = 2000;

/// Which vertices are eliminated where. The last vertex of the second rim is held at 0 in v.
struct Dissection {
    std::vector<int> between;            ///< empty where the rims are too close: all is one half
    std::vector<int> inside[2], rim[2];  ///< of the halves
};

/// How much of `breadthFirst`, up to a level's end, makes the first half; none where no level parts
/// the rims. A level costs as much as its dense block, and the rest is to be shared evenly.
int firstHalf(const TubeTopology& topology, const std::vector<char>& rimOf) {
    const std::vector<int>& order = topology.breadthFirst;
    const auto farRim =
        std::find_if(order.begin(), order.end(), [&](int v) { return rimOf[std::size_t(v)] == 2; });
    int best = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t level = 1; level + 1 < topology.levelStart.size(); ++level) {
        const int first = topology.levelStart[level], last = topology.levelStart[level + 1];
        if (last > farRim - order.begin()) break;
        const double cost = std::max(first, int(order.size()) - last) + 40.0 * (last - first);
        if (cost < least) {
            least = cost;
            best = last;
        }
    }
    return best;
}

Dissection dissect(const IntrinsicMesh& mesh, const TubeTopology& topology, std::size_t vertices) {
    const std::vector<int>& order = topology.breadthFirst;
    std::vector<char> rimOf(vertices, 0), halfOf(vertices, 0), isBetween(vertices, 0);
    for (int rim = 0; rim < 2; ++rim) {
        for (const int v : topology.rims[rim])
            rimOf[std::size_t(v)] = char(rim + 1);
    }
    const int first = firstHalf(topology, rimOf);
    for (std::size_t n = std::size_t(first); first > 0 && n < order.size(); ++n)
        halfOf[std::size_t(order[n])] = 1;
    // Flipped edges reach across levels, so what is between is told by the edges as they are now.
    bool parted = first > 0;
    for (int h = 0; h < mesh.halfedgeCount() && parted; ++h) {
        int from = mesh.origin[std::size_t(h)], to = mesh.target(h);
        if (halfOf[std::size_t(from)] == halfOf[std::size_t(to)]) continue;
        if (halfOf[std::size_t(from)] != 0) std::swap(from, to);
        const int v = rimOf[std::size_t(from)] == 0 ? from : to;
        parted = rimOf[std::size_t(v)] == 0;
        isBetween[std::size_t(v)] = 1;
    }
    Dissection made;
    const int ground = topology.rims[1].back();
    for (const int v : order) {
        const auto at = std::size_t(v);
        if (v == ground) continue;
        const int half = parted ? halfOf[at] : 0;
        if (parted && isBetween[at] != 0)
            made.between.push_back(v);
        else
            (rimOf[at] != 0 ? made.rim : made.inside)[half].push_back(v);
    }
    return made;
}

/// Unknowns of a half that are kept dense.
std::size_t denseSide(const Dissection& parts, int half) {
    return parts.between.size() + parts.rim[half].size();
}

/// Calls work(0) and work(1), at once where that is safe.
template <class Work>
void sideBySide(int threads, const Work& work) {
    const int atOnce = useSingleThreadedBlas() ? threads : 1;
    parallelFor(2, 1, atOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            work(n);
    });
}

/// One half's unknowns: the vertices inside, those on its rim, and those between the halves.
class Half {
public:
    Half(const IntrinsicMesh& mesh, const std::vector<int>& inside, const std::vector<int>& rim,
         const std::vector<int>& between)
        : mesh_(mesh),
          inside_(int(inside.size())),
          rim_(int(rim.size())),
          between_(int(between.size())),
          vertexOf_(inside) {
        vertexOf_.insert(vertexOf_.end(), rim.begin(), rim.end());
        vertexOf_.insert(vertexOf_.end(), between.begin(), between.end());
    }

    /// Eliminates all but what is between. `held` is u on the rims, per vertex.
    Result<void> eliminate(const std::vector<double>& held) {
        const int size = int(vertexOf_.size()), last = inside_ + rim_;
        if (last == 0) return {};
        std::vector<int> unknownOf(held.size(), -1);
        for (int n = 0; n < size; ++n)
            unknownOf[std::size_t(vertexOf_[std::size_t(n)])] = n;
        u_ = pullOfFixed(mesh_, unknownOf, size, held);
        v_ = pullOfTurns(mesh_, unknownOf, size);
        pullU_ = Vector::Map(u_.data() + last, between_);
        pullV_ = Vector::Map(v_.data() + last, between_);
        std::fill(u_.begin() + inside_, u_.end(), 0.0);
        std::fill(v_.begin() + last, v_.end(), 0.0);
        {
            const SymmetricMatrix matrix = cotangentLaplacian(mesh_, unknownOf, size);
            own_ = Matrix::Zero(between_, between_);
            for (int c = last; c < size; ++c) {
                for (int n = matrix.columnStart[std::size_t(c)];
                     n < matrix.columnStart[std::size_t(c) + 1]; ++n)
                    own_(matrix.row[std::size_t(n)] - last, c - last) =
                        matrix.value[std::size_t(n)];
            }
            auto made = TRY(SparseCholesky::of(matrix, {inside_, last}));
            factor_ = std::move(made);
        }
        factor_->forward(u_);
        factor_->forward(v_);
        const std::vector<double> trailing = factor_->trailing(inside_);
        const auto block = Matrix::Map(trailing.data(), rim_ + between_, rim_ + between_);
        betweenBetween_ = block.bottomRightCorner(between_, between_);
        betweenRim_ = block.bottomLeftCorner(between_, rim_);
        complementV_ = Matrix::Zero(between_, between_);
        complementV_.selfadjointView<Eigen::Lower>().rankUpdate(betweenBetween_);
        complementU_ = complementV_;
        complementU_.selfadjointView<Eigen::Lower>().rankUpdate(betweenRim_);
        return {};
    }

    /// Of the matrix between, lower triangles: its own entries, and with what this half's
    /// elimination takes from them. In u the rim is held, so that nothing is eliminated there.
    const Matrix& own() const { return own_; }
    const Matrix& complementU() const { return complementU_; }
    const Matrix& complementV() const { return complementV_; }
    /// The right-hand sides between, and what this half's elimination adds to them.
    const Vector& pullU() const { return pullU_; }
    const Vector& pullV() const { return pullV_; }
    Vector addedU() const {
        return betweenBetween_ * tail(u_) + betweenRim_ * Vector::Map(u_.data() + inside_, rim_);
    }
    Vector addedV() const { return betweenBetween_ * tail(v_); }

    /// Solves for what was eliminated, given the solution between, into values per vertex.
    void substitute(const Vector& betweenU, const Vector& betweenV, TubeSolution& found) {
        if (!factor_) return;
        // The rim's part is what makes u zero there, for its values are in the right-hand side.
        Vector::Map(u_.data() + inside_, rim_) = betweenRim_.transpose() * betweenU;
        tail(u_) = betweenBetween_.transpose() * betweenU;
        tail(v_) = betweenBetween_.transpose() * betweenV;
        factor_->backward(u_);
        factor_->backward(v_);
        for (int n = 0; n < inside_ + rim_; ++n) {
            const auto vertex = std::size_t(vertexOf_[std::size_t(n)]);
            if (n < inside_) found.u[vertex] = u_[std::size_t(n)];
            found.v[vertex] = v_[std::size_t(n)];
        }
    }

private:
    Eigen::Map<Vector> tail(std::vector<double>& x) const {
        return Vector::Map(x.data() + inside_ + rim_, between_);
    }
    Eigen::Map<const Vector> tail(const std::vector<double>& x) const {
        return Vector::Map(x.data() + inside_ + rim_, between_);
    }

    const IntrinsicMesh& mesh_;
    int inside_, rim_, between_;
    std::vector<int> vertexOf_;
    std::optional<SparseCholesky> factor_;
    std::vector<double> u_, v_;
    Vector pullU_, pullV_;
    Matrix own_, betweenBetween_, betweenRim_, complementU_, complementV_;
};

Result<TubeSolution> solveByHalves(const IntrinsicMesh& mesh, const TubeTopology& topology,
                                   std::size_t vertices, const Dissection& parts, int threads,
                                   const std::function<void()>& factored) {
    TubeSolution found = heldValues(topology, vertices);
    Half halves[] = {{mesh, parts.inside[0], parts.rim[0], parts.between},
                     {mesh, parts.inside[1], parts.rim[1], parts.between}};
    Result<void> outcomes[2];
    sideBySide(threads, [&](std::size_t n) { outcomes[n] = halves[n].eliminate(found.u); });
    for (const auto& outcome : outcomes) {
        if (!outcome) return tl::make_unexpected(outcome.error());
    }
    if (factored) factored();
    Vector between[2];
    if (!parts.between.empty()) {
        bool solved[2] = {false, false};
        sideBySide(threads, [&](std::size_t n) {
            // Both halves hold the entries between; they count once.
            const Matrix system =
                n == 0 ? halves[0].complementU() + halves[1].complementU() - halves[0].own()
                       : halves[0].complementV() + halves[1].complementV() - halves[0].own();
            const Eigen::LLT<Matrix> factor(system);
            solved[n] = factor.info() == Eigen::Success;
            between[n] =
                factor.solve(n == 0 ? halves[0].pullU() + halves[0].addedU() + halves[1].addedU()
                                    : halves[0].pullV() + halves[0].addedV() + halves[1].addedV());
        });
        if (!solved[0] || !solved[1]) return singularSystem();
    }
    sideBySide(threads,
               [&](std::size_t n) { halves[n].substitute(between[0], between[1], found); });
    for (std::size_t n = 0; n < parts.between.size(); ++n) {
        const auto vertex = std::size_t(parts.between[n]);
        found.u[vertex] = between[0][Eigen::Index(n)];
        found.v[vertex] = between[1][Eigen::Index(n)];
    }
    return found;
}

Result<TubeSolution> solveSeparately(const IntrinsicMesh& mesh, const TubeTopology& topology,
                                     std::size_t vertices, int threads,
                                     const std::function<void()>& factored) {
    TubeSolution found = heldValues(topology, vertices);
    TubeSystem systems[2];
    std::optional<SparseCholesky> factors[2];
    Result<void> outcomes[2];
    sideBySide(threads, [&](std::size_t n) {
        systems[n] =
            tubeSystem(mesh, topology, vertices, n == 0 ? TubeFunction::u : TubeFunction::v);
        if (systems[n].vertexOf.empty()) return;
        auto made = SparseCholesky::of(systems[n].matrix);
        systems[n].matrix = {};
        if (made)
            factors[n] = std::move(*made);
        else
            outcomes[n] = tl::make_unexpected(made.error());
    });
    for (const auto& outcome : outcomes) {
        if (!outcome) return tl::make_unexpected(outcome.error());
    }
    if (factored) factored();
    sideBySide(threads, [&](std::size_t n) {
        if (!factors[n]) return;
        systems[n].place(factors[n]->solve(std::move(systems[n].right)),
                         n == 0 ? found.u : found.v);
    });
    return found;
}

}  // namespace

Result<TubeSolution> solveTube(const IntrinsicMesh& mesh, const TubeTopology& topology,
                               std::size_t vertices, int threads,
                               const std::function<void()>& factored, Elimination elimination) {
    const Dissection parts = dissect(mesh, topology, vertices);
    const bool isLong = std::max(denseSide(parts, 0), denseSide(parts, 1)) > mostDense;
    if (elimination == Elimination::separately || (elimination == Elimination::suited && isLong))
        return solveSeparately(mesh, topology, vertices, threads, factored);
    return solveByHalves(mesh, topology, vertices, parts, threads, factored);
}

}  // namespace haustra::flatten
