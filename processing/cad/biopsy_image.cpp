#include "cad/biopsy_image.h"

#include "cad/strip_raster.h"
#include "cad/wall_shape.h"
#include "core/parallel.h"
#include "core/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::cad {
namespace {

std::array<std::uint8_t, 4096> displayTable() {
    std::array<std::uint8_t, 4096> table{};
    for (std::size_t n = 0; n < table.size(); ++n) {
        const double c = (double(n) + 0.5) / double(table.size());
        table[n] = std::uint8_t(std::lround(255.0 * displayedLight(c)));
    }
    return table;
}

}  // namespace

glm::u8vec3 displayed(glm::vec3 linear) {
    static const std::array<std::uint8_t, 4096> table = displayTable();
    glm::u8vec3 out;
    for (int c = 0; c < 3; ++c)
        out[c] = table[std::size_t(std::clamp(int(linear[c] * 4096.0f), 0, 4095))];
    return out;
}

Image biopsyImage(const BiopsyScan& scan, const FlatMap& flat, const BiopsyTable& table,
                  glm::ivec2 size, int finer, int threads) {
    const StripRaster raster = rasterStrip(flat, size * finer, threads);
    Image image = blankImage(size);
    // Ring after ring of the colon, whose rays pass through the same voxels.
    constexpr std::size_t ring = 16;
    parallelFor(std::size_t(size.x), ring, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = 0; row < std::size_t(size.y); ++row) {
            for (int column = int(begin); column < int(end); ++column) {
                glm::vec3 sum(0.0f);
                for (int n = 0; n < finer * finer; ++n) {
                    const auto& pixel =
                        raster.pixels[(row * std::size_t(finer) + std::size_t(n / finer)) *
                                          std::size_t(raster.size.x) +
                                      std::size_t(column * finer + n % finer)];
                    if (pixel.triangle < 0) continue;
                    const glm::dvec3 place = raster.placeOf(pixel, flat);
                    const glm::dvec3 gradient = scan.scan.gradient(place);
                    const double steep = glm::length(gradient);
                    if (steep < 1e-6) continue;
                    sum +=
                        castBiopsyRay(scan, table, place, gradient / steep, RayEnd::opaque).color;
                }
                const glm::u8vec3 color = displayed(sum / float(finer * finer));
                for (int c = 0; c < 3; ++c)
                    image.rgb[3 * (row * std::size_t(size.x) + std::size_t(column)) +
                              std::size_t(c)] = color[c];
            }
        }
    });
    return image;
}

}  // namespace haustra::cad
