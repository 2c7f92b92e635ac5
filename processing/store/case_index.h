// case.json: which file holds each product of a case.
#pragma once

#include "core/result.h"
#include "store/case_store.h"

#include <filesystem>
#include <string>
#include <vector>

namespace haustra::store {

inline constexpr char caseIndexName[] = "case.json";

/// The entries sorted by product; none where the case has no index yet. Fails where the index is
/// not what writeCaseIndex writes: a file name that leaves the folder is refused here.
Result<std::vector<ProductEntry>> readCaseIndex(const std::filesystem::path& caseFolder);

/// Publishes the index durably.
Result<void> writeCaseIndex(const std::filesystem::path& caseFolder,
                            const std::vector<ProductEntry>& entries);

}  // namespace haustra::store
