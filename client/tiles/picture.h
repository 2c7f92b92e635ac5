// A finished picture of one viewport, with what the server said about its making.
#pragma once

#include <cstdint>
#include <vector>

namespace haustra::tiles {

/// Rows from the top, 3 bytes a pixel.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
    int viewport = 0;
    std::uint32_t number = 0;    ///< the server's count of its pictures
    std::uint64_t sequence = 0;  ///< newest input that this picture answers
    bool exact = false;          ///< the lossless still, bit for bit what the server rendered
    std::size_t wireBytes = 0;   ///< payload bytes of all its tiles
    double decodeMs = 0.0;       ///< time that decoding its tiles took
    std::uint32_t renderMicroseconds = 0, encodeMicroseconds = 0, queueMicroseconds = 0;
    std::uint8_t raycaster = 0;  ///< that drew it (raycasterName of core/raycasters.h)
    bool coarse = false;         ///< smaller than its viewport, over which it is to be stretched
};

}  // namespace haustra::tiles
