// Cleansing looks at the colon's surroundings alone: how much more the field of view holds, and
// where in it the colon lies, changes nothing.
#include "cleansing_scenes.h"

#include <algorithm>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::test;

namespace {

const glm::dvec3 middle(50.4, 49.7, 47.2);
constexpr double radiusMm = 15.0;

/// A ball half full of fluid in soft tissue; what lies around it within a slice is brighter by
/// `enhancedHu` at most.
Scene halfFullBall(double enhancedHu) {
    Scene scene = makeScene(
        glm::ivec3(100, 100, 96), 600.0, 12.0,
        [](glm::dvec3 p) {
            const double open = blurredStep(radiusMm - glm::distance(p, middle));
            const double fluid = blurredStep(p.y - middle.y);
            return Shares{open * (1.0 - fluid), open * fluid};
        },
        glm::dvec3(1.0));
    const Grid& grid = scene.scan.hu.grid();
    const auto hu = scene.scan.hu.writable();
    for (std::size_t n = 0; n < hu.size(); ++n) {
        const glm::dvec3 d = glm::dvec3(grid.voxelAt(n)) - middle - glm::dvec3(0.0, 6.0, 0.0);
        if (std::abs(d.z) < radiusMm)
            hu[n] = std::int16_t(hu[n] + enhancedHu * std::exp(-(d.x * d.x + d.y * d.y) / 400.0));
    }
    return scene;
}

template <class T>
Volume<T> padded(const Volume<T>& volume, glm::ivec3 before, glm::ivec3 after, T value) {
    Grid grid = volume.grid();
    grid.size += before + after;
    grid.patientFromVoxel[3] =
        glm::dvec4(volume.grid().patientFromVoxelPoint(-glm::dvec3(before)), 1.0);
    Volume<T> large(grid, value);
    paste(volume, {before, volume.grid().size}, large, 1);
    return large;
}

class Confinement : public testing::TestWithParam<std::tuple<double, int>> {};

TEST_P(Confinement, ALargerFieldOfViewChangesNothing) {
    const auto [enhancedHu, beyondHu] = GetParam();
    const Scene scene = halfFullBall(enhancedHu);
    const glm::ivec3 before(23, 9, 41), after(7, 30, 5);
    const CtScan large{padded(scene.scan.hu, before, after, std::int16_t(beyondHu)),
                       scene.scan.position};
    const Volume<std::uint8_t> labels = padded(scene.labels, before, after, std::uint8_t(0));
    const auto model = cleansing::fitPartialVolume(scene.scan, scene.tissue, 2);
    const glm::dvec3 gravity = gravityDirection(scene.scan.position);
    struct Made {
        Volume<TissueFractions> mixture;
        cleansing::Cleansed cleansed;
    };
    const auto make = [&](const CtScan& scan, const Volume<std::uint8_t>& labelled) {
        auto part = cleansing::cropToLumen(scan, labelled, 2).value();
        EXPECT_LT(part->labels.grid().voxelCount(), scene.labels.grid().voxelCount());
        auto byHu = cleansing::fractionsByHu(part->scan.hu, model, 2);
        const auto lumen = cleansing::measureTaggedLumen(std::move(*part), scene.tissue, 2);
        EXPECT_EQ(bool(lumen.enhancement), enhancedHu > 0.0);
        auto mixture =
            cleansing::estimateMixture(scan, model, std::move(byHu), &lumen, gravity).whole(2);
        auto cleansed = cleansing::cleanse(scan, scene.tissue, mixture, labelled, 2).value();
        return Made{std::move(mixture), std::move(cleansed)};
    };
    const Made small = make(scene.scan, scene.labels), whole = make(large, labels);
    const VoxelBox box{before, scene.scan.hu.grid().size};
    EXPECT_TRUE(
        std::ranges::equal(small.mixture.voxels(), cropped(whole.mixture, box, 1).voxels()));
    EXPECT_TRUE(std::ranges::equal(small.cleansed.hu.voxels(),
                                   cropped(whole.cleansed.hu, box, 1).voxels()));
    EXPECT_TRUE(std::ranges::equal(small.cleansed.lumen.voxels(),
                                   cropped(whole.cleansed.lumen, box, 1).voxels()));
    // And beyond it all is as it was.
    const auto lumenVoxels = [](const Volume<std::uint8_t>& lumen) {
        return std::ranges::count_if(lumen.voxels(), [](std::uint8_t label) { return label; });
    };
    EXPECT_EQ(lumenVoxels(small.cleansed.lumen), lumenVoxels(whole.cleansed.lumen));
    EXPECT_EQ(whole.cleansed.hu.at(3, 4, 5), beyondHu);
}

INSTANTIATE_TEST_SUITE_P(EnhancedAndBeyond, Confinement,
                         testing::Combine(testing::Values(0.0, 60.0), testing::Values(-1024, 40)));

}  // namespace
