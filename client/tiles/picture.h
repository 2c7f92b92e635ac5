// A finished picture of one viewport, with what the server said about its making.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace haustra::tiles {

/// Leaves bytes as they are until they are written: clearing 8 MB a picture takes a millisecond.
struct Uncleared : std::allocator<std::uint8_t> {
    template <class Other>
    struct rebind {
        using other = Uncleared;
    };
    void construct(std::uint8_t*) {}
    template <class... From>
    void construct(std::uint8_t* at, From&&... from) {
        std::construct_at(at, std::forward<From>(from)...);
    }
};
using Pixels = std::vector<std::uint8_t, Uncleared>;

/// Rows from the top, 4 bytes a pixel: blue, green, red, 255.
struct Picture {
    int width = 0, height = 0;
    Pixels pixels;
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

/// Red, green, blue of each pixel, as picture files have them.
std::vector<std::uint8_t> rgbOf(const Picture& picture);

}  // namespace haustra::tiles
