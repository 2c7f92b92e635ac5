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

/// Measured on the scan's own faces between gas and contents or wall, where a line along an axis
/// crosses them within 32° of their normal. A blurred step is the normal distribution function, so
/// two samples a distance h apart, about the half height, whose heights (0…1) have the quantiles
/// q₁ < q₂, give its standard deviation along the line, h / (q₂ − q₁), and along the normal n, h
/// |n_axis| / (q₂ − q₁). The median over an axis' lines counts, each line weighted by the inverse
/// of its variance. It is √Σ (n_a σ_a)² for a line's normal, so that the three axes give three
/// equations in the squares σ_a². An axis with fewer than 200 lines takes the others' value, or
/// 0.5 mm where none has enough. O(voxels); the same for any number of threads.
PointSpread measurePointSpread(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                               const LocalMeans& means, int threads);

}  // namespace haustra::cleansing
