// The tube through which the colon is filled with gas.
#pragma once

#include "phantom/colon_path.h"
#include "phantom/structure.h"
#include "phantom/tube.h"

#include <optional>

namespace haustra::phantom {

/// A flexible tube of 9 mm from below the anus to 60…90 mm above it, and a retention balloon of 25
/// to 34 mm about it.
class RectalTube {
public:
    RectalTube(const ColonPath& path, std::uint64_t seed);

    struct Point {
        double outerMm = 1e9;  ///< signed distance to the device, negative inside
        double hu = 0.0;       ///< of what it is made of or holds here
    };
    /// What is at p, where the colon's lumen is `colonLumenMm` away: the balloon stays within it.
    Point at(glm::dvec3 p, double colonLumenMm) const;
    /// No part lies beyond.
    glm::dvec3 lowMm() const { return lowMm_; }
    glm::dvec3 highMm() const { return highMm_; }
    Structure::RectalTube structure() const;

private:
    Tube shaft_;
    glm::dvec3 balloonAt_{0.0}, balloonAxis_{0, 0, 1};
    double balloonRadiusMm_ = 0.0, balloonHalfLengthMm_ = 0.0;
    glm::dvec3 lowMm_{0.0}, highMm_{0.0};
};

}  // namespace haustra::phantom
