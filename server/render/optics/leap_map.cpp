#include "render/optics/leap_map.h"

#include "core/parallel.h"

#include <algorithm>
#include <limits>

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

BlockRanges blockRanges(const Volume<std::int16_t>& volume, int side, int threads) {
    const Grid& grid = volume.grid();
    const std::int16_t* voxels = volume.voxels().data();
    const auto row = [&](int y, int z, std::span<std::int16_t> values) {
        std::copy_n(voxels + grid.index(0, y, z), values.size(), values.data());
    };
    return blockRanges(grid.size, row, side, threads);
}

BlockRanges blockRanges(glm::ivec3 voxels, const VoxelRow& row, int side, int threads) {
    BlockRanges ranges;
    ranges.size = glm::max((voxels - 1 + side - 1) / side, glm::ivec3(1));
    const std::size_t blockRows = std::size_t(ranges.size.y) * std::size_t(ranges.size.z);
    ranges.lowHu.resize(std::size_t(ranges.size.x) * blockRows);
    ranges.highHu.resize(ranges.lowHu.size());
    parallelFor(blockRows, 1, threads, [&](std::size_t begin, std::size_t end) {
        const std::size_t along = std::size_t(voxels.x);
        std::vector<std::int16_t> values(along), lows(along), highs(along);
        std::int16_t *low = lows.data(), *high = highs.data();
        for (std::size_t blockRow = begin; blockRow < end; ++blockRow) {
            const int firstY = side * int(blockRow % std::size_t(ranges.size.y));
            const int firstZ = side * int(blockRow / std::size_t(ranges.size.y));
            // First across the blocks' rows of voxels, which runs along memory, then along them.
            std::fill_n(low, along, std::numeric_limits<std::int16_t>::max());
            std::fill_n(high, along, std::numeric_limits<std::int16_t>::min());
            for (int z = firstZ; z <= std::min(firstZ + side, voxels.z - 1); ++z) {
                for (int y = firstY; y <= std::min(firstY + side, voxels.y - 1); ++y) {
                    row(y, z, values);
                    const std::int16_t* value = values.data();
                    for (std::size_t x = 0; x < along; ++x) {
                        low[x] = std::min(low[x], value[x]);
                        high[x] = std::max(high[x], value[x]);
                    }
                }
            }
            const std::size_t at = blockRow * std::size_t(ranges.size.x);
            for (int block = 0; block < ranges.size.x; ++block) {
                const int from = block * side, to = std::min(from + side + 1, voxels.x);
                ranges.lowHu[at + std::size_t(block)] = *std::min_element(low + from, low + to);
                ranges.highHu[at + std::size_t(block)] = *std::max_element(high + from, high + to);
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
