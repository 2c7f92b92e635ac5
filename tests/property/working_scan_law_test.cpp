// Laws of the scan that the segmentation works on, and of the way back to the whole one.
#include "core/ct_scan.h"
#include "segmentation/working_scan.h"
#include "topology/digital_topology.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::segmentation;

namespace {

constexpr double gasHu = -1000.0, softHu = 40.0, wallHu = -480.0;

// A bent tube of gas, closed to a ring, in soft tissue: one handle. Positive inside, mm.
double insideRing(glm::dvec3 p) {
    const double ring = std::hypot(p.x, p.y) - 14.0;
    return 5.0 - std::hypot(ring, p.z);
}

Volume<std::int16_t> ringScan(glm::ivec3 size, double spacingMm, double noiseSd) {
    const glm::dvec3 origin = -0.5 * spacingMm * glm::dvec3(size - 1);
    Volume<std::int16_t> hu(axisAlignedGrid(size, glm::dvec3(spacingMm), origin));
    std::mt19937 random(7);
    std::normal_distribution<double> unit;  // times a deviation, which may be 0
    const auto out = hu.writable();
    for (std::size_t n = 0; n < out.size(); ++n) {
        const double mm = insideRing(hu.grid().patientFromVoxelPoint(hu.grid().voxelAt(n)));
        const double share = 0.5 * std::erfc(-mm / (0.4 * std::sqrt(2.0)));
        out[n] =
            std::int16_t(std::lround(softHu + share * (gasHu - softHu) + noiseSd * unit(random)));
    }
    return hu;
}

double dice(const Volume<std::uint8_t>& labels) {
    double both = 0.0, sum = 0.0;
    for (std::size_t n = 0; n < labels.voxels().size(); ++n) {
        const bool a = labels[n] != 0;
        const bool b =
            insideRing(labels.grid().patientFromVoxelPoint(labels.grid().voxelAt(n))) > 0.0;
        both += a && b, sum += double(a) + double(b);
    }
    return 2.0 * both / sum;
}

TEST(Binning, IsOfWholeVoxelsThatStayUnderTheCoarsest) {
    EXPECT_EQ(binningOf(axisAlignedGrid(glm::ivec3(8), {0.68, 0.68, 1.0})), glm::ivec3(1));
    EXPECT_EQ(binningOf(axisAlignedGrid(glm::ivec3(8), {0.35, 0.35, 0.4})), glm::ivec3(2));
    EXPECT_EQ(binningOf(axisAlignedGrid(glm::ivec3(8), {0.2, 0.41, 2.0})), glm::ivec3(4, 1, 1));
}

TEST(Binning, KeepsMeansAndPlaces) {
    // A ramp of HU is its own mean, at the place of the block's middle.
    const Grid grid = axisAlignedGrid({13, 9, 7}, {0.3, 0.4, 0.5}, {-20.0, 3.0, 5.0});
    Volume<std::int16_t> hu(grid);
    const auto out = hu.writable();
    for (std::size_t n = 0; n < out.size(); ++n)
        out[n] = std::int16_t(100 * grid.voxelAt(n).x + 10 * grid.voxelAt(n).y);
    const glm::ivec3 by(2, 2, 1);
    const Volume<std::int16_t> half = binned(hu, by, 1);
    ASSERT_EQ(half.grid().size, glm::ivec3(7, 5, 7));
    for (std::size_t n = 0; n < half.voxels().size(); ++n) {
        const glm::ivec3 v = half.grid().voxelAt(n);
        if ((v.x + 1) * 2 > 13 || (v.y + 1) * 2 > 9) continue;  // of part of a block
        const glm::dvec3 at =
            grid.voxelFromPatientPoint(half.grid().patientFromVoxelPoint(glm::dvec3(v)));
        EXPECT_NEAR(half[n], 100.0 * at.x + 10.0 * at.y, 0.5 + 1e-9);
    }
}

TEST(FullResolution, MovesTheBorderToTheScansOwnAndKeepsTheTopology) {
    const glm::ivec3 by(2);
    for (const double noiseSd : {0.0, 120.0}) {
        const Volume<std::int16_t> hu = ringScan({121, 121, 41}, 0.35, noiseSd);
        const Volume<std::int16_t> half = binned(hu, by, 1);
        Volume<std::uint8_t> labels(half.grid(), std::uint8_t(0)),
            barred(half.grid(), std::uint8_t(0));
        const auto out = labels.writable();
        for (std::size_t n = 0; n < out.size(); ++n) {
            // What noise makes beside the ring is no label of the segmentation's.
            const double mm = insideRing(half.grid().patientFromVoxelPoint(half.grid().voxelAt(n)));
            out[n] = half[n] < wallHu && mm > -1.0;
        }
        // A wall across the ring, one voxel thick, that no HU shows: it opens the ring.
        const auto bars = barred.writable();
        const int wall = half.grid().size.x / 2;
        for (std::size_t n = 0; n < out.size(); ++n) {
            const glm::ivec3 v = half.grid().voxelAt(n);
            if (v.x == wall && v.y < half.grid().size.y / 2) bars[n] = 1, out[n] = 0;
        }
        const auto before = topology::digitalTopology(labels);
        ASSERT_EQ(before.components, 1);
        ASSERT_EQ(before.handles(), noiseSd > 0.0 ? before.handles() : 0);
        const Volume<std::uint8_t> fine = atFullResolution(labels, barred, hu, by, wallHu, 2);
        EXPECT_EQ(topology::digitalTopology(fine), before);
        Volume<std::uint8_t> blocks(hu.grid());
        const auto copied = blocks.writable();
        for (std::size_t n = 0; n < copied.size(); ++n)
            copied[n] = labels.at(hu.grid().voxelAt(n) / by);
        EXPECT_GT(dice(fine), dice(blocks) + (noiseSd > 0.0 ? 0.0 : 0.005));
        const Volume<std::uint8_t> again = atFullResolution(labels, barred, hu, by, wallHu, 1);
        EXPECT_TRUE(std::equal(fine.voxels().begin(), fine.voxels().end(), again.voxels().begin()));
    }
}

// Fluid that the HU do not tell from its wall ends where its blocks do; the gas over it does not
// grow into it.
TEST(FullResolution, LeavesUntaggedFluidItsBlocks) {
    const Grid fineGrid = axisAlignedGrid(glm::ivec3(48), glm::dvec3(0.35));
    Volume<std::int16_t> hu(fineGrid, std::int16_t(softHu));
    const auto isGas = [](glm::ivec3 v) { return v.x > 8 && v.x < 39 && v.y > 8 && v.y < 23; };
    for (std::size_t n = 0; n < fineGrid.voxelCount(); ++n) {
        const glm::ivec3 v = fineGrid.voxelAt(n);
        if (v.z > 7 && v.z < 40 && isGas(v)) hu.writable()[n] = std::int16_t(gasHu);
    }
    const glm::ivec3 by(2);
    const Volume<std::int16_t> half = binned(hu, by, 1);
    Volume<std::uint8_t> labels(half.grid(), std::uint8_t(0)), barred(half.grid(), std::uint8_t(0));
    for (std::size_t n = 0; n < labels.voxels().size(); ++n) {
        const glm::ivec3 v = half.grid().voxelAt(n);
        const bool beneath = v.z >= 5 && v.z < 19 && v.x >= 6 && v.x < 18 && v.y >= 12 && v.y < 20;
        labels.writable()[n] = half[n] < wallHu ? std::uint8_t(LumenLabel::air)
                               : beneath        ? std::uint8_t(LumenLabel::untagged)
                                                : std::uint8_t(LumenLabel::outside);
    }
    const Volume<std::uint8_t> fine = atFullResolution(labels, barred, hu, by, wallHu, 2);
    std::size_t fluid = 0;
    for (std::size_t n = 0; n < fineGrid.voxelCount(); ++n) {
        const LumenLabel block{labels.at(fineGrid.voxelAt(n) / by)}, is{fine[n]};
        if (block == LumenLabel::untagged)
            EXPECT_EQ(is, hu[n] < wallHu ? LumenLabel::air : LumenLabel::untagged);
        else
            EXPECT_NE(is, LumenLabel::untagged);
        fluid += is == LumenLabel::untagged;
    }
    EXPECT_GT(fluid, std::size_t(8 * 12 * 12 * 7));
    EXPECT_EQ(topology::digitalTopology(fine), topology::digitalTopology(labels));
}

TEST(BowelBox, HoldsTheGasAndItsSurroundingsButNoSpeck) {
    Volume<std::uint8_t> content(axisAlignedGrid({200, 200, 200}, glm::dvec3(1.0)),
                                 std::uint8_t(Content::tissue));
    const auto out = content.writable();
    const auto fill = [&](glm::ivec3 lo, glm::ivec3 hi) {
        for (int k = lo.z; k < hi.z; ++k) {
            for (int j = lo.y; j < hi.y; ++j) {
                for (int i = lo.x; i < hi.x; ++i)
                    out[content.grid().index(i, j, k)] = std::uint8_t(Content::gas);
            }
        }
    };
    fill({80, 90, 95}, {110, 100, 105});
    fill({10, 10, 10}, {12, 12, 12});
    const VoxelBox box = bowelBox(content, {}, 2);
    EXPECT_EQ(box.lo, glm::ivec3(22, 32, 17));
    EXPECT_EQ(box.lo + box.size, glm::ivec3(168, 158, 183));
    const glm::dvec3 also[] = {{165.0, 95.0, 100.0}};
    EXPECT_EQ(bowelBox(content, also, 1).size.x, 200 - 22);
}

}  // namespace
