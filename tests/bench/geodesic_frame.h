// A patch of surface laid out around its middle.
#pragma once

#include "core/tri_mesh.h"
#include "mesh/halfedge_mesh.h"

#include <vector>

namespace haustra::bench {

/// Geodesic coordinates, millimetres, of a patch's vertices (`inPatch`, per vertex) and of their
/// neighbours, around the vertex of the patch that is deepest in it: along the shortest way over
/// edges, each edge's vector is laid into the plane of the first by parallel transport (Schmidt,
/// Grimm and Wyvill 2006, *Interactive decal compositing with discrete exponential maps*). Others
/// are at (0, 0), as all are where nothing is outside the patch.
std::vector<glm::dvec2> unroll(const TriMesh& mesh, const mesh::HalfedgeMesh& edges,
                               const std::vector<char>& inPatch);

}  // namespace haustra::bench
