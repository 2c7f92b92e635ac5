// A polyp's outline on the colon's surface and on its flat map.
#pragma once

#include "core/tri_mesh.h"
#include "flatten/periodic_map.h"
#include "mesh/halfedge_mesh.h"

#include <functional>
#include <optional>
#include <vector>

namespace haustra::bench {

/// A closed curve through the surface's triangles, and where its points are in the plane (in one
/// piece: x may leave [0, 1)).
struct FlatOutline {
    std::vector<glm::dvec3> placesMm;
    std::vector<glm::dvec2> flat;
    /// In millimetres as the surface lies when it is unrolled around the middle of what is inside:
    /// geodesic coordinates (see unroll in geodesic_frame.h). A polyp that is draped over a fold
    /// has its own shape there, which no direction in space shows.
    std::vector<glm::dvec2> unrolledMm;
    double insideMm2 = 0.0;  ///< of the piece of surface that it is the border of
};

/// Where a field cuts the surface: of the pieces of surface on which `inside` is negative, the one
/// with the largest area, and of that one's borders the one that encloses the rest in the plane.
/// Empty where nothing is inside, a border meets a rim of the tube, or the piece runs around the
/// whole colon. `inside` need not be a distance; along each edge it is taken to change sign once.
std::optional<FlatOutline> outlineOf(const TriMesh& tube, const mesh::HalfedgeMesh& edges,
                                     const flatten::PeriodicMap& map,
                                     const std::function<double(glm::dvec3)>& inside);

struct OutlineShape {
    double area = 0.0;    ///< enclosed
    double aspect = 1.0;  ///< ≥ 1: longer over shorter axis of the ellipse with its second moments
};

/// Of what a simple polygon in the plane encloses.
OutlineShape shapeOf(const std::vector<glm::dvec2>& polygon);

/// A closed curve in space as seen along its vector area: whence it encloses the most. Millimetres.
std::vector<glm::dvec2> fromAbove(const std::vector<glm::dvec3>& curve);

/// Of the linear map that takes `from` to `to` with the least squares, point for point, each for
/// the length of `from` around it: its greater over its lesser stretch, ≥ 1. Unlike two aspects, it
/// also tells a shape that lies across its own. Of equally many points; 1 where there are under 3.
double stretchBetween(const std::vector<glm::dvec2>& from, const std::vector<glm::dvec2>& to);

}  // namespace haustra::bench
