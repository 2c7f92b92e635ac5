// Laws of the order of axes: a patient's point keeps its value whatever order and direction a file
// has its axes in, and a volume that is in the stages' order is left as it is.
#include "pipeline/axial_order.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace haustra::pipeline {
namespace {

// Towards left, back and head, turned a little, with a value of its own in each voxel.
Volume<std::int16_t> axialVolume() {
    Grid grid{{5, 4, 7}, glm::dmat4(1.0)};
    grid.patientFromVoxel[0] = {0.79, 0.12, -0.05, 0.0};
    grid.patientFromVoxel[1] = {-0.11, 0.78, -0.2, 0.0};
    grid.patientFromVoxel[2] = {0.02, 0.35, 1.2, 0.0};
    grid.patientFromVoxel[3] = {-40.0, 12.5, -300.0, 1.0};
    Volume<std::int16_t> volume(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        volume.writable()[n] = std::int16_t(n);
    return volume;
}

// Rounding of the sum that a reversed axis' first voxel is.
constexpr double roundingMm = 1e-12;

TEST(AxialOrder, APatientsPointKeepsItsValueInEachOrder) {
    const auto axial = axialVolume();
    EXPECT_EQ(allAxisOrders().size(), 48u);
    for (const AxisOrder& order : allAxisOrders()) {
        const auto stored = reordered(axial.share(), order, 2);
        for (std::size_t n = 0; n < axial.grid().voxelCount(); ++n) {
            const glm::dvec3 place = axial.grid().patientFromVoxelPoint(axial.grid().voxelAt(n));
            const glm::ivec3 voxel = glm::round(stored.grid().voxelFromPatientPoint(place));
            ASSERT_TRUE(stored.grid().contains(voxel));
            ASSERT_LT(glm::distance(stored.grid().patientFromVoxelPoint(voxel), place), 1e-9);
            ASSERT_EQ(stored.at(voxel), axial[n]);
        }
        const auto back = reordered(stored.share(), axialOrder(stored.grid()), 1);
        EXPECT_EQ(back.grid().size, axial.grid().size);
        for (int column = 0; column < 3; ++column)
            EXPECT_EQ(back.grid().patientFromVoxel[column], axial.grid().patientFromVoxel[column]);
        EXPECT_LT(glm::distance(back.grid().patientFromVoxel[3], axial.grid().patientFromVoxel[3]),
                  roundingMm);
        EXPECT_TRUE(std::ranges::equal(back.voxels(), axial.voxels()));
    }
}

TEST(AxialOrder, AnAxialVolumeStaysWhereItIsInMemory) {
    auto volume = axialVolume();
    const auto* const voxels = volume.voxels().data();
    const AxisOrder order = axialOrder(volume.grid());
    EXPECT_EQ(order, sameOrder);
    EXPECT_EQ(reordered(std::move(volume), order, 1).voxels().data(), voxels);
}

TEST(AxialOrder, AxesAsNearAsEachOtherStayInTheirOrder) {
    Grid grid = axisAlignedGrid({2, 2, 2}, glm::dvec3(1.0));
    grid.patientFromVoxel[0] = {1.0, 1.0, 0.0, 0.0};
    grid.patientFromVoxel[1] = {-1.0, 1.0, 0.0, 0.0};
    EXPECT_EQ(axialOrder(grid), sameOrder);
    grid.patientFromVoxel[1] = {0.0, 1.0, 1.0, 0.0};
    grid.patientFromVoxel[2] = {0.0, -1.0, 1.0, 0.0};
    EXPECT_EQ(axialOrder(grid), sameOrder);
}

}  // namespace
}  // namespace haustra::pipeline
