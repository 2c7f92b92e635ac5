// The cells of one picture: which of its pixels see each, and in which order they are drawn.
#pragma once

#include "core/grid.h"
#include "render/object_order/cell_grid.h"
#include "render/scene/picture.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// Pixels low ≤ (x, y) < high.
struct PixelRect {
    glm::ivec2 low{0}, high{0};
    bool empty() const { return high.x <= low.x || high.y <= low.y; }
};

/// From boxes in voxel coordinates to pixels of one camera's picture. Immutable.
class Footprint {
public:
    /// The camera must have passed its check.
    Footprint(const Camera& camera, const Grid& grid, glm::ivec2 pictureSize);

    /// Holds every pixel whose ray meets the box, by a pixel more than rounding needs, and few
    /// others. Empty where the box is beside the picture or behind the camera.
    PixelRect of(glm::dvec3 low, glm::dvec3 high) const;

private:
    PixelRect perspective(glm::dvec3 low, glm::dvec3 high) const;
    PixelRect fisheye(glm::dvec3 low, glm::dvec3 high) const;
    PixelRect orthographic(glm::dvec3 low, glm::dvec3 high) const;
    /// From the picture's middle, in half heights, y down.
    PixelRect around(glm::dvec2 low, glm::dvec2 high) const;
    glm::dvec3 inCamera(glm::dvec3 voxel) const {
        return glm::dvec3(cameraFromVoxel_ * glm::dvec4(voxel, 1.0));
    }

    Lens lens_;
    double perUnit_;  // half heights of the picture for each unit of LensFrame
    glm::ivec2 size_;
    glm::dmat4 cameraFromVoxel_;  // mm; x right, y down, z ahead
};

/// Pixels along the side of a tile, whose rays are followed together.
inline constexpr int rayTile = 8;

struct PlannedCell {
    int cell = 0;
    int layer = 0;
    PixelRect tiles;  ///< of the band
};

/// All cells that `needed` says (by index) and some ray of the band's rows may meet, layer by
/// layer.
std::vector<PlannedCell> planFrame(const CellGrid& cells, const std::vector<std::uint8_t>& needed,
                                   const Grid& grid, const Camera& camera, glm::ivec2 pictureSize,
                                   int firstRow, int rows);

}  // namespace haustra::render
