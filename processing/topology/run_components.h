// Connected components of a threshold, kept as runs along i: small, exact, fast to build.
#pragma once

#include "core/volume.h"

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::topology {

/// Voxels [begin, end) of one row that belong to component `component`.
struct Run {
    std::int32_t begin, end;
    std::int32_t component;
};

struct RunComponent {
    std::uint64_t voxels = 0;
    glm::ivec3 lowest{0}, highest{0};  ///< bounding box, inclusive
    glm::dvec3 centroid{0.0};          ///< voxel coordinates
    bool touches(int axis, bool far, glm::ivec3 size) const {
        return far ? highest[axis] == size[axis] - 1 : lowest[axis] == 0;
    }
};

/// Six-connected components of {voxels < threshold}, numbered by their first voxel in memory order.
class RunComponents {
public:
    RunComponents(const Volume<std::int16_t>& volume, double below, int threads);

    const std::vector<RunComponent>& components() const { return components_; }
    /// Runs of row (j, k), in order of i.
    std::span<const Run> row(int j, int k) const {
        const std::size_t r = std::size_t(j) + std::size_t(size_.y) * std::size_t(k);
        return {runs_.data() + rowBegin_[r], rowBegin_[r + 1] - rowBegin_[r]};
    }
    /// Component of a voxel, or −1. O(log runs of its row).
    int at(glm::ivec3 voxel) const;

private:
    glm::ivec3 size_;
    std::vector<Run> runs_;
    std::vector<std::size_t> rowBegin_;
    std::vector<RunComponent> components_;
};

}  // namespace haustra::topology
