// Which place of the wall each pixel of a picture of the strip shows.
#pragma once

#include "core/flat_map.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

/// A picture of the whole strip lying on its side: columns run from the rectum to the cecum, rows
/// once around the colon towards −x, so that the wall is seen from within as in the upright one
/// turned clockwise. Row-major.
struct StripRaster {
    glm::ivec2 size{0};
    struct Pixel {
        std::int32_t triangle = -1;  ///< of the flat map; none: a hair between triangles
        glm::vec2 weights{0.0f};     ///< of its second and third corner
    };
    std::vector<Pixel> pixels;

    glm::dvec3 placeOf(const Pixel& pixel, const FlatMap& flat) const;
};

/// A pixel has the triangle that holds its middle. The same for any number of threads, each of
/// which looks at all triangles: O(triangles · threads + pixels).
StripRaster rasterStrip(const FlatMap& flat, glm::ivec2 size, int threads);

}  // namespace haustra::cad
