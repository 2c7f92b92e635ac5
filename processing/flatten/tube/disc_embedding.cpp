#include "flatten/tube/disc_embedding.h"

#include <cmath>
#include <cstddef>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace haustra::flatten {
namespace {

/// tan of half the angle at `at` from a to b, counter-clockwise; 0 where that is none between 0 and
/// a half turn.
double halfTangent(glm::dvec2 at, glm::dvec2 a, glm::dvec2 b) {
    const glm::dvec2 p = a - at, q = b - at;
    const double sine = p.x * q.y - p.y * q.x;
    if (!(sine > 0.0)) return 0.0;
    return (glm::length(p) * glm::length(q) - glm::dot(p, q)) / sine;
}

}  // namespace

std::optional<std::vector<glm::dvec2>> embedDisc(const std::vector<glm::ivec3>& triangles,
                                                 const std::vector<glm::dvec2>& border,
                                                 const std::vector<glm::dvec2>& target) {
    const int held = int(border.size()), vertices = int(target.size()), unknowns = vertices - held;
    std::vector<glm::dvec2> places = border;
    places.resize(target.size(), glm::dvec2(0.0));
    if (unknowns <= 0) return places;

    // Around each vertex: whether the target is without a fold there.
    std::vector<char> sound(target.size(), 1);
    for (const glm::ivec3& t : triangles) {
        const auto at = [&](int c) { return target[std::size_t(t[c % 3])]; };
        for (int c = 0; c < 3; ++c) {
            const double tangent = halfTangent(at(c), at(c + 1), at(c + 2));
            if (!(tangent > 0.0 && std::isfinite(tangent))) sound[std::size_t(t[c])] = 0;
        }
    }
    std::vector<Eigen::Triplet<double>> weights;
    weights.reserve(triangles.size() * 6);
    std::vector<double> sum(target.size(), 0.0);
    for (const glm::ivec3& t : triangles) {
        for (int c = 0; c < 3; ++c) {
            const int v = t[c];
            if (v < held) continue;
            const glm::dvec2 here = target[std::size_t(v)];
            const double tangent = sound[std::size_t(v)]
                                       ? halfTangent(here, target[std::size_t(t[(c + 1) % 3])],
                                                     target[std::size_t(t[(c + 2) % 3])])
                                       : 0.0;
            for (const int w : {t[(c + 1) % 3], t[(c + 2) % 3]}) {
                const double weight = sound[std::size_t(v)]
                                          ? tangent / glm::distance(here, target[std::size_t(w)])
                                          : 1.0;
                weights.emplace_back(v - held, w, weight);
                sum[std::size_t(v)] += weight;
            }
        }
    }
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(weights.size() + std::size_t(unknowns));
    Eigen::MatrixX2d given = Eigen::MatrixX2d::Zero(unknowns, 2);
    for (const auto& entry : weights) {
        const double weight = entry.value() / sum[std::size_t(entry.row() + held)];
        if (entry.col() >= held) {
            entries.emplace_back(entry.row(), entry.col() - held, -weight);
        } else {
            given(entry.row(), 0) += weight * border[std::size_t(entry.col())].x;
            given(entry.row(), 1) += weight * border[std::size_t(entry.col())].y;
        }
    }
    for (int row = 0; row < unknowns; ++row)
        entries.emplace_back(row, row, 1.0);
    Eigen::SparseMatrix<double> means(unknowns, unknowns);
    means.setFromTriplets(entries.begin(), entries.end());
    // No row's other entries outweigh its diagonal: no pivoting is called for.
    Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::AMDOrdering<int>> factor;
    factor.setPivotThreshold(0.0);
    factor.compute(means);
    if (factor.info() != Eigen::Success) return std::nullopt;
    const Eigen::MatrixX2d found = factor.solve(given);
    if (!found.allFinite()) return std::nullopt;
    for (int n = 0; n < unknowns; ++n)
        places[std::size_t(held + n)] = {found(n, 0), found(n, 1)};
    return places;
}

}  // namespace haustra::flatten
