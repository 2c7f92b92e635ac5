// Surface-based topological denoising (dissertation §3.3.1).
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "core/tri_mesh.h"

#include <cstddef>
#include <vector>

namespace haustra::handles {

struct HandleRemovalOptions {
    int threads = 0;
    Progress progress;
};

/// One cut: the loop on the fine mesh, its length, and what was filled in.
struct RemovedHandle {
    std::vector<glm::dvec3> loopMm;  ///< closed: the last joins the first
    double lengthMm = 0.0;
    double filledAreaMm2 = 0.0;  ///< of the two discs that close the cut
    /// Pairs of triangles that cut through each other where the cut was made, one of them filled in
    /// or moved. Not 0 where none of the loops that were tried has a clean filling.
    std::size_t crossings = 0;
};

struct HandleRemoval {
    TriMesh mesh;  ///< each piece of genus 0
    std::vector<RemovedHandle> handles;
    double areaChangeMm2 = 0.0;
};

/// Removes the handles of a closed manifold mesh one by one, in each of its pieces: simplification
/// that preserves topology, cut graph, a finite portion of the universal covering space of the
/// coarse mesh, the shortest loop by shortest paths there, settled on the fine mesh (see
/// shortestLoop), cut, and both holes filled; repeated until the genus is 0. Of all loops it is the
/// shortest that does not separate, so thin handles break, tunnels are plugged, and no neck is cut,
/// which would remove no handle. Where a filling would cut through the surface (something passes
/// the tunnel) or through another piece, shortest loops of up to three other classes are tried for
/// one that is clean; if none is, the one with the fewest crossings is cut, which its `crossings`
/// tell: no other loop of a class is tried, so a clean cut may exist then. Only
/// the loops' vertices move, by less than their triangles' size; vertices and triangles keep their
/// numbers, and new ones follow. Fails (badInput) where the mesh is open or not manifold. O(n log
/// n) for each handle. The same mesh for any number of threads.
Result<HandleRemoval> removeHandles(const TriMesh& mesh, const HandleRemovalOptions& options = {});

}  // namespace haustra::handles
