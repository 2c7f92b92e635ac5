// A lens over an endoscopic picture: which camera sees what lies beneath it, and how that camera's
// picture is laid over the other so that both show each place of the patient at the same pixel.
#pragma once

#include "core/camera.h"
#include "tiles/picture.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::reader {

/// Lengths are heights of the picture beneath, from its middle to the right and down.
struct LensPlace {
    glm::dvec2 center{0.0};
    double radius = 0.15;
    bool operator==(const LensPlace&) const = default;
};

/// The camera whose square picture just encloses the lens: at the place of the one beneath, towards
/// what that one shows in the lens's middle; of an orthographic one, beside it. None where that one
/// shows nothing there (a fisheye's black), or does not pass its check.
std::optional<Camera> cameraOfLens(const Camera& beneath, const LensPlace& place);

/// Whether rays of the two cameras that show the same place see the same: they begin at one place,
/// or, parallel, at one plane.
bool registers(const Camera& lens, const Camera& beneath);

/// What is seen through the lens: side × side pixels, rows from the top, 0xAARRGGBB, colours
/// multiplied by opacity; its first pixel lies over pixel `corner` of the picture beneath.
/// Transparent outside the lens, and where the lens's picture does not reach.
struct LensDisc {
    glm::ivec2 corner{0};
    int side = 0;
    std::vector<std::uint32_t> pixels;
};

/// For each pixel within the lens the ray of the picture beneath, of `size` pixels, and from the
/// lens's picture, made by `lens`, the colour in its direction, interpolated bilinearly. Some 0.2
/// µs a pixel. The cameras have passed their check.
LensDisc throughLens(const tiles::Picture& picture, const Camera& lens, const Camera& beneath,
                     const LensPlace& place, glm::ivec2 size);

/// What is seen through the lens covers the picture beneath.
void layOver(tiles::Picture& beneath, const LensDisc& disc);

}  // namespace haustra::reader
