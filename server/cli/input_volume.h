// A scan from a file or folder, of any kind that is read.
#pragma once

#include "core/result.h"
#include "core/volume.h"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace haustra::cli {

/// A NIfTI file; a folder of DICOM files with one CT series; or a folder of slices in
/// PNG or, where it has none, TIFF files (pictures::readGreyPicture), all of one size, in the order
/// of the numbers in their names: columns towards the patient's left, rows towards the back, slices
/// towards the head (towards the feet where `spacingMm` has a negative z). Values stay as they are;
/// 16-bit pixels over 32767 become that. `spacingMm` is for such slices alone, which are a
/// millimetre apart without it. Fails naming the file. `threads` ≤ 0: all cores.
Result<Volume<std::int16_t>> readInputVolume(const std::filesystem::path& path,
                                             std::optional<glm::dvec3> spacingMm, int threads);

}  // namespace haustra::cli
