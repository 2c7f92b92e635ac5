// Finding the DICOM files under a path and picking one CT series among them.
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "dicom/image_header.h"
#include "dicom/import_series.h"

#include <filesystem>
#include <string>
#include <vector>

namespace haustra::dicom {

/// The CT images of one series, scout views left out where there are others.
struct Series {
    SeriesSummary summary;
    std::vector<ImageHeader> images;
    int localizers = 0;              ///< scout views left out
    std::vector<Error> damaged;      ///< files of this series that cannot be read
    std::vector<std::string> notes;  ///< for a person; of a series that was chosen
};

struct FoundSeries {
    std::vector<Series> series;  ///< by seriesUid
    /// Damaged DICOM files of no known series.
    std::vector<Error> damaged;
    /// Why a single file that was asked for, or the first DICOM object found, is no CT image.
    std::vector<Error> others;
    /// Files that are not DICOM, where there are others.
    std::vector<std::filesystem::path> strangers;
};

/// Reads the headers of all files at or below `path`, in parallel. Fails as filesBelow does.
Result<FoundSeries> findSeries(const std::filesystem::path& path, int threads,
                               const Progress& progress);

/// The series with `seriesUid`; where that is empty the only one, or the only one of at least 16
/// images. Fails where there is none, several (listing them), where the chosen one, or a series
/// unknown, has a damaged file, where a file beside its own that is named alike is no DICOM, and
/// where its images are of several studies or patient positions.
Result<Series> chooseSeries(FoundSeries found, const std::string& seriesUid,
                            const std::filesystem::path& path);

}  // namespace haustra::dicom
