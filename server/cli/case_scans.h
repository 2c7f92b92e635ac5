// A case's scans as pictures are drawn from them.
#pragma once

#include "core/result.h"
#include "core/volume.h"
#include "store/case_store.h"

#include <cstdint>

namespace haustra::cli {

struct CaseScans {
    Volume<std::int16_t> ct;
    Volume<std::int16_t> cleansed;  ///< empty where it is not drawn
};

/// What rays are cast into: the cleansed scan. A case without one is drawn as it was scanned, and a
/// note on stderr says so; where `cleansedIsAsked`, this fails instead.
Result<CaseScans> readCaseScans(const store::Case& source, bool cleansedIsAsked);

}  // namespace haustra::cli
