// A disc that spans a loop in space.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace haustra::handles {

/// Triangles over the corners of a closed polygon (0 … n−1, in its order) and `interior` further
/// vertices (n …), so that the polygon's edges run as in the polygon. No edge joins two corners but
/// the polygon's own, so that the disc can be glued to any mesh without doubling an edge.
struct LoopDisc {
    int corners = 0;
    std::vector<glm::dvec3> interior;
    std::vector<glm::ivec3> triangles;
};

/// Where the polygon's projection onto its mean plane is simple: a Delaunay triangulation there
/// with interior points about as far apart as the polygon's corners, lifted to the discrete
/// harmonic (soap-film) height; so it never cuts itself. Else the triangulation of least dihedral
/// angles and area (Liepa; CGAL), refined, and relaxed to harmonic positions. `polygon` has at
/// least three corners. O(m^1.5) for m vertices, O(n³) in the second case.
LoopDisc spanLoop(const std::vector<glm::dvec3>& polygon);

/// Values at the corners carried to the interior: each interior value is the mean of its
/// neighbours', so between the least and the greatest corner's.
std::vector<glm::dvec3> extendInside(const LoopDisc& disc, const std::vector<glm::dvec3>& corners);

}  // namespace haustra::handles
