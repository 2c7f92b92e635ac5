// What lies under a place of the overview's picture.
#pragma once

#include "core/centerline.h"
#include "core/orbit.h"

#include <optional>
#include <vector>

namespace haustra::reader {

/// The path's place that is drawn nearest to `pixel` of a picture of `size`, at most `reach` pixels
/// away; of places that are drawn as near, to within 3 pixels, the one nearest to the eye. Its arc.
std::optional<double> arcAt(const Orbit& orbit, const Centerline& path, glm::dvec2 pixel,
                            glm::dvec2 size, double reach);

/// Which of `places` is drawn nearest to `pixel`, at most `reach` pixels away.
std::optional<std::size_t> placeAt(const Orbit& orbit, const std::vector<glm::dvec3>& places,
                                   glm::dvec2 pixel, glm::dvec2 size, double reach);

/// From the front, with the path and the colon around it in a picture of this shape.
Orbit orbitOf(const Centerline& path, double aspect);

}  // namespace haustra::reader
