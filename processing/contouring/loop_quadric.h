// What the HU around one cell say about where the surface is in it.
#pragma once

#include "contouring/boundary_cells.h"
#include "contouring/boundary_crossing.h"

#include <vector>

namespace haustra::contouring {

/// Σ w (n · (x − p))² over the crossings p of one loop, normals n in mm: the quadric of dual
/// contouring (Ju et al., SIGGRAPH 2002). All in mm from voxel (0, 0, 0).
struct LoopQuadric {
    glm::dmat3 normals{0.0};  ///< Σ w n nᵀ
    glm::dvec3 planes{0.0};   ///< Σ w n (n · p)
    glm::dvec3 mean{0.0};     ///< of the crossings on their edges: inside the loop's hull
};

/// One for each loop, in the order of the vertices. w is 1 where the HU show the wall between the
/// two centres, falls to 0 half an edge beyond them, and is 0 where they show none.
std::vector<LoopQuadric> loopQuadrics(const BoundaryCells& cells,
                                      const BoundaryCrossings& crossings, int threads);

}  // namespace haustra::contouring
