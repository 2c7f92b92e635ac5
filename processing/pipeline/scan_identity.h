// Which scan files hold, and what a case of it is called.
#pragma once

#include "core/result.h"
#include "store/case_store.h"

#include <filesystem>
#include <string>

namespace haustra::pipeline {

/// Of a DICOM series its UIDs, and a key made from them: the same however often and in whatever
/// company the series is sent. Of a NIfTI file, which has no UID, `content` alone: sourceKey of the
/// file. Reads headers only. Fails where the series cannot be chosen (dicom/import_series.h).
Result<store::ScanIdentity> identifyScan(const std::filesystem::path& series,
                                         const std::string& seriesUid,
                                         const store::ProductKey& content, int threads);

/// One series (of one study), however often it came.
bool sameScan(const store::ScanIdentity& a, const store::ScanIdentity& b);

/// Twelve hexadecimal digits that stand for a study where its UID would be long and is not to be
/// shown: of SHA-256. Empty where there is no UID.
std::string studyCode(const std::string& studyUid);

/// A case name that only this scan has, and no patient's name is in: "STUDYCODE.SERIES" where there
/// are UIDs, so that a study's scans are listed together, else "scan-CONTENT".
std::string defaultCaseName(const store::ScanIdentity& scan);

}  // namespace haustra::pipeline
