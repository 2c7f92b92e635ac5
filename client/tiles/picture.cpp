#include "tiles/picture.h"

namespace haustra::tiles {

std::vector<std::uint8_t> rgbOf(const Picture& picture) {
    std::vector<std::uint8_t> rgb(picture.pixels.size() / 4 * 3);
    const std::uint8_t* from = picture.pixels.data();
    for (std::uint8_t* to = rgb.data(); to != rgb.data() + rgb.size(); to += 3, from += 4)
        to[0] = from[2], to[1] = from[1], to[2] = from[0];
    return rgb;
}

}  // namespace haustra::tiles
