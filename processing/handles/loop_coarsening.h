// A coarse mesh with the topology of a fine one.
#pragma once

#include "core/tri_mesh.h"

#include <vector>

namespace haustra::handles {

struct CoarseMesh {
    TriMesh mesh;
    std::vector<int> fineVertex;  ///< for each coarse vertex, the fine one at the same place
};

/// Collapses edges into one of their ends, shortest first, under the link condition, which keeps
/// the topology (Dey et al. 1999), until at most `vertices` are left or none can be collapsed.
/// Folding triangles over is avoided while it can be. `fine` must be closed and manifold. O(n log
/// n).
CoarseMesh coarsen(const TriMesh& fine, int vertices);

}  // namespace haustra::handles
