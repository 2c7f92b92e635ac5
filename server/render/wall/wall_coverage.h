// What of the wall has been on a reader's screen (dissertation §2.4).
#pragma once

#include "core/seen_limits.h"
#include "render/scene/picture.h"
#include "render/wall/wall_sight.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace haustra::render {

/// From where a camera shows a place of the wall, whatever the reader chooses.
struct SightLimits {
    /// The depth of field of a colonoscope, which the dissertation gives virtual cameras too (table
    /// 2.1 and §2.4).
    double nearestMm = 3.0, farthestMm = 100.0;
    /// Between the line of sight and the wall's normal: there the wall is foreshortened to a
    /// quarter, and a polyp of 6 mm, the smallest that is reported (C-RADS; Zalis et al. 2005), to
    /// 1.5 mm. The dissertation counts whatever meets a ray.
    double mostAngleDegrees = 75.0;
};
inline constexpr SightLimits sightLimits{};

/// So much of a picture the eye takes in at a time: a field of 5° across, the distance of fixations
/// at which nothing is passed over (Kundel et al. 1991), at 60 cm from pixels of 0.25 mm.
inline constexpr std::int64_t eyeFieldPixels = 35'000;

/// How long each triangle of a flat map's wall has been on one reader's screen. A camera's picture
/// shows a triangle whose middle lies in it, within sightLimits, at least limits.pixelsPerMm large
/// by the pixels in the picture's middle, and nothing of the wall stands before it. A picture of
/// the strip shows a triangle whose middle lies in it, as large by the direction in which the map
/// shrinks it the most. Unlike a count of rays that meet it, this leaves no holes where triangles
/// are smaller than pixels.
///
/// A camera's picture counts with all the time that it is on screen: the eye follows the flight,
/// and what comes near stays in the picture. In a strip it wanders: of its pictures' time each
/// place has the part that eyeFieldPixels is of theirs, so that a strip at which one glances is not
/// one that has been read.
///
/// A bridge's triangles are no wall: they are never seen, and no part of the share. Single
/// triangles between seen ones count as seen (withoutSingles). Belongs to one thread.
class WallCoverage {
public:
    /// The limits have passed their check.
    WallCoverage(std::shared_ptr<const WallSight> sight, const SeenLimits& limits);

    /// A picture of `size` pixels has been on screen for so long: a Camera's, a FlatWindow's or the
    /// WholeStrip, which have passed their checks; other views show nothing of the wall. Returns to
    /// how many triangles that were not shown for long enough it has added. A microsecond for each
    /// triangle within a camera's reach that has not been; of the picture that was shown last, of
    /// its kind, nothing is looked for again.
    int show(const ViewState& shown, glm::ivec2 size, std::int64_t microseconds);
    /// Adds what was kept of a former session (times()). Sizes must fit.
    void add(std::span<const std::uint32_t> times);
    /// Nothing has been shown.
    void forget();

    const SeenLimits& limits() const { return limits_; }
    /// µs on screen of each triangle, up to what is long enough, from which on none is added.
    const std::vector<std::uint32_t>& times() const { return times_; }
    std::uint32_t enough() const { return enough_; }
    /// 0 or 1 each: which have been on screen for long enough.
    std::vector<std::uint8_t> shownTriangles() const;
    /// 0 or 1 each: which count as seen, singles too. O(n).
    std::vector<std::uint8_t> seenTriangles() const;
    /// Of the wall's area, 0…1: 1 only where every triangle with an area counts as seen. O(n) once
    /// after what changes it.
    double share() const;
    const WallSight& sight() const { return *sight_; }

private:
    /// Triangles that lie close to each other, in a ball.
    struct Cell {
        glm::vec3 middleMm{0.0f};
        float radiusMm = 0.0f;
        std::vector<int> unshown;
    };
    struct Picture {
        ViewState shown;
        glm::ivec2 size{0};
        std::vector<int> triangles;  // that it showed, and that had not been seen by then
    };
    void makeCells();
    void collect(const Camera& camera, glm::ivec2 size, std::vector<int>& triangles);
    void collect(const FlatWindow& window, glm::ivec2 size, std::vector<int>& triangles);
    void collect(const WholeStrip& strip, glm::ivec2 size, std::vector<int>& triangles);
    void collectLarge(double pixelsPerUnit, const FlatWindow* window, glm::ivec2 size,
                      std::vector<int>& triangles);
    bool isShown(int triangle) const { return times_[std::size_t(triangle)] >= enough_; }

    std::shared_ptr<const WallSight> sight_;
    const SeenLimits limits_;
    const std::uint32_t enough_;
    std::vector<Cell> cells_;  // made when the first picture is shown
    std::vector<std::uint32_t> times_;
    std::array<Picture, std::variant_size_v<ViewState>> last_;  // of each kind
    mutable std::optional<double> share_;                       // as long as times_ are the same
};

}  // namespace haustra::render
