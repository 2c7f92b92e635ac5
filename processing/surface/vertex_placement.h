// Where the vertices of dual contouring stand within their cells.
#pragma once

#include "surface/boundary_cells.h"
#include "surface/boundary_crossing.h"

#include <vector>

namespace haustra::surface {

/// One position for each loop of each cell, in voxel coordinates, strictly within the cell; where
/// a cell has several loops, each is within the convex hull of its own crossings, so that the
/// hulls and hence the sheets keep apart.
///
/// A position minimises Σ (n · (x − p))² + λ |x − m|² in mm over the loop's crossings p with
/// normals n, m being their mean (Ju et al., SIGGRAPH 2002). Where the HU show no wall (cuts and
/// bridges), positions are relaxed towards their neighbours within their cells instead (Gibson's
/// constrained elastic surface nets), so that no staircase of voxels is left.
std::vector<glm::dvec3> placeVertices(const BoundaryCells& cells,
                                      const BoundaryCrossings& crossings, int threads);

}  // namespace haustra::surface
