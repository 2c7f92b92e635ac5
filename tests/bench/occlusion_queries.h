// Triangle visibility as the dissertation measures it (§2.4): an occlusion query for each triangle.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"
#include "core/wall_visibility.h"

#include <vector>

namespace haustra::bench {

/// Steps 1 to 3 of §2.4 for one camera: each triangle drawn with a query and no depth test
/// (N_total), those that cover a pixel drawn together for the depth buffer, and each of them once
/// more with a query (N_observed, within the depth of field). `queries` is how many there were.
/// Needs a current context.
Result<std::vector<Visibility>> queryTriangles(const TriMesh& wall, const PinholePicture& picture,
                                               const CenterlineCamera& camera, long& queries);

}  // namespace haustra::bench
