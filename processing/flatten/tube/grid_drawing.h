// A triangulated disc drawn on a coarse grid, where means of neighbours would crowd its vertices.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::flatten {

/// Draws a triangulation of the triangle whose corners are the vertices 0, 1 and 2, in that order
/// counter-clockwise. `triangles`, counter-clockwise and not that one itself, fill it; no two edges
/// join the same two vertices. Returns whole barycentric coordinates per vertex, all three ≥ 0 with
/// the sum `vertices` − 1, in which every triangle is counter-clockwise (Schnyder, Embedding planar
/// graphs on the grid, 1990): none is lower than about 1 / vertices² of the whole, whatever its
/// place, where Tutte's embeddings shrink by a factor at each of a row of narrow necks. Nothing
/// where the triangles are no such triangulation. O(n).
std::optional<std::vector<glm::ivec3>> drawOnGrid(const std::vector<glm::ivec3>& triangles,
                                                  int vertices);

}  // namespace haustra::flatten
