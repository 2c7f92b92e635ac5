// What is folded over in a flat map, unfolded where it lies.
#pragma once

#include "flatten/periodic_map.h"
#include "flatten/tube/vertex_stars.h"

#include <vector>

namespace haustra::flatten {

/// Moves a vertex to the point from which the nearest of its star's sides is farthest; false where
/// it has none from which all of its triangles are upright, and then it stays. O(k⁴) for k sides.
bool centerInStar(PeriodicMap& map, const TriMesh& tube, const VertexStars& stars, int v);

/// An intrinsic triangulation can leave vertices of the surface's own triangles collinear or turned
/// over. Where one vertex of a flipped triangle can move to where all its triangles are upright, it
/// goes to the middle of these places. Else the vertices of a patch around it are solved for with
/// mean-value weights (Floater 2003), which are positive, so that a patch with a convex outline
/// unfolds; where that does not help, the weights lean outwards, for blind fingers so long that
/// doubles cannot tell their tips' vertices apart, and the patch is widened by rings of neighbours.
/// A patch that gets no better is left alone, and all of a map in which over 1,000 triangles and
/// one in fifty are flipped. Rims do not move, nor do vertices that are `held` (per vertex; empty:
/// none). x may leave [0, 1). Returns the vertices moved. O(n), beside small local systems.
std::vector<int> unfold(PeriodicMap& map, const TriMesh& tube, const VertexStars& stars,
                        const std::vector<char>& held = {});

/// Unfolds flips, and relaxes the vertices of triangles that are stretched over four times as far
/// one way as the other, with a ring around them (shape_relaxation.h); where a flip remains, again
/// from there, up to four times. What is `apart` (per triangle; empty: nothing) is left alone, and
/// its vertices stay. Returns the number of vertices moved.
int repairMap(PeriodicMap& map, const TriMesh& tube, const std::vector<char>& apart = {});

}  // namespace haustra::flatten
