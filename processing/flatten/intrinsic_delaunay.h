// A triangulation that knows only its edges' lengths, and how it is made Delaunay.
#pragma once

#include "mesh/halfedge_mesh.h"

#include <cstdint>
#include <vector>

namespace haustra::flatten {

/// Half-edge h = 3·triangle + corner, as HalfedgeMesh. Triangles may be glued to themselves, and
/// two vertices joined by several edges.
struct IntrinsicMesh {
    std::vector<int> origin;
    std::vector<int> opposite;  ///< −1 at a rim
    std::vector<double> length;
    /// Closed integer 1-form: whole turns around the tube that a half-edge makes against its ends'
    /// own values.
    std::vector<std::int8_t> turns;
    std::vector<char> kept;  ///< edges that are not flipped; empty: none

    int halfedgeCount() const { return int(origin.size()); }
    int target(int h) const { return origin[std::size_t(mesh::HalfedgeMesh::next(h))]; }
};

/// The surface's own triangles, `cornerTurns` as in TubeTopology. Where triangles have (nearly) no
/// area all lengths grow by the same trifle until they have (Sharp and Crane 2020).
IntrinsicMesh intrinsicMesh(const mesh::HalfedgeMesh& mesh,
                            const std::vector<std::int8_t>& cornerTurns);

/// Cotangent of the angle across from h.
double cotangent(const IntrinsicMesh& mesh, int h);

/// cot α + cot β of the angles across from h's edge.
double cotangentSum(const IntrinsicMesh& mesh, int h);

/// Edges inside the surface whose cotangents' sum is negative beyond rounding.
int countNegative(const IntrinsicMesh& mesh);

/// A flip: its half-edges, which keep their numbers. Those around them change places.
struct EdgeFlip {
    int halfedge, opposite;
};

/// Flips such edges until there is none (Fisher, Springborn, Bobenko and Schröder 2007). The
/// surface and its vertices stay what they are. Returns the number of flips, and appends them to
/// `flips` where given.
int makeDelaunay(IntrinsicMesh& mesh, std::vector<EdgeFlip>* flips = nullptr);

/// A closed form on the half-edges before the flips becomes the one after them, of the same
/// integrals along any path.
void carryThroughFlips(const std::vector<EdgeFlip>& flips, std::vector<std::int8_t>& form);

}  // namespace haustra::flatten
