// Volumes to and from NIfTI-1 files (.nii, .nii.gz). NIfTI is RAS; Haustra is LPS: the first two
// rows of the affine change sign on the way in and out.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/volume.h"

namespace haustra::nifti {

/// Reads a 3-D image of any integer or float type, applying scl_slope/scl_inter; values outside
/// T's range are clamped. Affine: sform, else qform, else the spacing alone. T is std::int16_t,
/// std::uint8_t or float.
template <class T>
Result<Volume<T>> readNifti(const std::filesystem::path& file);

/// Writes sform and qform; compressed where the name ends in .gz. Written under a temporary name
/// and renamed.
template <class T>
Result<void> writeNifti(const std::filesystem::path& file, const Volume<T>& volume);

}  // namespace haustra::nifti
