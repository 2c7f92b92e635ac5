// Sweeps over all voxels of a grid that threads share.
#pragma once

#include "core/grid.h"
#include "core/parallel.h"

#include <cstdint>
#include <vector>

namespace haustra {

/// Calls visit(index, voxel) for the voxels of the slices [first, last), in memory order.
template <class Visit>
void visitSlices(const Grid& grid, std::size_t first, std::size_t last, const Visit& visit) {
    glm::ivec3 v(0, 0, int(first));
    for (std::size_t n = grid.index(v); v.z < int(last); ++v.z) {
        for (v.y = 0; v.y < grid.size.y; ++v.y) {
            for (v.x = 0; v.x < grid.size.x; ++v.x, ++n)
                visit(n, v);
        }
    }
}

/// Calls visit(voxel) for the voxels of the box from `lo` to `hi`, both inclusive, in memory order.
template <class Visit>
void visitBox(glm::ivec3 lo, glm::ivec3 hi, const Visit& visit) {
    for (int k = lo.z; k <= hi.z; ++k) {
        for (int j = lo.y; j <= hi.y; ++j) {
            for (int i = lo.x; i <= hi.x; ++i)
                visit(glm::ivec3(i, j, k));
        }
    }
}

/// Whether holds(voxel) for one of the voxels of the box from `lo` to `hi`, both inclusive; none is
/// asked after it.
template <class Holds>
bool anyInBox(glm::ivec3 lo, glm::ivec3 hi, const Holds& holds) {
    glm::ivec3 v;
    for (v.z = lo.z; v.z <= hi.z; ++v.z) {
        for (v.y = lo.y; v.y <= hi.y; ++v.y) {
            for (v.x = lo.x; v.x <= hi.x; ++v.x)
                if (holds(v)) return true;
        }
    }
    return false;
}

/// Calls visit(index, voxel) for all voxels, slice by slice; what it writes must be the voxel's
/// own.
template <class Visit>
void forVoxels(const Grid& grid, int threads, const Visit& visit) {
    parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t first, std::size_t last) {
        visitSlices(grid, first, last, visit);
    });
}

/// The voxels for which holds(index, voxel), ascending.
template <class Holds>
std::vector<std::uint32_t> voxelsWhere(const Grid& grid, int threads, const Holds& holds) {
    std::vector<std::vector<std::uint32_t>> slices(std::size_t(grid.size.z));
    parallelFor(slices.size(), 4, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            visitSlices(grid, k, k + 1, [&](std::size_t n, glm::ivec3 v) {
                if (holds(n, v)) slices[k].push_back(std::uint32_t(n));
            });
        }
    });
    std::size_t count = 0;
    for (const auto& slice : slices)
        count += slice.size();
    std::vector<std::uint32_t> voxels;
    voxels.reserve(count);
    for (const auto& slice : slices)
        voxels.insert(voxels.end(), slice.begin(), slice.end());
    return voxels;
}

}  // namespace haustra
