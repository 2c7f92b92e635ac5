// The flattened colon: a cut surface with its place in the plane.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/tri_mesh.h"

namespace haustra {

/// The cut surface (seam vertices doubled) with one flat coordinate a vertex: x in [0, 1] around
/// the colon, y in [0, height] from rectum to cecum, in units of the circumference. `camera` is
/// each vertex's sample on the centerline.
struct FlatMap {
    TriMesh surface;
    std::vector<glm::dvec2> flat;
    std::vector<std::int32_t> camera;
    double height = 0.0;
};

}  // namespace haustra
