// Volume<T>: one value for each voxel of a Grid, in memory of its own or mapped from a product.
#pragma once

#include "core/grid.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <utility>

namespace haustra {

/// Values of type T (a plain arithmetic type) on a Grid; i fastest. A volume either owns its
/// memory (and can be written through `writable()`), or is a read-only view whose memory is kept
/// alive by a shared owner, such as a memory-mapped product. Moving is cheap; a copy is spelled
/// `clone()`. Reading is safe from any number of threads.
template <class T>
class Volume {
public:
    Volume() = default;

    /// Owned memory, uninitialised: every stage writes each voxel.
    explicit Volume(const Grid& grid) : grid_(grid) {
        own(std::malloc(std::max<std::size_t>(1, grid.voxelCount()) * sizeof(T)));
    }
    /// Owned memory, every voxel set to `value`. Of zeros, only the pages that are written to are
    /// ever held: what is sparse takes little memory.
    Volume(const Grid& grid, T value) : grid_(grid) {
        constexpr char zeros[sizeof(T)] = {};
        if (std::memcmp(&value, zeros, sizeof(T)) == 0) {
            own(std::calloc(std::max<std::size_t>(1, grid.voxelCount()), sizeof(T)));
        } else {
            own(std::malloc(std::max<std::size_t>(1, grid.voxelCount()) * sizeof(T)));
            std::fill_n(writableVoxels_, grid.voxelCount(), value);
        }
    }
    /// A read-only view of `voxels` (grid.voxelCount() of them), alive as long as `owner`.
    static Volume view(const Grid& grid, const T* voxels, std::shared_ptr<const void> owner) {
        Volume volume;
        volume.grid_ = grid;
        volume.voxels_ = voxels;
        volume.owner_ = std::const_pointer_cast<void>(std::move(owner));
        return volume;
    }

    Volume(Volume&&) noexcept = default;
    Volume& operator=(Volume&&) noexcept = default;
    Volume(const Volume&) = delete;
    Volume& operator=(const Volume&) = delete;

    /// Another handle on the same memory, read-only: how a volume is shared between threads.
    Volume share() const { return view(grid_, voxels_, owner_); }
    Volume clone() const {
        Volume copy(grid_);
        std::memcpy(copy.writableVoxels_, voxels_, sizeBytes());
        return copy;
    }

    const Grid& grid() const { return grid_; }
    bool empty() const { return grid_.voxelCount() == 0; }
    std::size_t sizeBytes() const { return grid_.voxelCount() * sizeof(T); }

    std::span<const T> voxels() const { return {voxels_, grid_.voxelCount()}; }
    /// Only of a volume that owns its memory; empty for a view.
    std::span<T> writable() { return {writableVoxels_, writableVoxels_ ? grid_.voxelCount() : 0}; }

    T operator[](std::size_t index) const { return voxels_[index]; }
    T at(glm::ivec3 v) const { return voxels_[grid_.index(v)]; }
    T at(int i, int j, int k) const { return voxels_[grid_.index(i, j, k)]; }

private:
    void own(void* memory) {
        if (!memory) throw std::bad_alloc();
        owner_ = std::shared_ptr<void>(memory, std::free);
        voxels_ = writableVoxels_ = static_cast<T*>(memory);
    }

    Grid grid_;
    std::shared_ptr<void> owner_;
    const T* voxels_ = nullptr;
    T* writableVoxels_ = nullptr;
};

/// Value at a fractional voxel coordinate by trilinear interpolation; outside the grid the
/// nearest voxel's value (clamped to the edge, as OpenGL's GL_CLAMP_TO_EDGE).
template <class T>
double trilinear(const Volume<T>& volume, glm::dvec3 voxel) {
    const glm::ivec3 last = volume.grid().size - 1;
    const glm::dvec3 p = glm::clamp(voxel, glm::dvec3(0.0), glm::dvec3(last));
    const glm::ivec3 lo = glm::min(glm::ivec3(glm::floor(p)), glm::max(last - 1, glm::ivec3(0)));
    const glm::ivec3 hi = glm::min(lo + 1, last);
    const glm::dvec3 f = p - glm::dvec3(lo);
    auto alongX = [&](int j, int k) {
        return double(volume.at(lo.x, j, k)) * (1.0 - f.x) + double(volume.at(hi.x, j, k)) * f.x;
    };
    auto alongY = [&](int k) { return alongX(lo.y, k) * (1.0 - f.y) + alongX(hi.y, k) * f.y; };
    return alongY(lo.z) * (1.0 - f.z) + alongY(hi.z) * f.z;
}

}  // namespace haustra
