// How the scanner blurs, along each axis.
#pragma once

#include "cleansing/local_means.h"
#include "core/ct_scan.h"

#include <glm/glm.hpp>

namespace haustra::cleansing {

/// A Gaussian ellipsoid along the grid's axes.
struct PointSpread {
    glm::dvec3 sdMm{0.5};       ///< standard deviations along i, j, k
    glm::dvec3 spacingMm{0.0};  ///< of the voxels that lines are drawn through

    /// Standard deviation of the blur of a flat face with this unit normal.
    double acrossMm(glm::dvec3 normal) const { return glm::length(normal * sdMm); }
    /// The same as lines drawn by linear interpolation show it, which blurs by a tent as wide as
    /// two voxels: it adds h²/6 to the variance.
    double drawnMm(glm::dvec3 normal) const {
        return glm::length(normal * glm::sqrt(sdMm * sdMm + spacingMm * spacingMm / 6.0));
    }
};

/// Measured on the scan's own faces of gas, to contents and to wall, that a line along an axis
/// crosses within 32° of their normal. Its two samples about the half height, as quantiles of the
/// normal distribution, lie a sample's distance over the step's standard deviation apart: of each
/// axis' lines the median counts, each line weighing as its noise lets it, turned to the normal.
/// Three axes give three equations in the squares. An axis with fewer than 200 lines takes what the
/// others have, and 0.5 mm where none has. O(voxels); the same for any number of threads.
PointSpread measurePointSpread(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                               const LocalMeans& means, int threads);

}  // namespace haustra::cleansing
