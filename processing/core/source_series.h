// The DICOM series that a scan came from: what a report of it must refer to.
#pragma once

#include "core/grid.h"
#include "core/result.h"

#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// One slice as the scanner made it: an image file, or a frame of one.
struct SourceImage {
    std::string sopClassUid;
    std::string sopInstanceUid;
    int frame = 0;               ///< counted from 1; 0 where the file holds one image only
    glm::dvec3 positionMm{0.0};  ///< centre of its first pixel, LPS
    double thicknessMm = 0.0;    ///< 0 where the file does not say
    bool operator==(const SourceImage&) const = default;
};

/// Holds no patient's name or ID. What a file does not say, or not as DICOM wants it, is empty.
struct SourceSeries {
    std::string studyUid, seriesUid;
    /// Places of the scan are in it, whatever was resampled on the way; empty where the images do
    /// not agree on one.
    std::string frameOfReferenceUid;
    std::string studyDate, studyTime;  ///< YYYYMMDD; HHMMSS with or without a fraction
    PatientPosition position = PatientPosition::unknown;
    glm::dvec3 rowDirection{1, 0, 0}, columnDirection{0, 1, 0};  ///< orthogonal units, LPS
    glm::dvec2 pixelSpacingMm{1.0};  ///< between columns (x), between rows (y)
    /// Along row × column. Each slice once; scout views left out.
    std::vector<SourceImage> images;
    bool operator==(const SourceSeries&) const = default;
};

/// True for what DICOM takes as a UID (PS3.5 9.1): numbers and dots, at most 64 characters.
bool isUid(std::string_view text);
/// True for eight digits that are a date; for HH, HHMM, HHMMSS or HHMMSS.F… (PS3.5 6.2).
bool isDicomDate(std::string_view text);
bool isDicomTime(std::string_view text);

/// Most slices of a series that sourceSeriesOfJson reads.
inline constexpr int maxSourceImages = 50'000;

/// The `source` product, JSON:
///   {"study", "series", "frame_of_reference", "study_date", "study_time", "position",
///    "row", "column", "pixel_spacing_mm",
///    "images": [{"class", "instance", "frame", "position_mm", "thickness_mm"}, …]}
/// Places in LPS; "frame" where the file holds several. Ends with a new line.
std::string sourceSeriesJson(const SourceSeries& series);
/// Reads what sourceSeriesJson writes. Fails (badInput) where the text is none, a UID, a date or a
/// time is not DICOM's, or a number is out of any body's range.
Result<SourceSeries> sourceSeriesOfJson(const std::string& text,
                                        const std::string& place = "source");

}  // namespace haustra
