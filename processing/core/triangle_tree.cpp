#include "core/triangle_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace haustra {
namespace {

constexpr std::int32_t leafSize = 4;

double squaredLength(glm::dvec3 v) {
    return glm::dot(v, v);
}

double squaredDistance(glm::dvec3 p, const TriangleTree::Box& box) {
    return squaredLength(p - glm::clamp(p, box.low, box.high));
}

}  // namespace

glm::dvec3 nearestInTriangle(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const glm::dvec3 areas(glm::dot(glm::cross(b - p, c - p), normal),
                           glm::dot(glm::cross(c - p, a - p), normal),
                           glm::dot(glm::cross(a - p, b - p), normal));
    const double sum = areas.x + areas.y + areas.z;
    if (sum > 0.0 && areas.x >= 0.0 && areas.y >= 0.0 && areas.z >= 0.0) return areas / sum;

    const std::array<glm::dvec3, 3> corners{a, b, c};
    glm::dvec3 best(0.0);
    double bestSquared = std::numeric_limits<double>::infinity();
    for (int from = 0; from < 3; ++from) {
        const int to = (from + 1) % 3;
        const glm::dvec3 edge = corners[std::size_t(to)] - corners[std::size_t(from)];
        const glm::dvec3 away = p - corners[std::size_t(from)];
        const double squared = squaredLength(edge);
        const double t = squared > 0.0 ? std::clamp(glm::dot(away, edge) / squared, 0.0, 1.0) : 0.0;
        const double distance = squaredLength(away - t * edge);
        if (distance < bestSquared) {
            bestSquared = distance;
            best = glm::dvec3(0.0);
            best[from] = 1.0 - t;
            best[to] = t;
        }
    }
    return best;
}

TriangleTree::TriangleTree(std::span<const glm::dvec3> vertices,
                           std::span<const glm::ivec3> triangles)
    : vertices_(vertices), triangles_(triangles), order_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::vector<glm::dvec3> middles;
    middles.reserve(triangles.size());
    for (const glm::ivec3& t : triangles)
        middles.push_back(vertices[std::size_t(t.x)] + vertices[std::size_t(t.y)] +
                          vertices[std::size_t(t.z)]);
    nodes_.reserve(triangles.size());
    build(0, std::int32_t(triangles.size()), middles);
    nodes_.shrink_to_fit();
}

void TriangleTree::build(std::int32_t first, std::int32_t count,
                         const std::vector<glm::dvec3>& middles) {
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    Box box, middleBox;
    const auto begin = order_.begin() + first;
    for (auto t = begin; t != begin + count; ++t) {
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 v = vertices_[std::size_t(triangles_[std::size_t(*t)][c])];
            box.low = glm::min(box.low, v), box.high = glm::max(box.high, v);
        }
        const glm::dvec3 m = middles[std::size_t(*t)];
        middleBox.low = glm::min(middleBox.low, m), middleBox.high = glm::max(middleBox.high, m);
    }
    if (count <= leafSize) {
        nodes_[at] = {box, first, count};
        return;
    }
    const glm::dvec3 extent = middleBox.high - middleBox.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const std::int32_t half = count / 2;
    std::nth_element(begin, begin + half, begin + count, [&](std::int32_t a, std::int32_t b) {
        const double left = middles[std::size_t(a)][axis], right = middles[std::size_t(b)][axis];
        return left != right ? left < right : a < b;
    });
    build(first, half, middles);
    nodes_[at] = {box, std::int32_t(nodes_.size()), 0};
    build(first + half, count - half, middles);
}

void TriangleTree::nearest(glm::dvec3 point, Nearest& best) const {
    struct Open {
        std::int32_t node;
        double squared;
    };
    // Halving keeps the depth under 32; each level leaves at most one node behind.
    std::array<Open, 64> open;
    std::size_t count = 0;
    open[count++] = {0, squaredDistance(point, nodes_.front().box)};
    while (count > 0) {
        const Open next = open[--count];
        if (next.squared >= best.squaredDistance) continue;
        const Node& node = nodes_[std::size_t(next.node)];
        if (node.count == 0) {
            Open near{next.node + 1,
                      squaredDistance(point, nodes_[std::size_t(next.node) + 1].box)};
            Open far{node.first, squaredDistance(point, nodes_[std::size_t(node.first)].box)};
            if (far.squared < near.squared) std::swap(near, far);
            open[count++] = far;
            open[count++] = near;
            continue;
        }
        for (std::int32_t n = node.first; n < node.first + node.count; ++n) {
            const int triangle = order_[std::size_t(n)];
            const glm::ivec3 t = triangles_[std::size_t(triangle)];
            const glm::dvec3 a = vertices_[std::size_t(t.x)], b = vertices_[std::size_t(t.y)],
                             c = vertices_[std::size_t(t.z)];
            const glm::dvec3 w = nearestInTriangle(point, a, b, c);
            const double squared =
                squaredLength(w.x * (a - point) + w.y * (b - point) + w.z * (c - point));
            if (squared < best.squaredDistance) best = {triangle, w, squared};
        }
    }
}

}  // namespace haustra
