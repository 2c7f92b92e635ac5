// Which way the lumen lies.
#pragma once

#include "core/tri_mesh.h"

#include <vector>

namespace haustra::render {

/// A unit normal into the lumen for each vertex: the mean of its triangles', weighted by their
/// angles there. Vertices at one place, as along a flat map's seam, have one normal. Indices must
/// be in range. O(n log n). Any thread.
std::vector<glm::dvec3> inwardNormals(const TriMesh& mesh);

}  // namespace haustra::render
