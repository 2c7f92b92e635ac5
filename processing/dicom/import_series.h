// From a folder of DICOM files to one CT volume in Hounsfield units.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/source_series.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace haustra::dicom {

/// One CT series found in a folder. Holds nothing that identifies the patient.
struct SeriesSummary {
    std::string studyUid;  ///< may be empty
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
    /// What a report of the scan refers to. Without images where there are more than
    /// maxSourceImages.
    SourceSeries source;
    /// What was corrected on the way (gantry tilt sheared back, spacing resampled …), for the log.
    std::vector<std::string> notes;
};

/// CT series in `path` (a folder, searched to any depth, or one file), by SeriesInstanceUID. Reads
/// headers only. Fails where the path cannot be read; files that are not CT images are passed over.
Result<std::vector<SeriesSummary>> listSeries(const std::filesystem::path& path);

/// The series that importSeries would read with these options, of which threads count here. Reads
/// headers only; fails where the series cannot be chosen, or a file of it is damaged.
Result<SeriesSummary> findSeries(const std::filesystem::path& path, const ImportOptions& options);

/// Reads one CT series whole: classic or enhanced multi-frame, any transfer syntax that DICOM has
/// for still images but JPEG XL and HTJ2K; files in any order, any folder, under any name.
///
/// The volume is in HU; pixels outside the field of view are −1024. Its third axis runs along the
/// slices' normal (row × column), so that the affine is right-handed. A gantry tilt is sheared
/// back, which widens the slices to hold every one; spacing that varies is resampled; both are
/// noted.
///
/// Fails, naming the file and the reason, rather than give a volume that is wrong: a slice missing,
/// two at one place, orientation, matrix or spacing that differ, damaged or truncated files of the
/// series (or of a series that cannot be told), no CT image, several series without a choice. Scout
/// views are left out.
///
/// Peak memory: the volume and a few slices; twice the volume where the spacing varies. Time: one
/// read of the files, decoded on `threads` threads; the result does not depend on their number.
/// Thread-safe.
Result<ImportedSeries> importSeries(const std::filesystem::path& path,
                                    const ImportOptions& options = {});

}  // namespace haustra::dicom
