#include "core/histogram.h"

namespace haustra {

Histogram histogramOf(const Volume<std::int16_t>& volume) {
    constexpr int first = -1024, binWidth = 16, bins = 256, everySlice = 4;
    Histogram histogram{first, binWidth, std::vector<std::uint64_t>(bins)};
    const glm::ivec3 size = volume.grid().size;
    const std::size_t slice = std::size_t(size.x) * std::size_t(size.y);
    for (int z = 0; z < size.z; z += everySlice)
        for (const std::int16_t hu : volume.voxels().subspan(std::size_t(z) * slice, slice)) {
            const int bin = (hu - first) / binWidth;
            if (hu >= first && bin < bins) ++histogram.voxels[std::size_t(bin)];
        }
    return histogram;
}

}  // namespace haustra
