#include "render/optics/leap_map.h"

#include "core/parallel.h"

#include <algorithm>

namespace haustra::render {

namespace {

/// Distances of one row after those of neighbouring rows that are already known: the smallest of
/// three neighbours in each, plus one.
void lowerByRow(std::uint8_t* row, const std::uint8_t* known, int count) {
    const auto plusOne = [](int d) { return std::uint8_t(std::min(d + 1, 255)); };
    for (int x = 1; x + 1 < count; ++x) {
        const std::uint8_t least = std::min(known[x], std::min(known[x - 1], known[x + 1]));
        row[x] = std::min(row[x], plusOne(least));
    }
    if (count > 1) {
        row[0] = std::min(row[0], plusOne(std::min(known[0], known[1])));
        row[count - 1] =
            std::min(row[count - 1], plusOne(std::min(known[count - 1], known[count - 2])));
    } else {
        row[0] = std::min(row[0], plusOne(known[0]));
    }
}

}  // namespace

BlockRanges blockRanges(const Volume<std::int16_t>& volume, int threads) {
    const glm::ivec3 voxels = volume.grid().size;
    BlockRanges ranges;
    ranges.size = glm::max((voxels - 1 + blockSide - 1) / blockSide, glm::ivec3(1));
    const std::size_t rowBlocks = std::size_t(ranges.size.x);
    const std::size_t slice = rowBlocks * std::size_t(ranges.size.y);
    ranges.lowHu.resize(slice * std::size_t(ranges.size.z));
    ranges.highHu.resize(ranges.lowHu.size());
    parallelFor(std::size_t(ranges.size.z), 1, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::int16_t> low(std::size_t(voxels.x)), high(std::size_t(voxels.x));
        for (int bz = int(begin); bz < int(end); ++bz) {
            for (int by = 0; by < ranges.size.y; ++by) {
                // First across the block's rows, which runs along memory, then along them.
                std::fill(low.begin(), low.end(), std::int16_t(32767));
                std::fill(high.begin(), high.end(), std::int16_t(-32768));
                for (int z = bz * blockSide;
                     z <= std::min(bz * blockSide + blockSide, voxels.z - 1); ++z) {
                    for (int y = by * blockSide;
                         y <= std::min(by * blockSide + blockSide, voxels.y - 1); ++y) {
                        const std::int16_t* row = &volume.voxels()[volume.grid().index(0, y, z)];
                        for (int x = 0; x < voxels.x; ++x) {
                            low[std::size_t(x)] = std::min(low[std::size_t(x)], row[x]);
                            high[std::size_t(x)] = std::max(high[std::size_t(x)], row[x]);
                        }
                    }
                }
                const std::size_t at = std::size_t(bz) * slice + std::size_t(by) * rowBlocks;
                for (int bx = 0; bx < ranges.size.x; ++bx) {
                    const auto from = bx * blockSide, to = std::min(from + blockSide + 1, voxels.x);
                    ranges.lowHu[at + std::size_t(bx)] =
                        *std::min_element(low.begin() + from, low.begin() + to);
                    ranges.highHu[at + std::size_t(bx)] =
                        *std::max_element(high.begin() + from, high.begin() + to);
                }
            }
        }
    });
    return ranges;
}

std::vector<std::uint8_t> leapDistances(const BlockRanges& ranges, const TransferTable& table,
                                        int threads) {
    const glm::ivec3 size = ranges.size;
    std::vector<std::uint8_t> distance(ranges.lowHu.size());
    parallelFor(distance.size(), 1 << 16, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            distance[i] = table.anyVisible(ranges.lowHu[i], ranges.highHu[i]) ? 0 : 255;
    });
    const auto row = [&](int y, int z) {
        return distance.data() +
               std::size_t(size.x) * (std::size_t(y) + std::size_t(size.y) * std::size_t(z));
    };
    const auto sweep = [&](int direction) {
        const auto ordered = [&](int i, int count) { return direction > 0 ? i : count - 1 - i; };
        for (int iz = 0; iz < size.z; ++iz) {
            const int z = ordered(iz, size.z), before = z - direction;
            for (int iy = 0; iy < size.y; ++iy) {
                const int y = ordered(iy, size.y);
                std::uint8_t* here = row(y, z);
                if (iz > 0)
                    for (int other = std::max(y - 1, 0); other <= std::min(y + 1, size.y - 1);
                         ++other)
                        lowerByRow(here, row(other, before), size.x);
                if (iy > 0) lowerByRow(here, row(y - direction, z), size.x);
                for (int ix = 1; ix < size.x; ++ix) {
                    const int x = ordered(ix, size.x);
                    here[x] = std::uint8_t(std::min<int>(here[x], here[x - direction] + 1));
                }
            }
        }
    };
    sweep(1);
    sweep(-1);
    return distance;
}

}  // namespace haustra::render
