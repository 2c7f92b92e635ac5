// Separating axes: two convex sets are apart exactly if one of finitely many directions parts them.
#include "simplification/triangle_separation.h"

#include <algorithm>
#include <cmath>

namespace haustra::simplification {
namespace {

constexpr double marginMm = 1e-7;
constexpr double marginSine = 1e-7;
constexpr double planeMarginMm = 1e-6;

/// Parted by more than the margin along `axis` (of any length).
bool partedAlong(const glm::dvec3& axis, const TriangleCorners& first,
                 const TriangleCorners& second) {
    const auto [low1, high1] =
        std::minmax({glm::dot(axis, first[0]), glm::dot(axis, first[1]), glm::dot(axis, first[2])});
    const auto [low2, high2] = std::minmax(
        {glm::dot(axis, second[0]), glm::dot(axis, second[1]), glm::dot(axis, second[2])});
    const double gap = std::max(low2 - high1, low1 - high2);
    return gap > 0.0 && gap * gap > marginMm * marginMm * glm::dot(axis, axis);
}

/// −1, 0, 1: the side of the plane through the origin with normal n where x lies; 0 within the
/// margin.
int side(const glm::dvec3& n, const glm::dvec3& x) {
    const double along = glm::dot(n, x);
    const double least = marginSine * marginSine * glm::dot(n, n) * glm::dot(x, x);
    return along * along <= least ? 0 : along > 0.0 ? 1 : -1;
}

}  // namespace

bool apart(const TriangleCorners& first, const TriangleCorners& second) {
    // Differences from one corner keep the margin far above rounding.
    const glm::dvec3 origin = first[0];
    TriangleCorners p, q;
    for (int k = 0; k < 3; ++k) {
        p[k] = first[k] - origin;
        q[k] = second[k] - origin;
    }
    const glm::dvec3 pEdges[] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    const glm::dvec3 qEdges[] = {q[1] - q[0], q[2] - q[1], q[0] - q[2]};
    const glm::dvec3 pNormal = glm::cross(pEdges[0], pEdges[1]);
    const glm::dvec3 qNormal = glm::cross(qEdges[0], qEdges[1]);
    if (partedAlong(pNormal, p, q) || partedAlong(qNormal, p, q)) return true;
    for (const glm::dvec3& pEdge : pEdges) {
        for (const glm::dvec3& qEdge : qEdges) {
            if (partedAlong(glm::cross(pEdge, qEdge), p, q)) return true;
        }
    }
    for (int k = 0; k < 3; ++k) {  // in one plane, the axes lie in it
        if (partedAlong(glm::cross(pNormal, pEdges[k]), p, q)) return true;
        if (partedAlong(glm::cross(qNormal, qEdges[k]), p, q)) return true;
    }
    return false;
}

bool apartAtVertex(const glm::dvec3& v, const glm::dvec3& pointA, const glm::dvec3& pointB,
                   const glm::dvec3& pointC, const glm::dvec3& pointD) {
    const glm::dvec3 a = pointA - v, b = pointB - v, c = pointC - v, d = pointD - v;
    const glm::dvec3 n = glm::cross(a, b), m = glm::cross(c, d);
    const int sideC = side(n, c), sideD = side(n, d);
    if (sideC != 0 && sideC == sideD) return true;
    const int sideA = side(m, a), sideB = side(m, b);
    if (sideA != 0 && sideA == sideB) return true;
    // A plane through one side of each wedge, the rest of the wedges on either side of it.
    const auto partedBy = [](const glm::dvec3& x, const glm::dvec3& otherX, const glm::dvec3& y,
                             const glm::dvec3& otherY) {
        const glm::dvec3 normal = glm::cross(x, y);
        return side(normal, otherX) * side(normal, otherY) < 0;
    };
    if (partedBy(a, b, c, d) || partedBy(a, b, d, c) || partedBy(b, a, c, d) ||
        partedBy(b, a, d, c)) {
        return true;
    }
    // In one plane: an upright plane through one side of a wedge.
    const auto upright = [](const glm::dvec3& normal, const glm::dvec3& x, const glm::dvec3& other,
                            const glm::dvec3& y, const glm::dvec3& z) {
        const glm::dvec3 axis = glm::cross(normal, x);
        const int inside = side(axis, other);
        return inside != 0 && side(axis, y) == -inside && side(axis, z) == -inside;
    };
    return upright(n, a, b, c, d) || upright(n, b, a, c, d) || upright(m, c, d, a, b) ||
           upright(m, d, c, a, b);
}

bool apartAtEdge(const glm::dvec3& u, const glm::dvec3& v, const glm::dvec3& a,
                 const glm::dvec3& b) {
    const glm::dvec3 edge = v - u;
    const glm::dvec3 n = glm::cross(edge, a - u), m = glm::cross(edge, b - u);
    // Folded flat where the planes agree and both corners lie on one side of the edge.
    const double cosine = glm::dot(n, m), least = 1.0 - 1e-4;
    return cosine < 0.0 || cosine * cosine < least * least * glm::dot(n, n) * glm::dot(m, m);
}

SeparatingPlanes::SeparatingPlanes(const TriangleCorners& triangle) : corner_(triangle) {
    const auto unit = [](const glm::dvec3& x) {
        const double squared = glm::dot(x, x);
        return squared > 0.0 ? x / std::sqrt(squared) : glm::dvec3(0.0);
    };
    normal_ = unit(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
    for (int k = 0; k < 3; ++k)
        outward_[k] = unit(glm::cross(triangle[(k + 1) % 3] - triangle[k], normal_));
}

bool SeparatingPlanes::part(const TriangleCorners& other, int common, int otherCommon) const {
    const auto partedBy = [&](const glm::dvec3& axis, const glm::dvec3& origin) {
        for (int j = 0; j < 3; ++j) {
            if (j != otherCommon && glm::dot(axis, other[j] - origin) <= planeMarginMm)
                return false;
        }
        return true;
    };
    for (int k = 0; k < 3; ++k) {  // the common corner must be the edge's
        const int facing = (k + 2) % 3;
        if (common != facing && partedBy(outward_[k], corner_[k])) return true;
    }
    return partedBy(normal_, corner_[0]) || partedBy(-normal_, corner_[0]);
}

}  // namespace haustra::simplification
