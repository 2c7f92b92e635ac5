// Colours for places of the wall: detected polyps, regions covered or not (dissertation §6.3.1).
#pragma once

#include "core/result.h"
#include "render/scene/picture.h"
#include "render/scene/raycaster.h"

#include <memory>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// A picture of the whole strip, laid out as the exported flat image is without a seam margin: its
/// columns run towards −x once around the colon, its rows towards −y, the cecum up. Each pixel
/// colours the places of the wall whose flat coordinate lies in it. Immutable once a view has it;
/// any number of threads.
struct WallPaint {
    glm::ivec2 size{0};
    std::vector<glm::u8vec4> pixels;  ///< rows from the top; rgb: sRGB, a: how much it covers
    double height = 0.0;              ///< the strip's, circumferences
    bool smooth = false;              ///< between the middles of pixels it is interpolated, over
                                      ///< the seam too; else each pixel is of one colour

    /// The colour at a flat coordinate, x modulo 1; nothing (all 0) beyond the strip's ends.
    glm::u8vec4 at(glm::dvec2 flat) const;
};

/// Longest side of a paint, pixels.
inline constexpr int maxPaintSide = 1 << 15;

/// Fails (badInput) where there are no pixels, or not as many as its size says, a side is over
/// maxPaintSide, or the height is none of a strip.
Result<void> checkWallPaint(const WallPaint& paint);

/// Which place of the wall a pixel sees first.
struct WallPixel {
    glm::vec2 flat{0.0f};
    float depthMm = -1.0f;  ///< as a backdrop's: along the ray, or from an orthographic camera's
                            ///< plane; negative where the pixel sees no wall
    float padding = 0.0f;
    bool seen() const { return depthMm >= 0.0f; }
};

/// Tints the band of a finished picture: in linear light a painted pixel keeps its brightest
/// component, which is the wall's light, and takes its colour from the paint, as far as the paint
/// covers it. So it works on whatever drew the picture. `seen` is the band's, rows from the top;
/// pixels that see no wall, and places without paint, stay as they are to the bit. The same for any
/// number of threads (≤ 0: all cores). O(pixels).
void tint(std::span<const WallPixel> seen, const WallPaint& paint, const Band& band, Image& picture,
          int threads);

/// Likewise `rows`, the band of a finished picture of a window onto the strip.
void tint(const FlatWindow& window, const WallPaint& paint, const Band& band, Image& rows,
          int threads);

}  // namespace haustra::render
