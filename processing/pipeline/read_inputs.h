// What prepare takes in: a CT series, and a segmentation made elsewhere.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/source_series.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haustra::pipeline {

/// True for names that end in .nii or .nii.gz, in any case of letters.
bool isNiftiName(const std::filesystem::path& file);
/// True for what readScan reads as NIfTI: such a name, and no folder's.
bool isNiftiFile(const std::filesystem::path& file);

struct ScanInput {
    CtScan scan;
    int images = 0;  ///< slices in the files, or 1 NIfTI file
    std::vector<std::string> notes;
    std::optional<SourceSeries> source = {};  ///< none of a NIfTI file
};

/// A DICOM series (dicom/import_series.h), or a NIfTI file of unknown patient position; coronal,
/// sagittal and other images come in axial order (pipeline/axial_order.h), with a note.
Result<ScanInput> readScan(const std::filesystem::path& series, const std::string& seriesUid,
                           int threads, const Progress& progress);

struct MaskInput {
    Volume<std::uint8_t> labels;  ///< LumenLabel
    std::vector<std::string> notes;
};

/// A segmentation of the lumen in NIfTI: 0 outside, 2 tagged fluid, 4 fluid without tagging (as
/// LumenLabel has them), anything else gas. `scanGrid`, where
/// given, is the scan's grid; the mask must be on it to within a twentieth of a voxel, with its
/// axes in any order, and gets it. Otherwise the mask comes in axial order.
Result<MaskInput> readLumenMask(const std::filesystem::path& file, const Grid* scanGrid,
                                int threads = 0);

}  // namespace haustra::pipeline
