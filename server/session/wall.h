// The flattened wall of an open case, and questions about it.
#pragma once

#include "core/flat_lookup.h"
#include "core/result.h"
#include "render/wall/strip_painter.h"

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace haustra::session {

/// Where a camera's part of the wall lies in the strip.
struct WallRow {
    double arcMm = 0.0;  ///< of the camera, along the centerline
    double y = 0.0;      ///< circumferences from the rectum
};

/// Immutable; any number of threads.
struct Wall {
    std::shared_ptr<const FlatMap> map;
    std::string content;  ///< SHA-256 of the cut surface: what is kept of one wall is no other's
    FlatLookup lookup;
    double circumferenceMm = 0.0;  ///< √(area of the surface / area of the strip)
    /// Of the cameras that look at any vertex: the mean height of those, made monotone by least
    /// squares (pool adjacent violators; Barlow et al. 1972). Neither arc nor y falls; at least
    /// one.
    std::vector<WallRow> rows;
    std::shared_ptr<const render::StripPainter> painter;  ///< and its lines of sight
};

/// The map must be sound, as store::Case::readFlatMap gives it. Fails (badInput) where the surface
/// has no area, (device) where there is not enough memory. O(n log n): a few seconds for a million
/// triangles.
/// `bridged` as WallSight::of takes it.
Result<std::shared_ptr<const Wall>> makeWall(std::shared_ptr<const FlatMap> map,
                                             std::vector<std::uint8_t> bridged = {});

/// Which place of the wall is shown at a place in the strip, which must lie in it.
struct LocateInStrip {
    glm::dvec2 flat{0.0};
};
/// Which place of the wall is nearest to a patient point.
struct LocateInSpace {
    glm::dvec3 positionMm{0.0};
};
/// How long a line is, or how large an outline, drawn in the strip.
struct Measure {
    std::vector<glm::dvec2> points;
    bool closed = false;
};
using WallQuestion = std::variant<LocateInStrip, LocateInSpace, Measure>;

struct WallMeasure {
    double lengthMm = 0.0;                          ///< along the wall; of an outline, all around
    double straightMm = 0.0;                        ///< of a line, from its first to its last point
    double areaMm2 = 0.0, largestDiameterMm = 0.0;  ///< of an outline
};
using WallAnswer = std::variant<WallPlace, WallMeasure>;

/// Some microseconds for a place. A measurement crosses some hundred triangles a circumference;
/// within the protocol's bounds it takes at most about a second, and some milliseconds in use.
Result<WallAnswer> answer(const Wall& wall, const WallQuestion& question);

/// The place of the wall that a bookmark means, which its disc is around: the nearest within 2 mm
/// of where it stands, or else where its gaze first meets the wall, within 100 mm. Some
/// microseconds.
std::optional<WallPlace> markOf(const Wall& wall, glm::dvec3 positionMm, glm::dvec3 forward);

}  // namespace haustra::session
