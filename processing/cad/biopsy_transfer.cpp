#include "cad/biopsy_transfer.h"

#include "cad/wall_evidence.h"

#include <algorithm>

namespace haustra::cad {
namespace {

// What the fixed one was made for.
constexpr double usualFatHu = -100.0, usualWallHu = 40.0;

}  // namespace

TransferFunction fixedBiopsyTransfer() {
    return {{{-250, {0.1, 0.2, 0.95}, 0.0},
             {-150, {0.1, 0.25, 0.95}, 0.02},
             {-30, {0.1, 0.45, 0.9}, 0.04},
             {20, {0.1, 0.85, 0.3}, 0.08},
             {60, {0.2, 0.9, 0.15}, 0.12},
             {100, {0.95, 0.25, 0.1}, 0.3},
             {160, {0.95, 0.05, 0.05}, 0.4},
             {220, {0.95, 0.05, 0.05}, 0.0}}};
}

TransferFunction automaticBiopsyTransfer(const WallStatistics& statistics) {
    TransferFunction transfer = fixedBiopsyTransfer();
    const double stretch =
        std::clamp((statistics.wallHu - statistics.fatHu) / (usualWallHu - usualFatHu), 0.5, 2.0);
    // Green ends 20 HU above the wall; noise must not reach it.
    const double widen = std::max(0.0, 2.0 * statistics.noiseHu - 20.0 * stretch);
    for (TransferFunctionPoint& point : transfer.points) {
        point.hu = statistics.wallHu + stretch * (point.hu - usualWallHu) +
                   (point.hu > usualWallHu ? widen : 0.0);
    }
    return transfer;
}

}  // namespace haustra::cad
