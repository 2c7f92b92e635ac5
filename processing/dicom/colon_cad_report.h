// Findings of polyps as a DICOM Colon CAD SR, which a hospital's archive and readers know.
#pragma once

#include "core/findings.h"
#include "core/result.h"
#include "core/source_series.h"

#include <filesystem>

namespace haustra::dicom {

struct ColonCadReportOptions {
    /// The very series that the scan came from (a folder, searched to any depth, or one file): the
    /// report takes whose it is from there (Patient and General Study modules). Empty: these stay
    /// empty, which is valid, but no archive can file such a report under its patient.
    std::filesystem::path series;
    int threads = 0;
};

/// Writes `file` (Colon CAD SR Storage, explicit VR little endian; UTF-8 where ASCII does not do),
/// replacing it in one step, after PS3.16 TID 4120 and what it includes, and PS3.17 SS.3.2, the
/// standard's example of a polyp that several slices show:
///
///   4120 Colon CAD Report; its language (1204)
///     4122 Image Set Properties, of each stretch of equally spaced slices
///     4121 CAD Processing and Findings Summary
///       4125 Composite Feature "Polyp of colon" of each finding (Presentation Required) and of
///            each candidate (Presentation Optional), in their order
///         4108 Tracking Identifier: "finding 1" …; "candidate 8" after 7 findings, as reading
///              stations count them
///         4019 algorithm: the model's name; the program's, and the model's SHA-256
///         4126 related spatially, on multiple images; Certainty of Feature, 100 · score, in %
///         4129 Center: SCOORD3D POINT; Outline: SCOORD3D ELLIPSOID of the same moments as the
///              finding's voxels (core/voxel_ellipsoid.h)
///         4128 Finding Site: the colon's segment; Diameter with its ends as a path (1406);
///              Height; Distance from anus: the arc along the centerline
///     Summary of Detections: Succeeded, or where some of the wall was not examined Partially
///       Succeeded, its area with a failed detection (4015, 4017); the operating point, what the
///       model was trained on and the warnings with the successful one; the series by its UID
///     Summary of Analyses: Not Attempted
///
/// Places are LPS mm in the series' frame of reference, as in the JSON, to single precision: at
/// 500 mm to 0.03 µm; no slice has to be chosen for them, and neither a tilt sheared back nor
/// resampled slices move them. The evidence (0040,A375) lists every image of the series. No Image
/// Library. Complete, unverified.
///
/// The same findings, series and identity give the same bytes: UIDs are hashes of the content, and
/// the content's date is the study's, 1 January 1900 where that is not known. What a finding does
/// not have is left out.
///
/// Fails (badInput) where the source has no images, UIDs or frame of reference, where the findings
/// do not say what made them, and where `series` is another than the source; (io) where the file
/// cannot be written. Thread-safe.
Result<void> writeColonCadReport(const std::filesystem::path& file, const Findings& findings,
                                 const SourceSeries& source,
                                 const ColonCadReportOptions& options = {});

}  // namespace haustra::dicom
