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
    std::string studySeed;  ///< series of one study share it; empty: uidSeed
    /// The patient's feet enter the scanner first: Patient Position FFS …, rows from the grid's
    /// last column to its first and slices from its last to its first, as the gantry sees them.
    bool feetFirst = false;
    int threads = 0;
};

/// Writes `directory`/0001.dcm … (CT Image Storage, explicit VR little endian, 16-bit signed, slope
/// 1, intercept 0), making the folder where it is missing and replacing files of these names. The
/// grid's axes must be orthogonal. importSeries gives back the same voxels and, to the 16
/// characters that DICOM has for a number, the same affine; a left-handed grid comes back with its
/// slices in the opposite order, and one with the feet first with its rows and slices reversed, at
/// the same places.
Result<void> writeSeries(const std::filesystem::path& directory, const CtScan& scan,
                         const WriteOptions& options);

}  // namespace haustra::dicom
