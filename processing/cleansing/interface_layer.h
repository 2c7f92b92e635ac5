// Where air lies straight on tagged material.
#pragma once

#include "cleansing/local_means.h"
#include "cleansing/point_spread.h"
#include "core/ct_scan.h"

namespace haustra::cleansing {

/// Tells air on tagged material from a wall between the two. Both pass through soft tissue's HU; a
/// wall takes longer to do so. Along the gradient from air to tagging a bare interface is one step
/// of the scanner's blur, and the way between two of its heights is longer by a wall's thickness.
/// Holds references to what it is made of.
class InterfaceLayer {
public:
    InterfaceLayer(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                   const LocalMeans& means, const PointSpread& spread, glm::dvec3 gravity);

    /// The way from air to tagging through a voxel.
    struct Crossing {
        double bareness = 0.0;  ///< 0…1: how surely the voxel lies in the blur of a bare interface
        bool level = false;     ///< down is within 50° of the way
        glm::ivec3 tagged{0};   ///< the voxel of tagging at its end
    };
    Crossing crossing(glm::ivec3 voxel, double taggedHu, double softHu) const;

    /// Crossing::bareness. Thread-safe, as crossing() is.
    double bareness(glm::ivec3 voxel, double taggedHu, double softHu) const {
        return crossing(voxel, taggedHu, softHu).bareness;
    }

    const PointSpread& spread() const { return spread_; }

private:
    /// Length of the way from air to tagging through a voxel, mm, and that of a bare step of unit
    /// blur; negative where there is none.
    struct Step {
        double lengthMm = -1.0, unitLength = 1.0;
        glm::dvec3 direction{0.0};  ///< unit, along the grid's axes
        bool level = false;
        glm::ivec3 tagged{0};
    };
    Step stepThrough(glm::ivec3 voxel, double taggedHu, double softHu) const;

    const Volume<std::int16_t>& hu_;
    const Volume<std::uint8_t>& segmentation_;
    const LocalMeans& means_;
    glm::dvec3 spacingMm_;
    glm::dvec3 down_;  ///< gravity along the grid's axes; zero where unknown
    const PointSpread& spread_;
};

}  // namespace haustra::cleansing
