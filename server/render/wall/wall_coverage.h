// Which of the wall has been shown to a reader (dissertation §2.4).
#pragma once

#include "render/scene/picture.h"
#include "render/wall/wall_sight.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace haustra::render {

/// When a camera shows a place of the wall well enough for it to count as seen.
struct SeenLimits {
    /// The depth of field of a colonoscope, which the dissertation gives virtual cameras too (table
    /// 2.1 and §2.4).
    double nearestMm = 3.0, farthestMm = 100.0;
    /// Between the line of sight and the wall's normal: there the wall is foreshortened to a
    /// quarter, and a polyp of 6 mm, the smallest that is reported (C-RADS; Zalis et al. 2005), to
    /// 1.5 mm. The dissertation counts whatever meets a ray.
    double mostAngleDegrees = 75.0;
    /// What a pixel may span: 6 mm are at least three of them.
    double mostPixelMm = 2.0;
};
inline constexpr SeenLimits seenLimits{};

/// What one reader has been shown of a flat map's wall, triangle by triangle. A triangle is seen
/// from a camera where its middle lies in the picture, within seenLimits, faces the camera, and
/// nothing of the wall stands before it. Unlike a count of rays that meet it, this leaves no holes
/// where triangles are smaller than pixels, and the size of pictures enters by mostPixelMm alone.
/// A bridge's triangles are no wall: they are never seen, and no part of the share.
/// Belongs to one thread.
class WallCoverage {
public:
    explicit WallCoverage(std::shared_ptr<const WallSight> sight);

    /// A picture of `size` pixels by this camera has been shown; both must have passed their
    /// checks. Returns how many triangles it has shown for the first time. A microsecond for each
    /// triangle within reach that has not been seen yet: a millisecond in a colon.
    int show(const Camera& camera, glm::ivec2 size);
    /// Nothing has been seen.
    void forget();

    bool seen(int triangle) const { return seen_[std::size_t(triangle)] != 0; }
    const std::vector<std::uint8_t>& seenTriangles() const { return seen_; }  ///< 0 or 1
    /// Of the wall's area, 0…1: 1 only where every triangle with an area has been seen.
    double share() const;
    const WallSight& sight() const { return *sight_; }

private:
    /// Triangles that lie close to each other, in a ball.
    struct Cell {
        glm::vec3 middleMm{0.0f};
        float radiusMm = 0.0f;
        std::vector<int> unseen;
    };
    void makeCells();

    std::shared_ptr<const WallSight> sight_;
    std::vector<Cell> cells_;
    std::vector<std::uint8_t> seen_;
    std::size_t unseenTriangles_ = 0;
    double unseenMm2_ = 0.0;
};

}  // namespace haustra::render
