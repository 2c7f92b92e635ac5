#include "phantom/colon_field.h"

#include <algorithm>

namespace haustra::phantom {

ColonField::ColonField(const ColonShape& shape, const Grid& grid, int threads) : grid_(grid) {
    blocksPerAxis_ = (grid.size + blockSize - 1) / blockSize;
    const std::size_t total = std::size_t(blocksPerAxis_.x) * blocksPerAxis_.y * blocksPerAxis_.z;
    auto originOf = [&](std::size_t n) {
        return blockSize * glm::ivec3(int(n % blocksPerAxis_.x),
                                      int(n / blocksPerAxis_.x % blocksPerAxis_.y),
                                      int(n / (std::size_t(blocksPerAxis_.x) * blocksPerAxis_.y)));
    };

    std::vector<std::uint8_t> near(total);
    parallelFor(total, 512, threads, [&](std::size_t begin, std::size_t end) {
        ColonShape::Nearby nearby;
        for (std::size_t n = begin; n < end; ++n) {
            shape.findNearby(centerOf(originOf(n)), halfDiagonalMm(), nearby);
            near[n] = !nearby.segments.empty();
        }
    });
    blockAt_.assign(total, -1);
    blocks_.reserve(std::size_t(std::count(near.begin(), near.end(), 1)));
    for (std::size_t n = 0; n < total; ++n) {
        if (!near[n]) continue;
        blockAt_[n] = int(blocks_.size());
        blocks_.emplace_back().origin = originOf(n);
    }
    parallelFor(blocks_.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
        ColonShape::Nearby nearby;
        for (std::size_t b = begin; b < end; ++b)
            sample(shape, nearby, blocks_[b]);
    });
}

void ColonField::resample(const ColonShape& shape, glm::dvec3 center, double radiusMm) {
    ColonShape::Nearby nearby;
    for (Block& block : blocks_) {
        if (glm::distance(centerOf(block.origin), center) < radiusMm + halfDiagonalMm())
            sample(shape, nearby, block);
    }
}

void ColonField::sample(const ColonShape& shape, ColonShape::Nearby& nearby, Block& block) const {
    shape.findNearby(centerOf(block.origin), halfDiagonalMm(), nearby);
    for (int v = 0; v < blockVoxels; ++v) {
        const glm::ivec3 voxel = block.origin + glm::ivec3(v % blockSize, v / blockSize % blockSize,
                                                           v / (blockSize * blockSize));
        if (!grid_.contains(voxel)) continue;
        const ColonPoint p = shape.evaluate(grid_.patientFromVoxelPoint(voxel), nearby);
        block.samples[v] = {float(p.lumenMm), float(p.outerMm), float(p.arcMm),
                            std::int16_t(p.growth)};
    }
}

}  // namespace haustra::phantom
