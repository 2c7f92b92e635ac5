// Pixels of one DICOM file, in any of the transfer syntaxes, as Hounsfield units.
#pragma once

#include "core/result.h"
#include "dicom/image_header.h"

#include <cstdint>
#include <functional>
#include <span>

namespace haustra::dicom {

/// Receives frame `frame` (matrix.x · matrix.y values, row by row), valid during the call only.
using FrameSink = std::function<void(int frame, std::span<const std::int16_t> hu)>;

/// Decodes frames [first, last) of the image in order: native (either byte order, deflated), RLE,
/// JPEG (baseline, extended, lossless), JPEG-LS and JPEG 2000. Keeps one frame in memory at a
/// time. Fails, naming the file, where the pixel data is missing, truncated, damaged or of another
/// kind. Thread-safe.
Result<void> decodeFrames(const ImageHeader& image, int first, int last, const FrameSink& sink);

}  // namespace haustra::dicom
