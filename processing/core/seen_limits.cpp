#include "core/seen_limits.h"

namespace haustra {

Result<void> checkSeenLimits(const SeenLimits& limits) {
    if (!(limits.pixelsPerMm >= leastSeenPixelsPerMm && limits.pixelsPerMm <= mostSeenPixelsPerMm))
        return fail(ErrorKind::badInput, "a millimetre of wall has 0.01 to 100 pixels", "seen");
    if (limits.leastMs < 0 || limits.leastMs > mostSeenMs)
        return fail(ErrorKind::badInput, "a place is looked at for 0 to 60000 ms", "seen");
    return {};
}

}  // namespace haustra
