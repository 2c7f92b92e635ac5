// Single triangles pulled straight that the solution of the whole leaves as slivers.
#pragma once

#include "flatten/periodic_map.h"
#include "flatten/tube/vertex_stars.h"

#include <vector>

namespace haustra::flatten {

/// Vertices of triangles that are stretched over `dilatation` times as far one way as the other,
/// with a ring of neighbours; those on rims are left out.
std::vector<int> stretchedVertices(const PeriodicMap& map, const TriMesh& tube,
                                   const VertexStars& stars, double dilatation);

/// Moves each of `vertices` in turn to where the sum over its triangles of K + 1/K is least, K
/// being a triangle's dilatation (the MIPS energy, Hormann and Greiner 2000): convex in one vertex,
/// and infinite before a triangle could flip. A vertex with a flipped triangle stays. Newton's
/// method, `sweeps` times over all. x may leave [0, 1).
void relaxShapes(PeriodicMap& map, const TriMesh& tube, const VertexStars& stars,
                 const std::vector<int>& vertices, int sweeps);

}  // namespace haustra::flatten
