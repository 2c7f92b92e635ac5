// Surface-based topological denoising (dissertation §3.3.1).
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "core/tri_mesh.h"

#include <vector>

namespace haustra::surface {

struct HandleRemovalOptions {
    int threads = 0;
    Progress progress;
};

/// One cut: the loop on the fine mesh, its length, and what was filled in.
struct RemovedHandle {
    std::vector<glm::dvec3> loopMm;  ///< closed: the last joins the first
    double lengthMm = 0.0;
    double filledAreaMm2 = 0.0;  ///< of the two discs that close the cut
};

struct HandleRemoval {
    TriMesh mesh;  ///< genus 0
    std::vector<RemovedHandle> handles;
    double areaChangeMm2 = 0.0;
};

/// Removes the handles of a closed, connected, manifold mesh one by one: simplification that
/// preserves topology, cut graph, a finite portion of the universal covering space of the coarse
/// mesh, the shortest loop by shortest paths there, lifted to the fine mesh, cut, and both holes
/// filled; repeated until the genus is 0. Of each handle's generators it is the shortest that is
/// cut, so thin handles break and tunnels are plugged. Fails (badInput) where the mesh is open, not
/// manifold or in several pieces. Deterministic.
Result<HandleRemoval> removeHandles(const TriMesh& mesh, const HandleRemovalOptions& options = {});

}  // namespace haustra::surface
