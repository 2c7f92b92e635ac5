#include "flatten/tube/tip_function.h"

#include "core/flood_fill.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

// Keeps the system definite and its values apart where cotangents vanish.
constexpr double leastWeight = 1e-3;

/// Vertices that are within `radiusMm` of `tip` along edges.
std::vector<char> nearTo(const HalfedgeMesh& halfedges, int tip, double radiusMm) {
    std::vector<char> reached(std::size_t(halfedges.vertexCount()), 0);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    front.push({0.0, tip});
    while (!front.empty()) {
        const auto [distanceMm, v] = front.top();
        front.pop();
        if (reached[std::size_t(v)]) continue;
        reached[std::size_t(v)] = 1;
        int h = halfedges.outgoing(v);
        do {
            const double next = distanceMm + halfedges.lengthMm(h);
            if (next < radiusMm && !reached[std::size_t(halfedges.target(h))])
                front.push({next, halfedges.target(h)});
            h = halfedges.turnLeft(h);
        } while (h != halfedges.outgoing(v));
    }
    return reached;
}

/// What is not `inside` and does not hang together with the largest such piece becomes inside.
/// False where nothing is outside.
bool fillPockets(const HalfedgeMesh& halfedges, std::vector<char>& inside) {
    std::vector<int> piece(inside.size(), -1);
    std::vector<std::size_t> sizes;
    std::vector<int> front;
    for (int seed = 0; seed < halfedges.vertexCount(); ++seed) {
        if (inside[std::size_t(seed)] || piece[std::size_t(seed)] >= 0 ||
            halfedges.outgoing(seed) < 0) {
            continue;
        }
        const int number = int(sizes.size());
        sizes.push_back(0);
        piece[std::size_t(seed)] = number;
        front.assign(1, seed);
        const auto neighbours = [&](int v, const auto& visit) {
            int h = halfedges.outgoing(v);
            do {
                visit(halfedges.target(h));
                h = halfedges.turnLeft(h);
            } while (h != halfedges.outgoing(v));
        };
        floodFill(front, neighbours, [&](int w) {
            if (inside[std::size_t(w)] || piece[std::size_t(w)] >= 0) return false;
            piece[std::size_t(w)] = number;
            return true;
        });
        sizes.back() = front.size();
    }
    if (sizes.empty()) return false;
    const auto largest = int(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    for (std::size_t v = 0; v < inside.size(); ++v)
        inside[v] = inside[v] || (piece[v] >= 0 && piece[v] != largest);
    return true;
}

double cotangent(const TriMesh& mesh, int apex, int a, int b) {
    const glm::dvec3 p = mesh.vertices[std::size_t(apex)];
    const glm::dvec3 u = mesh.vertices[std::size_t(a)] - p, v = mesh.vertices[std::size_t(b)] - p;
    const double sine = glm::length(glm::cross(u, v));
    return sine > 0.0 ? glm::dot(u, v) / sine : 0.0;
}

double weightOf(const TriMesh& mesh, const HalfedgeMesh& halfedges, int h) {
    const int a = halfedges.origin(h), b = halfedges.target(h);
    const int left = halfedges.origin(HalfedgeMesh::previous(h)),
              right = halfedges.origin(HalfedgeMesh::previous(halfedges.opposite(h)));
    return std::max(leastWeight,
                    0.5 * (cotangent(mesh, left, a, b) + cotangent(mesh, right, a, b)));
}

}  // namespace

std::optional<TipFunction> tipFunction(const TriMesh& closed, const HalfedgeMesh& halfedges,
                                       int tip, double radiusMm) {
    std::vector<char> inside = nearTo(halfedges, tip, radiusMm);
    if (!fillPockets(halfedges, inside)) return std::nullopt;
    std::vector<int> unknown(inside.size(), -1);
    int unknowns = 0;
    for (std::size_t v = 0; v < inside.size(); ++v) {
        if (inside[v] && int(v) != tip) unknown[v] = unknowns++;
    }
    // Σ w (g(v) − g(w)) = 0 at every unknown, with 1 at the tip and 0 outside.
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd given = Eigen::VectorXd::Zero(unknowns);
    std::vector<std::pair<int, double>> atTip;  // neighbours and weights
    for (int v = 0; v < int(inside.size()); ++v) {
        if (!inside[std::size_t(v)]) continue;
        const int row = unknown[std::size_t(v)];
        double sum = 0.0;
        int h = halfedges.outgoing(v);
        do {
            const int w = halfedges.target(h);
            const double weight = weightOf(closed, halfedges, h);
            sum += weight;
            if (v == tip) {
                atTip.emplace_back(w, weight);
            } else if (w == tip) {
                given[row] += weight;
            } else if (unknown[std::size_t(w)] >= 0) {
                entries.emplace_back(row, unknown[std::size_t(w)], -weight);
            }
            h = halfedges.turnLeft(h);
        } while (h != halfedges.outgoing(v));
        if (row >= 0) entries.emplace_back(row, row, sum);
    }
    Eigen::SparseMatrix<double> laplacian(unknowns, unknowns);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    Eigen::VectorXd green = Eigen::VectorXd::Zero(unknowns);
    if (unknowns > 0)
        green = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(laplacian).solve(given);

    double flux = 0.0;
    for (const auto& [w, weight] : atTip) {
        const int row = unknown[std::size_t(w)];
        flux += weight * (1.0 - (row >= 0 ? green[row] : 0.0));
    }
    TipFunction made{tip, std::vector<double>(inside.size(), 1.0)};
    for (std::size_t v = 0; v < inside.size(); ++v) {
        if (unknown[v] >= 0)
            made.value[v] = std::exp(-2.0 * std::numbers::pi * green[unknown[v]] / flux);
    }
    made.value[std::size_t(tip)] = 0.0;
    return made;
}

double levelLengthMm(const TriMesh& closed, const TipFunction& function, double level) {
    double length = 0.0;
    for (const glm::ivec3& t : closed.triangles) {
        glm::dvec3 ends[2];
        int found = 0;
        for (int c = 0; c < 3; ++c) {
            const auto a = std::size_t(t[c]), b = std::size_t(t[(c + 1) % 3]);
            const double from = function.value[a], to = function.value[b];
            if ((from < level) == (to < level) || found == 2) continue;
            ends[found++] =
                glm::mix(closed.vertices[a], closed.vertices[b], (level - from) / (to - from));
        }
        if (found == 2) length += glm::distance(ends[0], ends[1]);
    }
    return length;
}

}  // namespace haustra::flatten
