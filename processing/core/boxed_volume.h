// A volume that is held in one box alone; what lies beyond it is made as it is asked for.
#pragma once

#include "core/crop.h"
#include "core/parallel.h"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>

namespace haustra {

/// Of a large scan, the surroundings of the colon are worked on; the rest of a product follows from
/// the scan voxel by voxel, or is empty. Reading is safe from any number of threads.
template <class T>
struct BoxedVolume {
    /// Fills `row` with the voxels from `first` on along i, all of them beyond the box.
    using Beyond = std::function<void(glm::ivec3 first, std::span<T> row)>;

    Grid grid;
    VoxelBox box;
    Volume<T> part;  ///< the box's voxels
    Beyond beyond;   ///< none: zeros

    /// Fills `out` with the voxels of the grid from index `first` on.
    void read(std::size_t first, std::span<T> out) const {
        while (!out.empty()) {
            const glm::ivec3 v = grid.voxelAt(first);
            const std::size_t count = std::min(out.size(), std::size_t(grid.size.x - v.x));
            readRow(v, out.first(count));
            out = out.subspan(count), first += count;
        }
    }

    Volume<T> whole(int threads) && {
        if (box.size == grid.size) return std::move(part);
        Volume<T> all(grid);
        const auto out = all.writable();
        parallelFor(out.size(), std::size_t(1) << 20, threads,
                    [&](std::size_t begin, std::size_t end) {
                        read(begin, out.subspan(begin, end - begin));
                    });
        return all;
    }

private:
    void fillBeyond(glm::ivec3 first, std::span<T> row) const {
        if (row.empty()) return;
        if (beyond)
            beyond(first, row);
        else
            std::fill(row.begin(), row.end(), T{});
    }

    /// Of one row, from voxel `v` on.
    void readRow(glm::ivec3 v, std::span<T> out) const {
        const glm::ivec3 end = box.lo + box.size;
        const int last = v.x + int(out.size()), from = std::clamp(box.lo.x, v.x, last),
                  to = std::clamp(end.x, from, last);
        if (v.y < box.lo.y || v.y >= end.y || v.z < box.lo.z || v.z >= end.z || from == to)
            return fillBeyond(v, out);
        fillBeyond(v, out.first(std::size_t(from - v.x)));
        std::copy_n(&part.voxels()[part.grid().index(glm::ivec3(from, v.y, v.z) - box.lo)],
                    to - from, out.begin() + (from - v.x));
        fillBeyond({to, v.y, v.z}, out.subspan(std::size_t(to - v.x)));
    }
};

}  // namespace haustra
