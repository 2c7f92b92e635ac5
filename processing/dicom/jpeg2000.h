// JPEG 2000 codestreams, which DCMTK does not decode, through OpenJPEG.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::dicom {

struct Jpeg2000Image {
    std::vector<std::uint16_t> cells;  ///< low 16 bits of each value, row by row
    int precision = 16;                ///< bits of a value as the codestream says, at most 16
    bool isSigned = false;             ///< as the codestream says, not the data set
};

/// Decodes one grey image of exactly `matrix` (columns, rows) from a raw codestream or a JP2 file.
/// Fails where the bytes are damaged, truncated, or another kind of image. Thread-safe.
Result<Jpeg2000Image> decodeJpeg2000(std::span<const std::uint8_t> bytes, glm::ivec2 matrix,
                                     const std::string& place);

}  // namespace haustra::dicom
