// What the client knows of the flattened colon: its strip, places on the wall, measurements.
#pragma once

#include "core/strip_layout.h"

#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::reader {

/// The flattened colon as the server describes it: x around the colon in circumferences, periodic,
/// y from 0 at the rectum to `height` at the cecum.
struct FlatStrip {
    struct Row {
        double arcMm = 0.0, y = 0.0;
    };
    double height = 1.0;
    double circumferenceMm = 1.0;  ///< on average
    std::vector<Row> rows;         ///< rectum to cecum, neither falling; at least one

    /// The row of the wall around a place of the path, and the other way, by interpolation; held
    /// at both ends.
    double yAtArc(double arcMm) const;
    double arcAtY(double y) const;
};

/// One place of the wall: in the strip, in the patient, and the camera that looks at it.
struct WallPlace {
    std::optional<glm::dvec2> flat;  ///< none where the case has no strip, or this lies beside it
    glm::dvec3 positionMm{0.0};
    std::uint32_t triangle = 0;  ///< of the closed surface, where there is one
    double arcMm = 0.0;          ///< of the camera, along the path
    glm::dvec3 cameraMm{0.0};
};

/// A line or an outline drawn in the strip, measured on the surface in space.
struct FlatMeasure {
    double lengthMm = 0.0;                          ///< along the wall; of an outline, all around
    double straightMm = 0.0;                        ///< of a line: from end to end through space
    double areaMm2 = 0.0, largestDiameterMm = 0.0;  ///< of an outline
};

}  // namespace haustra::reader
