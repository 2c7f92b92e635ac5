// Volumes to and from NIfTI-1 files (.nii, .nii.gz). NIfTI is RAS; Haustra is LPS: the first two
// rows of the affine change sign on the way in and out.
#pragma once

#include "core/rgba.h"
#include "core/tissue.h"
#include "core/volume.h"

#include <cstdint>
#include <filesystem>

namespace haustra::nifti {

/// Reads a 3-D image (further axes of one sample are allowed) of any integer or real type in either
/// byte order, plain or gzip whatever its name, applying scl_slope and scl_inter. Values outside
/// T's range are clamped, fractions rounded to nearest, NaN is `notANumber` in an integer type.
/// Affine: sform, else qform, else the spacing alone; micrometres and metres become millimetres. T
/// is std::int16_t, std::uint8_t or float.
///
/// Fails, naming the file, where it is not NIfTI-1 in one file, is of another type (complex,
/// colour), its grid fails checkGrid, or it is truncated or damaged. Memory: the volume and a few
/// MB, taken only when the file is large enough to fill it. Thread-safe.
template <class T>
Result<Volume<T>> readNifti(const std::filesystem::path& file, T notANumber = T(0));

/// Whether the file says how its axes lie in the patient (sform or qform). Fails as readNifti does,
/// but for the values, which are not read.
Result<bool> saysHowItLies(const std::filesystem::path& file);

/// Writes sform and, where the axes are orthogonal, qform, in single precision as the format has
/// it; compressed for speed on all cores where the name ends in .gz. Written under a temporary
/// name beside `file` and renamed. The same volume gives the same bytes.
template <class T>
Result<void> writeNifti(const std::filesystem::path& file, const Volume<T>& volume);

/// Reads a colour image of 8 bits a channel, with or without opacity (RGB24, RGBA32), as readNifti
/// reads others. Fails (unsupported) where it is of another type.
struct ColorImage {
    Volume<Rgba> voxels;
    bool hasOpacity = false;  ///< else it is 255 everywhere
};
Result<ColorImage> readColorNifti(const std::filesystem::path& file);
/// As RGBA32; as writeNifti otherwise.
Result<void> writeColorNifti(const std::filesystem::path& file, const Volume<Rgba>& volume);

/// Writes a mixture as one 4-D uint8 image: all voxels' air, then their soft tissue, then their
/// tagged material, in 255ths that sum to 255. As writeNifti otherwise; takes a few MB. readNifti
/// refuses the file as one of more than three axes.
Result<void> writeFractions(const std::filesystem::path& file,
                            const Volume<TissueFractions>& fractions);

}  // namespace haustra::nifti
