// The part of a scan that the segmentation works on.
#include "segmentation/working_scan.h"

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::segmentation;

namespace {

// A level at height 4 of each column of `fromX` to `toX` in one slice, over fluid of some HU.
Level levelOf(int fromX, int toX, double fluidHu) {
    Level level;
    for (int x = fromX; x <= toX; ++x)
        level.columns.push_back({{x, 3, 1}, {x, 5, 1}});
    level.areaMm2 = 2.0 * double(level.columns.size());
    level.height = 4, level.heightMm = 8.0, level.fluidHu = fluidHu;
    return level;
}

// What is marked in them is theirs, also where the box is the whole grid.
TEST(CroppedContents, AreACopyThatCanBeWrittenTo) {
    BowelContents contents;
    const Grid grid = axisAlignedGrid({6, 5, 4}, {1, 1, 1});
    contents.content = Volume<std::uint8_t>(grid, std::uint8_t(Content::gas));
    for (const VoxelBox& box : {VoxelBox{{0, 0, 0}, grid.size}, VoxelBox{{1, 0, 0}, {4, 5, 4}}}) {
        BowelContents part = cropped(contents, box, 1);
        ASSERT_EQ(part.content.writable().size(), part.content.grid().voxelCount());
        part.content.writable()[0] = std::uint8_t(Content::untagged);
        EXPECT_EQ(Content(contents.content[contents.content.grid().index(box.lo)]), Content::gas);
    }
}

// Of the scan's levels all stay, as they tell what its fluid is; of their columns those within.
TEST(CroppedContents, HaveAllLevelsAndTheBoxesColumns) {
    BowelContents contents;
    contents.content =
        Volume<std::uint8_t>(axisAlignedGrid({20, 10, 4}, {1, 2, 1}), std::uint8_t(Content::gas));
    contents.down = {1, 1, {}};
    contents.levels = {levelOf(2, 5, 300.0), levelOf(8, 11, 400.0), levelOf(14, 17, 500.0)};
    const VoxelBox box{{0, 2, 0}, {10, 8, 4}};
    const BowelContents part = cropped(contents, box, 1);
    ASSERT_EQ(part.levels.size(), 3u);
    EXPECT_EQ(part.levels[0].columns.size(), 4u) << "whole within it";
    EXPECT_EQ(part.levels[1].columns.size(), 2u);
    EXPECT_TRUE(part.levels[2].columns.empty());
    for (std::size_t n = 0; n < part.levels.size(); ++n) {
        const Level& level = part.levels[n];
        EXPECT_EQ(level.fluidHu, contents.levels[n].fluidHu);
        EXPECT_EQ(level.areaMm2, contents.levels[n].areaMm2);
        EXPECT_EQ(level.height, 4 - box.lo.y);
        EXPECT_EQ(level.heightMm, 8.0 - 2.0 * box.lo.y);
        for (const LevelColumn& column : level.columns)
            EXPECT_TRUE(part.content.grid().contains(column.above) &&
                        part.content.grid().contains(column.below));
    }
}

}  // namespace
