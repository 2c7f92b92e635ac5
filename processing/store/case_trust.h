// What a reader must know of a case before anything of it is seen.
#pragma once

#include "core/colon_record.h"
#include "core/result.h"
#include "store/case_store.h"

namespace haustra::store {

/// What the case's `quality` says, and, as the first warnings, that its scan is coarse
/// (core/scan_coarseness.h), the pieces of the colon that its centerline passes by, where it has
/// one, and what its cleansed lumen and its flat map warn of: of their attributes `notes` the lines
/// "warning: …". Fails where the case has no quality or a product cannot be read, but for its
/// series.
Result<ColonTrust> readTrust(const Case& source);

}  // namespace haustra::store
