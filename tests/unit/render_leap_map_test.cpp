// The leap map against its definition.
#include "random_volume.h"
#include "render/optics/leap_map.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace haustra::render {
namespace {

using tests::randomVolume;

const TransferTable& mucosa() {
    static const TransferTable table = makeTransferTable(*opticsPreset("mucosa"), 0.5);
    return table;
}

TEST(BlockRanges, HoldEveryVoxelThatAnInterpolationInsideReads) {
    for (const glm::ivec3 size : {glm::ivec3(9, 8, 7), {1, 1, 1}, {2, 3, 4}, {30, 1, 5}}) {
        const Volume<std::int16_t> volume = randomVolume(size, 1, 0.3);
        const BlockRanges ranges = blockRanges(volume, blockSide, 2);
        for (int k = 0; k < size.z; ++k) {
            for (int j = 0; j < size.y; ++j) {
                for (int i = 0; i < size.x; ++i) {
                    // A voxel borders the blocks that begin at it and those that end at it.
                    for (int side = 0; side < 8; ++side) {
                        const glm::ivec3 inside =
                            glm::ivec3(i, j, k) * 2 +
                            glm::ivec3(side & 1, (side >> 1) & 1, side >> 2) * 2 - 1;
                        const glm::ivec3 block =
                            glm::clamp(glm::ivec3(glm::floor(glm::dvec3(inside) / 4.0)),
                                       glm::ivec3(0), ranges.size - 1);
                        const std::size_t at = std::size_t(
                            block.x + ranges.size.x * (block.y + ranges.size.y * block.z));
                        EXPECT_LE(ranges.lowHu[at], volume.at(i, j, k));
                        EXPECT_GE(ranges.highHu[at], volume.at(i, j, k));
                    }
                }
            }
        }
    }
}

TEST(LeapDistances, AreTheChebyshevDistancesToVisibleBlocks) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        const Volume<std::int16_t> volume = randomVolume({41, 34, 27}, seed, 0.0003);
        const BlockRanges ranges = blockRanges(volume, blockSide, 2);
        const std::vector<std::uint8_t> distances = leapDistances(ranges, mucosa(), 2);
        const auto blockOf = [&](std::size_t i) {
            const int row = int(i) / ranges.size.x;
            return glm::ivec3(int(i) % ranges.size.x, row % ranges.size.y, row / ranges.size.y);
        };
        std::vector<glm::ivec3> visible;
        for (std::size_t i = 0; i < distances.size(); ++i)
            if (mucosa().anyVisible(ranges.lowHu[i], ranges.highHu[i]))
                visible.push_back(blockOf(i));
        ASSERT_FALSE(visible.empty());
        for (std::size_t i = 0; i < distances.size(); ++i) {
            int nearest = 255;
            for (const glm::ivec3 other : visible) {
                const glm::ivec3 d = glm::abs(other - blockOf(i));
                nearest = std::min(nearest, std::max({d.x, d.y, d.z}));
            }
            ASSERT_EQ(distances[i], nearest);
        }
    }
}

TEST(LeapDistances, AreTheSameForAnyNumberOfThreadsAndFarWhereNothingShows) {
    const Volume<std::int16_t> volume = randomVolume({64, 50, 40}, 9, 0.01);
    EXPECT_EQ(leapDistances(blockRanges(volume, blockSide, 1), mucosa(), 1),
              leapDistances(blockRanges(volume, blockSide, 4), mucosa(), 4));
    const Volume<std::int16_t> air(axisAlignedGrid({20, 20, 20}, glm::dvec3(1.0)), -1000);
    for (const std::uint8_t distance : leapDistances(blockRanges(air, blockSide, 1), mucosa(), 1))
        EXPECT_EQ(distance, 255);
}

}  // namespace
}  // namespace haustra::render
