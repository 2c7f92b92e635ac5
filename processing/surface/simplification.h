// Fewer triangles, the same topology, a bounded error.
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "core/tri_mesh.h"

namespace haustra::surface {

struct SimplificationOptions {
    double errorMm = 0.1;  ///< bound on the distance from the input's surface, both ways
    double minAngleDegrees =
        12.0;  ///< no collapse makes a corner sharper than this, where it was not
    int threads = 0;
    Progress progress;
};

/// Edge collapses under the link condition in the order of their quadric error (Garland and
/// Heckbert), refused where they would leave the error bound, fold a triangle over, make a sliver
/// or let the surface cut through itself. A closed manifold without self-intersections stays one,
/// with the same Euler characteristic. Fails where the mesh is not closed and manifold (badInput).
/// The same mesh for any number of threads.
Result<TriMesh> simplify(const TriMesh& mesh, const SimplificationOptions& options = {});

}  // namespace haustra::surface
