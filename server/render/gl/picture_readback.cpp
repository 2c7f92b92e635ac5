#include "render/gl/picture_readback.h"

#include <vector>

namespace haustra::render {

Result<void> readBack(gpu::Context& context, const gpu::Texture& rows, int errorsBefore,
                      int firstRow, Image& picture) {
    const std::size_t width = std::size_t(rows.size().x);
    const std::size_t pixels = width * std::size_t(rows.size().y);
    std::vector<std::uint8_t> rgba(4 * pixels);
    rows.read(rgba.data(), rgba.size());
    if (context.errorCount() != errorsBefore)
        return fail(ErrorKind::device, "the graphics driver reported an error", "render");
    std::uint8_t* out = &picture.rgb[3 * width * std::size_t(firstRow)];
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            out[3 * i + c] = rgba[4 * i + c];
    return {};
}

}  // namespace haustra::render
