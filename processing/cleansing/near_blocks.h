// Where labels are near, block by block, so that costlier looks are spared elsewhere.
#pragma once

#include "core/volume.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace haustra::cleansing {

/// The blocks of a volume that hold labels of a kind, and those beside them: what is no farther
/// from such a label than a block is wide along each axis lies in one of them.
class NearBlocks {
public:
    /// `isOfKind(label)` of the labels that are looked for.
    template <class Predicate>
    NearBlocks(const Volume<std::uint8_t>& labels, glm::ivec3 voxelsPerBlock,
               const Predicate& isOfKind)
        : voxels_(voxelsPerBlock),
          count_((labels.grid().size + voxels_ - 1) / voxels_),
          near_(std::size_t(count_.x) * std::size_t(count_.y) * std::size_t(count_.z)) {
        const Grid& grid = labels.grid();
        for (int k = 0; k < grid.size.z; ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                for (int i = 0; i < grid.size.x; ++i) {
                    if (!isOfKind(labels.at(i, j, k))) continue;
                    const glm::ivec3 block = blockOf({i, j, k});
                    mark(block);
                    // The rest of the block adds nothing.
                    i = (block.x + 1) * voxels_.x - 1;
                }
            }
        }
    }

    bool hold(glm::ivec3 voxel) const { return near_[index(blockOf(voxel))] != 0; }

    std::size_t voxelCount() const {
        return std::size_t(std::count(near_.begin(), near_.end(), 1)) * std::size_t(voxels_.x) *
               std::size_t(voxels_.y) * std::size_t(voxels_.z);
    }

private:
    glm::ivec3 blockOf(glm::ivec3 voxel) const { return voxel / voxels_; }

    std::size_t index(glm::ivec3 block) const {
        return (std::size_t(block.z) * std::size_t(count_.y) + std::size_t(block.y)) *
                   std::size_t(count_.x) +
               std::size_t(block.x);
    }

    void mark(glm::ivec3 block) {
        visitBox(glm::max(block - 1, glm::ivec3(0)), glm::min(block + 1, count_ - 1),
                 [&](glm::ivec3 b) { near_[index(b)] = 1; });
    }

    glm::ivec3 voxels_, count_;
    std::vector<char> near_;
};

}  // namespace haustra::cleansing
