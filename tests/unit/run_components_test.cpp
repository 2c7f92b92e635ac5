#include "topology/run_components.h"

#include "core/flood_fill.h"

#include <random>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

TEST(RunComponents, AgreeWithAFloodFill) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        const glm::ivec3 size(1 + random() % 9, 1 + random() % 9, 1 + random() % 9);
        Volume<std::int16_t> volume(axisAlignedGrid(size, {1, 1, 1}));
        for (auto& v : volume.writable())
            v = std::int16_t(random() % 3);
        const topology::RunComponents runs(volume, 1.5, 1 + int(seed % 3));
        const Grid& g = volume.grid();
        std::vector<int> flood(g.voxelCount(), -1);
        int count = 0;
        for (std::size_t n = 0; n < g.voxelCount(); ++n) {
            if (volume[n] >= 1.5 || flood[n] >= 0) continue;
            std::vector<std::size_t> front{n};
            flood[n] = count;
            floodFill(front, faceNeighbours(g), [&](std::size_t m) {
                if (volume[m] >= 1.5 || flood[m] >= 0) return false;
                flood[m] = count;
                return true;
            });
            ++count;
        }
        ASSERT_EQ(int(runs.components().size()), count);
        std::uint64_t total = 0;
        for (const auto& c : runs.components())
            total += c.voxels;
        for (std::size_t n = 0; n < g.voxelCount(); ++n) {
            ASSERT_EQ(runs.at(g.voxelAt(n)), flood[n]);  // both number by the first voxel
            total -= flood[n] >= 0;
        }
        EXPECT_EQ(total, 0u);
    }
}

}  // namespace
