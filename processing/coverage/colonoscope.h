// What a colonoscope's picture shows: its lens, the part of the picture that is open, and the depth
// of field (dissertation §2.3 to §2.5).
#pragma once

#include "coverage/fisheye_lens.h"

#include <string>

namespace haustra::coverage {

/// A picture's largest side, pixels: of each a direction is kept.
inline constexpr int mostScopePixels = 4096;

struct Colonoscope {
    std::string name;
    FisheyeLens lens;
    glm::ivec2 pictureSize{0};  ///< pixels
    /// The open part of the picture: an ellipse with its axes along the picture's, cut by the
    /// picture's border, which makes the octagon of a real screen.
    glm::dvec2 openCenter{0.0}, openRadii{0.0};  ///< pixels
    double fieldDegrees = 0.0;                 ///< whole angle; rays beyond half of it show nothing
    double nearestMm = 0.0, farthestMm = 0.0;  ///< depth of field, from the lens along the ray
    double tipRadiusMm = 0.0;                  ///< the lens stays at least this far from the wall
    bool operator==(const Colonoscope&) const = default;
};

/// Olympus CF-Q160L as the dissertation calibrated it (table 2.1 and §2.5): 140°, 3 to 100 mm, a
/// tip of 12.8 mm, so that the lens stays 6.4 mm from the wall; r(θ) = 13.5747θ − 2.2982θ³, m =
/// (25.5903, 25.6), centre (274.2596, 220.6445), a picture of 525×440 open within the ellipse about
/// (267.05, 215.01) of radii 309.08 and 294.92.
Colonoscope olympusCfQ160l();

/// The unit direction that a pixel of a colonoscope shows in the camera's frame (x right, y down, z
/// forward); none where its picture is dark.
std::optional<glm::dvec3> directionOf(const Colonoscope& scope, glm::dvec2 pixel);

}  // namespace haustra::coverage
