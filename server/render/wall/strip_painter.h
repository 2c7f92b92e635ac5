// Paints for a flattened wall: bridges, bookmarked places, and what has not been seen.
#pragma once

#include "render/wall/wall_paint.h"
#include "render/wall/wall_sight.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace haustra::render {

/// A place of the wall with a disc around it.
struct WallMark {
    glm::dvec2 flat{0.0};
    glm::dvec3 positionMm{0.0};
};

/// Pixels of a strip's paint that marks colour, and how much, 0…255; in the order of pixels.
struct MarkedPixel {
    std::int32_t pixel = 0;
    std::uint8_t cover = 0;
};

/// A pixel of a strip's paint and its colour; a: how much it covers.
struct TintedPixel {
    std::int32_t pixel = 0;
    glm::u8vec4 color{0};
};

/// A picture of the strip that knows each pixel's place of the wall. Immutable; any number of
/// threads.
class StripPainter {
public:
    /// Pixels a circumference: some tenths of a millimetre each, and fewer where the strip would
    /// get longer than a paint may be.
    static constexpr int pixelsAround = 256;

    /// Fails (badInput) as FlatGeometry::of does. O(pixels + n log n), some tenths of a second and
    /// 4 bytes a pixel for a colon.
    static Result<std::shared_ptr<const StripPainter>> of(std::shared_ptr<const WallSight> sight);

    glm::ivec2 size() const { return size_; }
    const WallSight& sight() const { return *sight_; }
    const std::shared_ptr<const WallSight>& sharedSight() const { return sight_; }

    /// Discs around marks: a pixel is in one where it is within the radius through space and joined
    /// to the mark by such pixels, so that the far side of a fold has none. Their rims are full,
    /// and their insides leave more of the wall's own colour. The radius is within its bounds.
    std::vector<MarkedPixel> discs(std::span<const WallMark> marks, double radiusMm) const;

    /// The place of the wall that a pixel shows; empty where it shows none. Pixels are counted in
    /// rows, as paint's. A tenth of a microsecond.
    std::optional<WallSight::Place> placeAt(std::int32_t pixel) const;

    /// Bridges are hatched in grey, whatever else is painted, so that nobody takes one for mucosa.
    /// `seenTriangles` (0 or 1 each; empty: nothing is said of what has been seen) gives triangles
    /// that have not been seen one colour; `findings` have theirs over it, and marks another over
    /// both. Smooth (WallPaint). A few milliseconds.
    std::shared_ptr<const WallPaint> paint(std::span<const MarkedPixel> marks,
                                           std::span<const std::uint8_t> seenTriangles,
                                           std::span<const TintedPixel> findings = {}) const;
    /// The hatched bridges over another paint of this strip, as fine as this painter is.
    std::shared_ptr<const WallPaint> bridgesOver(const WallPaint& paint) const;

private:
    explicit StripPainter(std::shared_ptr<const WallSight> sight);
    void hatch(WallPaint& paint) const;
    glm::dvec2 flatOf(glm::ivec2 pixel) const;
    glm::dvec3 placeOf(glm::ivec2 pixel) const;
    std::size_t at(glm::ivec2 pixel) const {
        return std::size_t(pixel.y) * std::size_t(size_.x) + std::size_t(pixel.x);
    }

    std::shared_ptr<const WallSight> sight_;
    glm::ivec2 size_{0};
    std::vector<std::int32_t> triangle_;  // of each pixel; −1: none
};

}  // namespace haustra::render
