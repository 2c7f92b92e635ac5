// A transfer function as raycasters look it up; shaders/optics.glsl says how.
#pragma once

#include "render/optics/optics.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// Entries at equal HU distances from the first point to the last (of the first and last row, the
/// widest); raycasters interpolate linearly between entries, and beyond the ends the end entries go
/// on. Colours are linear light, not multiplied by opacity.
struct TransferTable {
    static constexpr int entries = 4096;
    /// Of a 2-D transfer function: rows at equal gradient magnitudes, from 0 on.
    static constexpr int gradientRows = 128;

    /// Row by row, `entries` each. Opacity is for one step (emissionAbsorption) or for 1 mm.
    std::vector<glm::vec4> rgba;
    int rows = 1;                        ///< or gradientRows
    double lastRowHuPerMm = 0.0;         ///< magnitude of the last row
    double firstHu = 0.0, lastHu = 1.0;  ///< of the first and the last entry

    /// For pre-integration [Engel et al. 2001], else empty: at entry i the integral over entries
    /// 0…i of (colour × extinction, extinction), where extinction −ln(1 − opacity of one step) is
    /// of light that passes one step at that value. A segment one step long between values at
    /// entries a and b has the optical depth (I(b) − I(a)).a / (b − a), the opacity 1 − e^−depth,
    /// and the mean colour (I(b) − I(a)).rgb / (I(b) − I(a)).a. Opacity 1 counts as 1 − 2⁻¹⁴ a mm.
    std::vector<glm::vec4> integrals;
    /// What the integral grows by per entry before entry 0 and after the last.
    glm::vec4 integralBelow{0.0f}, integralAbove{0.0f};

    /// Only values strictly between these can show: have opacity (emissionAbsorption), be the
    /// greatest of a ray that shows something (maximumIntensity), or be hit (firstHit). ±infinity
    /// where the ends can. A segment can show only if its greater end is above the first and its
    /// smaller end below the second.
    double visibleAboveHu = 0.0, visibleBelowHu = 0.0;
    /// Entries below i that can show in some row: visibleBefore[0] = 0 … visibleBefore[entries].
    std::vector<int> visibleBefore;

    /// Whether any value of [lowHu, highHu] can show, or any segment between two of them. Errs to
    /// yes by at most two entries.
    bool anyVisible(double lowHu, double highHu) const;

    /// HU to entry, a fraction between two; not clamped.
    double entryOf(double hu) const { return (hu - firstHu) * (entries - 1) / (lastHu - firstHu); }
};

/// For steps of stepMm: opacity a for 1 mm becomes 1 − (1 − a)^stepMm under emissionAbsorption and
/// stays as it is under the others, which know no step. The optics must have passed checkOptics.
/// Under a millisecond; a 2-D one some 30 ms. Any thread.
TransferTable makeTransferTable(const Optics& optics, double stepMm);

}  // namespace haustra::render
