#include "flatten/cotangent_laplacian.h"

#include <algorithm>
#include <utility>

namespace haustra::flatten {
namespace {

/// Calls visit(i, j, h) for each half-edge h from vertex i to j.
template <class Visit>
void forHalfedges(const IntrinsicMesh& mesh, const Visit& visit) {
    for (int h = 0; h < mesh.halfedgeCount(); ++h)
        visit(mesh.origin[std::size_t(h)], mesh.target(h), h);
}

}  // namespace

SymmetricMatrix cotangentLaplacian(const IntrinsicMesh& mesh, const std::vector<int>& unknownOf,
                                   int size) {
    struct Entry {
        int row;
        double value;
    };
    // Each edge's entry goes to the column of its smaller unknown; equal rows are summed.
    std::vector<int> start(std::size_t(size) + 1, 0);
    std::vector<double> diagonal(std::size_t(size), 0.0);
    const auto ends = [&](int i, int j) {
        return std::minmax(unknownOf[std::size_t(i)], unknownOf[std::size_t(j)]);
    };
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        if (mesh.opposite[std::size_t(h)] > h) continue;
        const auto [low, high] = ends(mesh.origin[std::size_t(h)], mesh.target(h));
        if (low >= 0 && low != high) ++start[std::size_t(low) + 1];
    }
    for (std::size_t c = 1; c < start.size(); ++c)
        start[c] += start[c - 1];
    std::vector<Entry> entries(std::size_t(start.back()));
    std::vector<int> next(start.begin(), start.end() - 1);
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        if (mesh.opposite[std::size_t(h)] > h) continue;
        const auto [low, high] = ends(mesh.origin[std::size_t(h)], mesh.target(h));
        if (high < 0 || low == high) continue;
        const double weight = 0.5 * cotangentSum(mesh, h);
        if (low >= 0) {
            diagonal[std::size_t(low)] += weight;
            entries[std::size_t(next[std::size_t(low)]++)] = {high, -weight};
        }
        if (high >= 0) diagonal[std::size_t(high)] += weight;
    }
    SymmetricMatrix matrix;
    matrix.size = size;
    matrix.columnStart.assign(1, 0);
    matrix.columnStart.reserve(std::size_t(size) + 1);
    matrix.row.reserve(entries.size() + std::size_t(size));
    matrix.value.reserve(entries.size() + std::size_t(size));
    for (int c = 0; c < size; ++c) {
        const auto first = entries.begin() + start[std::size_t(c)],
                   last = entries.begin() + start[std::size_t(c) + 1];
        std::stable_sort(first, last, [](const Entry& a, const Entry& b) { return a.row < b.row; });
        matrix.row.push_back(c);
        matrix.value.push_back(diagonal[std::size_t(c)]);
        for (auto entry = first; entry != last; ++entry) {
            if (matrix.row.back() == entry->row) {
                matrix.value.back() += entry->value;
            } else {
                matrix.row.push_back(entry->row);
                matrix.value.push_back(entry->value);
            }
        }
        matrix.columnStart.push_back(int(matrix.row.size()));
    }
    return matrix;
}

namespace {

/// Σ ½ cot · step over the half-edges (i, j) for i, and −that for j; step(i, j, half-edge) is how
/// far the function is known to rise along it.
template <class Step>
std::vector<double> pullOf(const IntrinsicMesh& mesh, const std::vector<int>& unknownOf, int size,
                           const Step& stepOf) {
    std::vector<double> pull(std::size_t(size), 0.0);
    forHalfedges(mesh, [&](int i, int j, int h) {
        const double step = stepOf(i, j, h);
        if (step == 0.0) return;
        const double weight = 0.5 * cotangent(mesh, h);
        const int a = unknownOf[std::size_t(i)], b = unknownOf[std::size_t(j)];
        if (a >= 0) pull[std::size_t(a)] += weight * step;
        if (b >= 0) pull[std::size_t(b)] -= weight * step;
    });
    return pull;
}

}  // namespace

std::vector<double> pullOfFixed(const IntrinsicMesh& mesh, const std::vector<int>& unknownOf,
                                int size, const std::vector<double>& fixed) {
    return pullOf(mesh, unknownOf, size,
                  [&](int i, int j, int) { return fixed[std::size_t(j)] - fixed[std::size_t(i)]; });
}

std::vector<double> pullOfTurns(const IntrinsicMesh& mesh, const std::vector<int>& unknownOf,
                                int size) {
    return pullOf(mesh, unknownOf, size,
                  [&](int, int, int h) { return double(mesh.turns[std::size_t(h)]); });
}

double dirichletEnergy(const IntrinsicMesh& mesh, const std::vector<double>& x, bool around) {
    double energy = 0.0;
    forHalfedges(mesh, [&](int i, int j, int h) {
        const double step = x[std::size_t(j)] - x[std::size_t(i)] +
                            (around ? double(mesh.turns[std::size_t(h)]) : 0.0);
        energy += 0.5 * cotangent(mesh, h) * step * step;
    });
    return energy;
}

}  // namespace haustra::flatten
