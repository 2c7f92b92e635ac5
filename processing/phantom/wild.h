// A patient who has a bit of everything.
#pragma once

#include "phantom/phantom.h"

namespace haustra::phantom {

/// The options of the `wild` preset: of standard or hard, and of all that
/// BowelOptions and ScanOptions can add, what the seed draws. Position, size and threads are the
/// default ones; the draw does not depend on them, so a seed is one patient in every position.
PhantomOptions wildOptions(std::uint64_t seed);

}  // namespace haustra::phantom
