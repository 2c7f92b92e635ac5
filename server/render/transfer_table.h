// A transfer function as the ray caster looks it up.
#pragma once

#include "render/view.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// Entries at equal HU distances from the first point to the last; between entries the GPU
/// interpolates. Colours are linear light, not multiplied by opacity; opacity is for one step.
struct TransferTable {
    static constexpr int entries = 4096;
    std::vector<glm::vec4> rgba;
    double firstHu = 0.0, lastHu = 1.0;
    /// Only values strictly between these can have opacity (±infinity where the ends have).
    double visibleAboveHu = 0.0, visibleBelowHu = 0.0;
    /// Entries below i that have opacity: visibleBefore[0] = 0 … visibleBefore[entries].
    std::vector<int> visibleBefore;

    /// Whether any value of [lowHu, highHu] has opacity. Errs to yes by at most one entry.
    bool anyVisible(double lowHu, double highHu) const;
};

/// Opacity for a step of stepMm from opacity a for 1 mm: 1 − (1 − a)^stepMm. The transfer function
/// must have passed its check.
TransferTable makeTransferTable(const TransferFunction& transferFunction, double stepMm);

}  // namespace haustra::render
