// Triangles in a tree of boxes: the one nearest to a point, and those that meet something.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// A binary tree of boxes over triangles, halved at the median along the longest side. Immutable;
/// any number of threads. It refers to the vertices and triangles it was made of, which must
/// outlive it; about 40 bytes a triangle beside them.
class TriangleTree {
public:
    struct Box {
        glm::dvec3 low{std::numeric_limits<double>::infinity()};
        glm::dvec3 high{-std::numeric_limits<double>::infinity()};
    };
    struct Nearest {
        int triangle = -1;
        glm::dvec3 barycentric{0.0};  ///< of the nearest point in it; each ≥ 0
        double squaredDistance = std::numeric_limits<double>::infinity();
    };

    /// At least one triangle; indices in range. O(n log n).
    TriangleTree(std::span<const glm::dvec3> vertices, std::span<const glm::ivec3> triangles);

    const Box& bounds() const { return nodes_.front().box; }

    /// Changes `best` where a triangle is nearer to `point` than it; exact, triangles without area
    /// included. Of equally near ones the first met, which depends on nothing but the mesh. O(log
    /// n) expected near the triangles.
    void nearest(glm::dvec3 point, Nearest& best) const;

    /// Calls visit(triangle) for all triangles in leaves whose boxes, and all boxes around them,
    /// meet: meets(box) says so. A triangle itself may lie beside what its leaf's box meets.
    template <class Meets, class Visit>
    void forEach(const Meets& meets, const Visit& visit) const {
        std::vector<std::int32_t> open{0};
        while (!open.empty()) {
            const std::int32_t at = open.back();
            open.pop_back();
            const Node& node = nodes_[std::size_t(at)];
            if (!meets(node.box)) continue;
            for (std::int32_t n = 0; n < node.count; ++n)
                visit(order_[std::size_t(node.first + n)]);
            if (node.count == 0) open.insert(open.end(), {node.first, at + 1});
        }
    }

private:
    struct Node {
        Box box;
        std::int32_t first = 0;  ///< leaf: its first triangle in `order_`; else the right child
        std::int32_t count = 0;  ///< leaf: its triangles; else 0, and the left child is the next
    };

    void build(std::int32_t first, std::int32_t count, const std::vector<glm::dvec3>& middles);

    std::span<const glm::dvec3> vertices_;
    std::span<const glm::ivec3> triangles_;
    std::vector<Node> nodes_;
    std::vector<std::int32_t> order_;
};

/// Weights (≥ 0, sum 1) of the point of triangle abc that is nearest to `p`. A triangle without
/// area is the segment or point that it is.
glm::dvec3 nearestInTriangle(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);

}  // namespace haustra
