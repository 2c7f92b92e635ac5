// A box of a volume as a volume of its own.
#pragma once

#include "core/parallel.h"
#include "core/volume.h"

#include <algorithm>

namespace haustra {

/// Voxels from `lo` on, `size` of them along each axis.
struct VoxelBox {
    glm::ivec3 lo{0}, size{0};
};

/// The smallest box that holds both corner voxels and what lies within `marginMm` of them, as far
/// as the grid goes.
inline VoxelBox boxWithin(const Grid& grid, glm::ivec3 lo, glm::ivec3 hi, glm::dvec3 marginMm) {
    const glm::ivec3 margin(glm::ceil(marginMm / grid.spacingMm()));
    const glm::ivec3 first = glm::max(lo - margin, glm::ivec3(0)),
                     last = glm::min(hi + margin, grid.size - 1);
    return {first, last - first + 1};
}

/// The grid of the box's voxels, each where it was.
inline Grid cropped(const Grid& grid, const VoxelBox& box) {
    Grid part = grid;
    part.size = box.size;
    part.patientFromVoxel[3] = glm::dvec4(grid.patientFromVoxelPoint(glm::dvec3(box.lo)), 1.0);
    return part;
}

/// A copy of the box's voxels, which can be written to.
template <class T>
Volume<T> croppedCopy(const Volume<T>& volume, const VoxelBox& box, int threads) {
    Volume<T> part(cropped(volume.grid(), box));
    const auto out = part.writable();
    parallelFor(std::size_t(box.size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (int j = 0; j < box.size.y; ++j) {
                const T* row =
                    &volume.voxels()[volume.grid().index(box.lo + glm::ivec3(0, j, int(k)))];
                std::copy_n(row, box.size.x, &out[part.grid().index(0, j, int(k))]);
            }
        }
    });
    return part;
}

/// The box's voxels, in the volume's own memory where the box is all of it.
template <class T>
Volume<T> cropped(const Volume<T>& volume, const VoxelBox& box, int threads) {
    return box.size == volume.grid().size ? volume.share() : croppedCopy(volume, box, threads);
}

/// Writes `part` over the box's voxels of `whole`.
template <class T>
void paste(const Volume<T>& part, const VoxelBox& box, Volume<T>& whole, int threads) {
    const Grid grid = whole.grid();
    const auto out = whole.writable();
    parallelFor(std::size_t(box.size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (int j = 0; j < box.size.y; ++j) {
                const T* row = &part.voxels()[part.grid().index(0, j, int(k))];
                std::copy_n(row, box.size.x, &out[grid.index(box.lo + glm::ivec3(0, j, int(k)))]);
            }
        }
    });
}

}  // namespace haustra
