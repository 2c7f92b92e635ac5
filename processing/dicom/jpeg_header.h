// What a JPEG stream says of its own picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/glm.hpp>

namespace haustra::dicom {

struct JpegHeader {
    glm::ivec2 size{0};  ///< columns, rows
    int precision = 0;   ///< bits of a sample
    int components = 0;
};

/// From the frame header (SOF) of a JPEG stream of any process (ITU-T T.81, B.2.2). None where the
/// bytes hold none.
std::optional<JpegHeader> jpegHeader(std::span<const std::uint8_t> bytes);

/// How many zeros stand before the stream's end of image: some writers fill it up.
std::size_t fillingOfJpeg(std::span<const std::uint8_t> bytes);

}  // namespace haustra::dicom
