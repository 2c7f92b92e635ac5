// A blind tube rolled up to a disc of nested polygons, which no number of its rings can fold.
#pragma once

#include "core/tri_mesh.h"
#include "flatten/periodic_map.h"

#include <optional>
#include <vector>

namespace haustra::flatten {

/// A disc cut along some lines, and where its pieces lie.
struct RolledDisc {
    TriMesh disc;                     ///< the vertices before, and those of the cuts
    std::vector<glm::dvec2> places;   ///< per vertex, within the unit circle
    std::vector<int> sourceTriangle;  ///< per triangle: the one that it is, or is a part of
};

/// Rolls up a disc that is a tube but for its `tip`: the first triangles are the strip's, which
/// `strip` maps, the others meet at the tip. The first vertices, as many as `ringAngles`, are the
/// tube's rim at y = 0; they come to lie in about these directions, which ascend by one turn.
///
/// Where rings of a tube become circles, their edges are chords, and n of them reach inwards by
/// π² / 2n² of the radius: a tube must shrink by so much from ring to ring, and one of many rings
/// of few edges to nothing. Here all become polygons with the same up to six directions of their
/// corners, so that they may be as close to each other as they like. The strip is cut along the
/// vertical lines to these corners, and along up to twelve levels between which the same number of
/// triangles lies. Each rectangle then goes to its trapezoid by the projective map
/// (s, t) → (1, s) / (a + b t), which keeps lines straight, no triangle turned over, and agrees
/// with its neighbours along the sides. So every piece of a triangle that is upright on the strip
/// is upright, whatever the triangulation. Of two rules for the levels' radii it takes the mean:
/// areas in ratio of the triangles within, and the same step for each row of them. Vertices very
/// near to a cut move onto it where that leaves the strip without a fold. Nothing where the rim's
/// directions leave a corner of more than 0.42 turns open, or the rim is no rim. O(n).
std::optional<RolledDisc> rollAsPolygon(const TriMesh& disc, const PeriodicMap& strip, int tip,
                                        const std::vector<double>& ringAngles);

}  // namespace haustra::flatten
