// What the phantom's bowel is in truth as a chain of stretches: collapses, contacts between loops,
// the valve. By it the junctions that a segmentation finds are judged, not its voxels alone.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::phantom {

/// Arcs are of the true centerline, mm from the anus.
struct Structure {
    /// A stretch where the true lumen is closed.
    struct Collapse {
        double beginMm = 0.0, endMm = 0.0;
        glm::dvec3 beginAtMm{0.0}, endAtMm{0.0};
        double lengthMm() const { return endMm - beginMm; }
    };
    /// A place where two loops that do not join there have their lumens less than contactMm apart.
    struct Contact {
        bool ileum = false;  ///< of colon and ileum; or of two loops of colon
        double arcMm = 0.0;
        double otherArcMm = 0.0;  ///< of the other loop; of the ileum from the valve
        glm::dvec3 positionMm{0.0};
        double leastMm = 0.0;  ///< tissue between them where it is thinnest
        double areaMm2 = 0.0;  ///< about
    };
    struct Valve {
        glm::dvec3 positionMm{0.0};
        glm::dvec3 inward{0.0};  ///< unit, into the cecum
        double arcMm = 0.0;
        bool open = false;
    };
    /// The tube through which gas was blown in: a shaft along an axis, and a balloon about it.
    struct RectalTube {
        std::vector<glm::dvec3> axisMm;  ///< from below the anus to the tip
        double shaftRadiusMm = 0.0;
        glm::dvec3 balloonMm{0.0};  ///< its middle
        double balloonRadiusMm = 0.0, balloonHalfLengthMm = 0.0;
    };
    struct Pouch {
        glm::dvec3 positionMm{0.0};
        double diameterMm = 0.0;
    };

    std::vector<Collapse> collapses;
    std::vector<Contact> contacts;  ///< the largest first
    std::optional<Valve> valve;
    std::optional<RectalTube> rectalTube;
    std::vector<Pouch> diverticula;
    /// Where rectum, sigmoid, descending, transverse, ascending colon and cecum end.
    std::array<double, 6> segmentEndsMm{};
    double ileumMm = 0.0;                                  ///< length of the gas-filled ileum
    double airMl = 0.0, taggedMl = 0.0, untaggedMl = 0.0;  ///< of the colon's lumen
    double ileumMl = 0.0;
};

inline constexpr std::array<const char*, 6> segmentNames{"rectum",     "sigmoid",   "descending",
                                                         "transverse", "ascending", "cecum"};
inline constexpr double contactMm = 4.0;

}  // namespace haustra::phantom
