#include "dicom/jpeg_header.h"

namespace haustra::dicom {

std::optional<JpegHeader> jpegHeader(std::span<const std::uint8_t> bytes) {
    constexpr std::uint8_t startOfImage = 0xd8, endOfImage = 0xd9, startOfScan = 0xda;
    const auto pair = [&](std::size_t at) { return bytes[at] << 8 | bytes[at + 1]; };
    if (bytes.size() < 2 || bytes[0] != 0xff || bytes[1] != startOfImage) return std::nullopt;
    for (std::size_t at = 2; at + 4 <= bytes.size();) {
        if (bytes[at] != 0xff) return std::nullopt;
        const std::uint8_t marker = bytes[at + 1];
        if (marker == 0xff) {  // fill bytes may stand before any marker
            ++at;
            continue;
        }
        if (marker == startOfScan || marker == endOfImage) return std::nullopt;
        const bool isTable = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
        if (marker >= 0xc0 && marker <= 0xcf && !isTable) {
            if (at + 10 > bytes.size()) return std::nullopt;
            return JpegHeader{{pair(at + 7), pair(at + 5)}, bytes[at + 4], bytes[at + 9]};
        }
        at += 2 + std::size_t(pair(at + 2));
    }
    return std::nullopt;
}

std::size_t fillingOfJpeg(std::span<const std::uint8_t> bytes) {
    const auto dropZeros = [&] {
        const std::size_t before = bytes.size();
        while (!bytes.empty() && bytes.back() == 0)
            bytes = bytes.first(bytes.size() - 1);
        return before - bytes.size();
    };
    dropZeros();  // behind the end of image
    if (bytes.size() < 2 || bytes[bytes.size() - 2] != 0xff || bytes.back() != 0xd9) return 0;
    bytes = bytes.first(bytes.size() - 2);
    return dropZeros();
}

}  // namespace haustra::dicom
