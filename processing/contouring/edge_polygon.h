// The dual polygon of one crossed edge, cut into triangles that keep within the edge's envelope.
#pragma once

#include <array>
#include <optional>

#include <glm/glm.hpp>

namespace haustra::contouring {

/// A diagonal along which the polygon of the edge from (0, 0, 0) to (1, 0, 0) may be cut: 0 for
/// corners 0–2, 1 for corners 1–3, none where neither keeps the polygon in its envelope.
///
/// `corners` (x along the edge, y and z across it) are the vertices of the four cells around the
/// edge, counter-clockwise seen from its far end, each in its own quadrant of y and z. The envelope
/// is the union of the four tetrahedra of the edge and two corners in succession. Envelopes of
/// different edges share only faces, so a surface whose polygons all lie inside theirs does not
/// intersect itself (Ju and Udeshi, Pacific Graphics 2006). Where neither diagonal will do, a fan
/// around a point of the edge always does. Of two good diagonals it is the one whose triangles are
/// rounder in mm.
std::optional<int> envelopeDiagonal(const std::array<glm::dvec3, 4>& corners,
                                    const std::array<glm::dvec3, 4>& cornersMm);

}  // namespace haustra::contouring
