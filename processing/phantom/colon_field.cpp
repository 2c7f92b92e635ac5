#include "phantom/colon_field.h"

namespace haustra::phantom {

ColonField::ColonField(const ColonShape& shape, const Grid& grid, int threads) : grid_(grid) {
    blocksPerAxis_ = (grid.size + blockSize - 1) / blockSize;
    const std::size_t total = std::size_t(blocksPerAxis_.x) * blocksPerAxis_.y * blocksPerAxis_.z;
    const double halfDiagonal = 0.5 * blockSize * glm::length(grid.spacingMm());
    auto originOf = [&](std::size_t n) {
        return blockSize * glm::ivec3(int(n % blocksPerAxis_.x),
                                      int(n / blocksPerAxis_.x % blocksPerAxis_.y),
                                      int(n / (std::size_t(blocksPerAxis_.x) * blocksPerAxis_.y)));
    };
    auto centreOf = [&](std::size_t n) {
        return grid.patientFromVoxelPoint(glm::dvec3(originOf(n)) + 0.5 * (blockSize - 1.0));
    };

    std::vector<std::uint8_t> near(total);
    parallelFor(total, 512, threads, [&](std::size_t begin, std::size_t end) {
        ColonShape::Nearby nearby;
        for (std::size_t n = begin; n < end; ++n) {
            shape.findNearby(centreOf(n), halfDiagonal, nearby);
            near[n] = !nearby.segments.empty();
        }
    });
    blockAt_.assign(total, -1);
    int count = 0;
    for (std::size_t n = 0; n < total; ++n) {
        if (near[n]) blockAt_[n] = count++;
    }
    blocks_.resize(std::size_t(count));

    parallelFor(total, 256, threads, [&](std::size_t begin, std::size_t end) {
        ColonShape::Nearby nearby;
        for (std::size_t n = begin; n < end; ++n) {
            if (blockAt_[n] < 0) continue;
            Block& block = blocks_[std::size_t(blockAt_[n])];
            block.origin = originOf(n);
            shape.findNearby(centreOf(n), halfDiagonal, nearby);
            for (int v = 0; v < blockVoxels; ++v) {
                const glm::ivec3 voxel =
                    block.origin + glm::ivec3(v % blockSize, v / blockSize % blockSize,
                                              v / (blockSize * blockSize));
                if (!grid.contains(voxel)) continue;
                const ColonPoint p = shape.evaluate(grid.patientFromVoxelPoint(voxel), nearby);
                block.samples[v] = {float(p.lumenMm), float(p.outerMm), float(p.arcMm),
                                    std::int16_t(p.growth)};
            }
        }
    });
}

}  // namespace haustra::phantom
