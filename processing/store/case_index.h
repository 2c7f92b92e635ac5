// case.json: which scan a case is of, and which file holds each of its products.
#pragma once

#include "core/result.h"
#include "store/case_store.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haustra::store {

inline constexpr char caseIndexName[] = "case.json";

struct CaseIndex {
    std::optional<ScanIdentity> scan;    ///< none where nothing has bound the case
    std::vector<ProductEntry> products;  ///< sorted by product
};

/// Empty where the case has no index yet. Fails where the index is not what writeCaseIndex writes:
/// a file name that leaves the folder is refused here.
Result<CaseIndex> readCaseIndex(const std::filesystem::path& caseFolder);

/// Publishes the index durably.
Result<void> writeCaseIndex(const std::filesystem::path& caseFolder, const CaseIndex& index);

}  // namespace haustra::store
