// Whether two triangles of a mesh meet only where they must.
#pragma once

#include <array>

#include <glm/glm.hpp>

namespace haustra::simplification {

using TriangleCorners = std::array<glm::dvec3, 3>;

/// The functions answer true only where a plane parts the two by a margin above rounding (10⁻⁷ mm,
/// or 10⁻⁷ of the angle's sine), so that true is certain: triangles without a common vertex;
bool apart(const TriangleCorners& first, const TriangleCorners& second);

/// triangles (v, a, b) and (v, c, d) with the common vertex v only: they meet in v alone;
bool apartAtVertex(const glm::dvec3& v, const glm::dvec3& a, const glm::dvec3& b,
                   const glm::dvec3& c, const glm::dvec3& d);

/// triangles on both sides of the edge uv, with third corners a and b: they meet in it alone.
bool apartAtEdge(const glm::dvec3& u, const glm::dvec3& v, const glm::dvec3& a,
                 const glm::dvec3& b);

/// The plane of a triangle and those upright on it through its edges, which part it from most
/// triangles about it.
class SeparatingPlanes {
public:
    explicit SeparatingPlanes(const TriangleCorners& triangle);

    /// True where one of the planes parts the triangle, by a margin above rounding, from another
    /// with the corners `other` of which at most one is a corner of this, number `common` of this
    /// and `otherCommon` of the other (−1: none): they meet there alone, or nowhere.
    bool part(const TriangleCorners& other, int common, int otherCommon) const;

private:
    TriangleCorners corner_;
    glm::dvec3 normal_;
    std::array<glm::dvec3, 3> outward_;  ///< of edge k, from corner k to the next
};

}  // namespace haustra::simplification
