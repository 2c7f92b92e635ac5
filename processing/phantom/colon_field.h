// The colon's geometry sampled on a grid, kept only near the colon.
#pragma once

#include "core/parallel.h"
#include "phantom/colon_shape.h"

#include <array>
#include <vector>

namespace haustra::phantom {

/// Samples of a ColonShape at the voxel centres of the blocks that the colon reaches.
class ColonField {
public:
    static constexpr int blockSize = 8;
    static constexpr int blockVoxels = blockSize * blockSize * blockSize;

    struct Sample {
        float lumenMm = 1e9f;
        float outerMm = 1e9f;
        float arcMm = 0.0f;
        std::int16_t growth = -1;
    };

    /// O(blocks near the colon); the same for any number of threads.
    ColonField(const ColonShape& shape, const Grid& grid, int threads);

    /// Samples the shape anew in the blocks that a ball reaches.
    void resample(const ColonShape& shape, glm::dvec3 center, double radiusMm);

    const Grid& grid() const { return grid_; }
    int blockCount() const { return int(blocks_.size()); }
    glm::ivec3 blockOrigin(int block) const { return blocks_[block].origin; }
    /// The block's voxels, i fastest; those beyond the grid's end hold "far".
    const std::array<Sample, blockVoxels>& block(int block) const { return blocks_[block].samples; }
    /// The sample at a voxel; "far" (1e9) away from the colon.
    const Sample& at(int i, int j, int k) const {
        const int b = blockAt_[std::size_t(i / blockSize) +
                               std::size_t(blocksPerAxis_.x) *
                                   (std::size_t(j / blockSize) +
                                    std::size_t(blocksPerAxis_.y) * (k / blockSize))];
        if (b < 0) return far_;
        return blocks_[b]
            .samples[i % blockSize + blockSize * (j % blockSize + blockSize * (k % blockSize))];
    }

private:
    struct Block {
        glm::ivec3 origin{0};
        std::array<Sample, blockVoxels> samples;
    };
    double halfDiagonalMm() const { return 0.5 * blockSize * glm::length(grid_.spacingMm()); }
    glm::dvec3 centerOf(glm::ivec3 blockOrigin) const {
        return grid_.patientFromVoxelPoint(glm::dvec3(blockOrigin) + 0.5 * (blockSize - 1.0));
    }
    void sample(const ColonShape& shape, ColonShape::Nearby& nearby, Block& block) const;

    Grid grid_;
    glm::ivec3 blocksPerAxis_{0};
    std::vector<int> blockAt_;  ///< −1 where there is none
    std::vector<Block> blocks_;
    Sample far_;
};

}  // namespace haustra::phantom
