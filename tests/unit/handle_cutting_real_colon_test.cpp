// A real lumen, full of handles, becomes a ball.
#include "data_folder.h"
#include "nifti/nifti_file.h"
#include "topology/handle_cutting.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace haustra::topology {
namespace {

TEST(HandleCutting, MakesABallOfARealColon) {
    HAUSTRA_REAL_DATA(maskFile, "masks/lumen460.nii.gz");
    const auto mask = nifti::readNifti<std::uint8_t>(maskFile);
    ASSERT_TRUE(mask) << describe(mask.error());
    const DigitalTopology before = digitalTopology(*mask);
    ASSERT_GT(before.handles(), 0);
    HandleCuttingOptions one, two;
    one.threads = 1, two.threads = 2;
    const auto cut = cutHandles(*mask, one), again = cutHandles(*mask, two);
    ASSERT_TRUE(cut && again);
    EXPECT_TRUE(isBallEitherWay(cut->labels));
    EXPECT_EQ(cut->handlesCut, before.handles());
    EXPECT_EQ(cut->cavitiesFilled + cut->islandsTied, before.cavities);
    EXPECT_TRUE(std::ranges::equal(cut->labels.voxels(), again->labels.voxels()));
    // Sheets one voxel thick: a small part of a lumen of 2.8 million voxels.
    EXPECT_LT(cut->voxelsRemoved, 2000u);
    RecordProperty("handles", std::to_string(cut->handlesCut));
    RecordProperty("voxels_removed", std::to_string(cut->voxelsRemoved));
    RecordProperty("voxels_added", std::to_string(cut->voxelsAdded));
}

}  // namespace
}  // namespace haustra::topology
