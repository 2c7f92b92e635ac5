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

// What lies outside the box is in no level of it, nor in its area.
TEST(CroppedContents, LevelsAreOfTheBoxAlone) {
    BowelContents contents;
    contents.content =
        Volume<std::uint8_t>(axisAlignedGrid({20, 10, 4}, {1, 2, 1}), std::uint8_t(Content::gas));
    contents.down = {1, 1};
    contents.levels = {levelOf(2, 5, 300.0), levelOf(8, 11, 400.0), levelOf(14, 17, 500.0)};
    const VoxelBox box{{0, 2, 0}, {10, 8, 4}};
    const BowelContents part = cropped(contents, box, 1);
    ASSERT_EQ(part.levels.size(), 2u);
    EXPECT_EQ(part.levels[0].fluidHu, 300.0);
    EXPECT_EQ(part.levels[0].areaMm2, contents.levels[0].areaMm2) << "whole within it";
    EXPECT_EQ(part.levels[1].fluidHu, 400.0);
    EXPECT_EQ(part.levels[1].columns.size(), 2u);
    EXPECT_EQ(part.levels[1].areaMm2, 0.5 * contents.levels[1].areaMm2);
    for (const Level& level : part.levels) {
        EXPECT_EQ(level.height, 4 - box.lo.y);
        EXPECT_EQ(level.heightMm, 8.0 - 2.0 * box.lo.y);
        for (const LevelColumn& column : level.columns)
            EXPECT_TRUE(part.content.grid().contains(column.above) &&
                        part.content.grid().contains(column.below));
    }
}

}  // namespace
