// Electronic biopsy: what lies beneath the wall, as a translucent colour (dissertation §6.2.4).
#pragma once

#include "cad/fours.h"
#include "cad/smooth_scan.h"
#include "core/optics.h"
#include "core/volume.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

/// Rays run 0.5 mm a step, and look no deeper than about 20 mm (§6.2.4).
inline constexpr double biopsyStepMm = 0.5;
inline constexpr int biopsySteps = 40;
/// How far behind the surface a ray's peak is looked for.
inline constexpr double peakMm = 5.0;

/// A transfer function for one step of a biopsy ray, by whole HU. Unlit: the picture is of the
/// tissue, not of a lamp.
class BiopsyTable {
public:
    explicit BiopsyTable(const TransferFunction& transferFunction);

    /// Of one step: red, green and blue, linear light, times the opacity, and the opacity.
    const FourFloats& at(float hu) const {
        const int n = int(hu) - lowestHu;
        return entries_[std::size_t(n < 0                       ? 0
                                    : n >= int(entries_.size()) ? int(entries_.size()) - 1
                                                                : n)];
    }

private:
    static constexpr int lowestHu = -1024;
    std::vector<FourFloats> entries_;
};

/// What one ray saw.
struct BiopsyRay {
    glm::vec3 color{0.0f};  ///< linear light, over black
    float opacity = 0.0f;
    float tissueMm = 0.0f;  ///< until the ray ended; the whole way where nothing ended it
    bool reenters = false;  ///< the lumen began again
    /// The greatest within peakMm of where it begins: a wall thinner than the scan resolves has
    /// less than its tissue's, a thickened one all of it.
    float peakHu = -1024.0f;
};

/// The scan, and where its lumen is, as rays see them. Both outlive it.
struct BiopsyScan {
    const SmoothScan& scan;
    const Volume<std::uint8_t>& lumen;  ///< LumenLabel
    double airBelowHu = -400.0;         ///< tissue ends where the scan is darker
};

/// What is wanted of a ray: its colour alone, or what lies behind it too.
enum class RayEnd { opaque, lumen };

/// Front to back from `startMm` on the wall along the unit vector `intoWall`. It ends where it
/// would enter the lumen again after it has been in tissue, or has met none within 1.5 mm, or,
/// where no more is wanted, where it is opaque.
BiopsyRay castBiopsyRay(const BiopsyScan& scan, const BiopsyTable& table, glm::dvec3 startMm,
                        glm::dvec3 intoWall, RayEnd end = RayEnd::lumen);

}  // namespace haustra::cad
