// Where the vertices of dual contouring stand within their cells.
#pragma once

#include "contouring/boundary_cells.h"
#include "contouring/boundary_crossing.h"

#include <vector>

namespace haustra::contouring {

/// One position for each loop of each cell, in voxels from the crossings' origin, strictly within
/// the cell; where
/// a cell has several loops, each is the mean of its own crossings, so that the sheets keep apart.
///
/// The positions x minimise the sum of their cells' quadrics, Σ w (n · (x − p))² over the crossings
/// p of the loop with normals n (Ju et al., SIGGRAPH 2002), and of
/// λ |x − mean of the neighbours' x|² in mm: the HU decide across the wall, and along the wall the
/// vertices spread evenly. Where the HU show no wall (cuts, bridges) that leaves the smoothest
/// sheet within the cells, not a staircase of voxels (Gibson's constrained elastic surface nets,
/// MICCAI 1998). By Jacobi's iteration, each step clamped to the cells: the same for any threads.
std::vector<glm::dvec3> placeVertices(const BoundaryCells& cells,
                                      const BoundaryCrossings& crossings, int threads);

}  // namespace haustra::contouring
