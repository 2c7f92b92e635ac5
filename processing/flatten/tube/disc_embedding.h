// A triangulated disc on a convex place of the plane, without a fold.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::flatten {

/// Places the vertices of a triangulated disc. `triangles`, counter-clockwise, number the vertices
/// from 0 on, of which the first `border.size()` are the border, in order; `border` are their
/// places, the corners of a strictly convex polygon, counter-clockwise. No edge but the border's
/// may join two of them. Every other vertex goes to a mean of its neighbours with positive weights,
/// so that no triangle is turned over (Tutte 1963; Floater 2003 for weights that differ both ways).
/// They are the mean-value coordinates of its place in `target` (per vertex, the border's too),
/// which give the target back where that is without a fold and the borders agree; around a vertex
/// where it is not, all neighbours weigh the same. Returns a place per vertex; nothing where the
/// system cannot be solved. O(n^1.5).
std::optional<std::vector<glm::dvec2>> embedDisc(const std::vector<glm::ivec3>& triangles,
                                                 const std::vector<glm::dvec2>& border,
                                                 const std::vector<glm::dvec2>& target);

}  // namespace haustra::flatten
