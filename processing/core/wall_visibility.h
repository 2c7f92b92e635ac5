// How much of each triangle of a wall simulated pictures have shown (dissertation §2.3, §2.4): the
// words that rays on the CPU and the raster on a GPU share.
#pragma once

#include "core/centerline.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace haustra {

/// Of one triangle, over all pictures: the most that any one of them has shown. A picture shows a
/// triangle fully where all the pixels that the triangle would cover if it stood alone
/// (N_total > 0) see it first (N_observed = N_total), partly where some do. A triangle is observed
/// unless it is unseen.
enum class Visibility : std::uint8_t { unseen, partly, fully };

/// A camera of virtual colonoscopy: a square pinhole picture. Pixels see through their centres.
struct PinholePicture {
    double fovDegrees = 90.0;
    /// Pixels of a side. A pixel of 512 spans 0.4 mm at the far end of the depth of field: less
    /// than the triangles that it is to tell apart.
    int side = 512;
    /// Depth of field along each ray, that of the source's colonoscope. What is nearer hides what
    /// lies behind it and does not count as seen.
    double nearestMm = 3.0, farthestMm = 100.0;
};

/// The more of both, triangle by triangle. Sizes must be equal.
inline void addSeen(std::vector<Visibility>& sum, const std::vector<Visibility>& more) {
    for (std::size_t n = 0; n < sum.size(); ++n)
        if (more[n] > sum[n]) sum[n] = more[n];
}

}  // namespace haustra
