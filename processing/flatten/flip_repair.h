// What is folded over in a flat map, mended where it lies.
#pragma once

#include "flatten/periodic_map.h"

namespace haustra::flatten {

/// Triangles of no or negative flat area.
std::vector<int> flippedTriangles(const PeriodicMap& map, const TriMesh& tube);

/// Moves the vertices of flipped triangles to the mean-value mean of their neighbours (Floater
/// 2003: positive weights, so that a patch with a convex outline unfolds), rims along themselves,
/// and widens the patches by a ring of neighbours until nothing is flipped or no more can be
/// mended. Returns the number of vertices moved; the map is never left with more flips than it had.
int repairFlips(PeriodicMap& map, const TriMesh& tube);

}  // namespace haustra::flatten
