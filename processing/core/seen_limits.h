// When a place of the wall counts as seen, as far as a reader may choose it.
#pragma once

#include "core/result.h"

namespace haustra {

struct SeenLimits {
    /// Pixels that a millimetre of wall across the line of sight must have in the picture. A polyp
    /// of 6 mm, the smallest that is reported (C-RADS; Zalis et al. 2005), then has four across:
    /// the two cycles at which 95 % of observers detect that something is there, twice as many as
    /// for half of them (Johnson 1958).
    double pixelsPerMm = 2.0 / 3.0;
    /// How long pictures that show it must have been on screen, all together: one fixation of the
    /// eye, 200 ms of pause and 50 to 100 ms to take in (Salthouse and Ellis 1980).
    int leastMs = 300;
    bool operator==(const SeenLimits&) const = default;
};
inline constexpr double leastSeenPixelsPerMm = 0.01, mostSeenPixelsPerMm = 100.0;
inline constexpr int mostSeenMs = 60'000;

/// Missed patches from this area on are worth a look: with them seen, of the wall 98 % are (Kreeger
/// et al. 2002; dissertation §2.5).
inline constexpr double leastMissedMm2 = 300.0;

/// Fails (badInput), saying which is out of its bounds: pixels 0.01…100 a mm, 0…60 000 ms.
Result<void> checkSeenLimits(const SeenLimits& limits);

}  // namespace haustra
