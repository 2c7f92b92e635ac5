// The flattened colon: a cut surface with its place in the plane.
#pragma once

#include "core/tri_mesh.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// What a flat map may reach: circumferences of height, and millimetres from the origin. Beyond
/// these it is no colon's, and its squares no longer tell distances.
inline constexpr double maxFlatHeight = 4096.0, maxWallMm = 1e6;

/// Pictures of a flat map of this height are drawn of whole numbers: flat coordinates times this
/// power of two, rounded. As many as leave 31 bits room for the strip's length; 2²⁶ up to a height
/// of 30 circumferences.
constexpr int flatUnitsPerCircumference(double height) {
    int units = 1 << 26;
    while ((height + 2.0) * units > 0x1p31)
        units /= 2;
    return units;
}

/// One place on the centerline that the wall is looked at from (dissertation §4.3.1).
struct FlatCamera {
    glm::dvec3 positionMm{0.0};  ///< LPS
    double arcMm = 0.0;          ///< along the centerline, from the rectum
};

/// The colon's surface cut open along its seam, and flattened. The flat plane is periodic: its unit
/// is the circumference, x in [0, 1] runs around the colon, y in [0, height] from rectum to cecum,
/// and (0, y) is the same place as (1, y). Triangles that are counter-clockwise on the surface
/// seen from outside are so in the plane. A picture shows the wall from within: its columns run
/// towards −x, its rows towards −y (see core/strip_layout.h), and the rectum is at the bottom.
struct FlatMap {
    TriMesh surface;  ///< vertices on the seam are doubled; triangles it crosses, split
    std::vector<glm::dvec2> flat;              ///< per vertex
    std::vector<std::int32_t> camera;          ///< per vertex, an index into `cameras`
    std::vector<std::int32_t> sourceTriangle;  ///< per triangle: the one of the closed surface that
                                               ///< it is, or is a part of
    std::vector<FlatCamera> cameras;           ///< equally spaced from rectum to cecum
    double height = 0.0;
};

}  // namespace haustra
