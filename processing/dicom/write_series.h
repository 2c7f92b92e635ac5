// A CT volume as a DICOM series, one file a slice.
#pragma once

#include "core/ct_scan.h"
#include "core/result.h"

#include <filesystem>
#include <string>

namespace haustra::dicom {

struct WriteOptions {
    std::string patientName = "HAUSTRA^PHANTOM";
    std::string patientId = "PHANTOM";
    std::string seriesDescription;
    /// Seeds the UIDs, so that the same phantom is the same files byte for byte.
    std::string uidSeed;
};

/// Writes `directory`/0001.dcm … (explicit little endian, 16-bit signed, slope 1). The grid must be
/// orthogonal.
Result<void> writeSeries(const std::filesystem::path& directory, const CtScan& scan,
                         const WriteOptions& options);

}  // namespace haustra::dicom
