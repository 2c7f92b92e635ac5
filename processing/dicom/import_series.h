// From a folder of DICOM files to one CT volume in Hounsfield units.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace haustra::dicom {

/// One CT series found in a folder. Holds nothing that identifies the patient.
struct SeriesSummary {
    std::string seriesUid;
    std::string description;
    int images = 0;
    glm::ivec2 matrix{0};
    PatientPosition position = PatientPosition::unknown;
};

struct ImportOptions {
    std::string
        seriesUid;  ///< empty: the only one; several without a choice is an error that lists them
    int threads = 0;
    Progress progress;
};

struct ImportedSeries {
    CtScan scan;
    SeriesSummary summary;
    /// What was corrected on the way (gantry tilt sheared back, spacing resampled …), for the log.
    std::vector<std::string> notes;
};

/// Series in `path` (a folder, searched to any depth, or one file), by SeriesInstanceUID.
Result<std::vector<SeriesSummary>> listSeries(const std::filesystem::path& path);

/// Reads one series whole. See the .cpp for the order of the checks.
Result<ImportedSeries> importSeries(const std::filesystem::path& path,
                                    const ImportOptions& options = {});

}  // namespace haustra::dicom
