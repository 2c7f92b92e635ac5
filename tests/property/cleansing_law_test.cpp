// Laws of cleansing over the taggings and noises that scans have, and on a whole phantom.
#include "cleansing/tissue_mixture.h"
#include "cleansing_scenes.h"
#include "phantom/phantom.h"

#include <tuple>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::test;

namespace {

class CleansingOf : public testing::TestWithParam<std::tuple<double, double>> {};

// Noise in a mixed voxel is multiplied by at most the contrast of tagged over soft material against
// air; three times that is the bound.
TEST_P(CleansingOf, StaysWithinItsErrorBounds) {
    const auto [taggedHu, noise] = GetParam();
    const Scene scene = tubeWithLevel(taggedHu, noise);
    const CleansedScene result = cleanseScene(scene);
    const double gain = (taggedHu - sceneAirHu) / (taggedHu - sceneSoftHu);
    const auto inside =
        errorWhere(scene, result.cleansed, [](Shares s, glm::dvec3) { return s.tagged > 0.999; });
    EXPECT_LT(std::abs(inside.bias), 5.0 + 0.03 * gain * noise);
    EXPECT_LT(inside.rmse, 1.15 * noise + 2.0);
    const auto level = errorWhere(scene, result.cleansed, [](Shares s, glm::dvec3) {
        return s.soft() < 0.001 && s.air > 0.001 && s.tagged > 0.001;
    });
    EXPECT_LT(std::abs(level.bias), 20.0 + 0.1 * noise);
    const auto wall = errorWhere(scene, result.cleansed, [](Shares s, glm::dvec3) {
        return s.air < 0.001 && s.tagged > 0.02 && s.soft() > 0.02;
    });
    EXPECT_LT(std::abs(wall.bias), 15.0 + 0.35 * gain * noise);
    EXPECT_LT(wall.rmse, 15.0 + 1.2 * gain * noise);
}

INSTANTIATE_TEST_SUITE_P(TaggingAndNoise, CleansingOf,
                         testing::Combine(testing::Values(150.0, 250.0, 450.0, 800.0, 1200.0),
                                          testing::Values(10.0, 20.0, 40.0)));

TEST(CleansingLaw, ThreadsDoNotChangeABit) {
    const Scene scene = tubeWithLevel(500.0, 20.0);
    const CleansedScene one = cleanseScene(scene, 1), three = cleanseScene(scene, 3);
    for (std::size_t n = 0; n < scene.scan.hu.voxels().size(); ++n) {
        ASSERT_EQ(one.mixture[n], three.mixture[n]);
        ASSERT_EQ(one.cleansed.hu[n], three.cleansed.hu[n]);
        ASSERT_EQ(one.cleansed.lumen[n], three.cleansed.lumen[n]);
    }
}

TEST(CleansingLaw, SmallPhantomBecomesItsUntaggedTwin) {
    phantom::PhantomOptions options;
    options.size = phantom::Size::small;
    const auto made = phantom::makePhantom(options);
    ASSERT_TRUE(made);
    const auto tissue = cleansing::fitTissueModel(made->scan);
    ASSERT_TRUE(tissue);
    const auto mixture = cleansing::estimateMixture(made->scan, *tissue, made->lumen,
                                                    gravityDirection(made->scan.position));
    ASSERT_TRUE(mixture);
    const auto cleansed = cleansing::cleanse(made->scan, *tissue, *mixture, made->lumen);
    ASSERT_TRUE(cleansed);
    const Grid& grid = made->scan.hu.grid();
    double bias = 0.0, before = 0.0, after = 0.0;
    long count = 0, both = 0, either = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const bool truth = made->lumen[n] != 0, found = cleansed->lumen[n] != 0;
        both += truth && found, either += truth + found;
        if (LumenLabel(made->lumen[n]) != LumenLabel::tagged) continue;
        const double was = made->scan.hu[n] - made->untaggedHu[n];
        const double is = cleansed->hu[n] - made->untaggedHu[n];
        bias += is, before += was * was, after += is * is, ++count;
    }
    ASSERT_GT(count, 10000);
    EXPECT_LT(std::abs(bias / double(count)), 30.0);
    EXPECT_LT(std::sqrt(after / before), 0.10);
    EXPECT_GT(2.0 * double(both) / double(either), 0.97);
}

// What the segmentation takes for tagged by mistake is tissue once it is cleansed, and told.
TEST(CleansingLaw, LumenThatIsTissueOnceCleansedIsTold) {
    const glm::dvec3 middle(20.7, 20.55, 11.5);
    for (const double radiusMm : {0.0, 5.0, 9.0}) {
        Scene scene = makeScene({56, 56, 24}, 500.0, 15.0, [&](glm::dvec3 p) {
            const double open = blurredStep(12.0 - glm::length(glm::dvec2(p) - glm::dvec2(middle)));
            const double lump =
                radiusMm > 0.0 ? blurredStep(radiusMm - glm::length(p - middle)) : 0.0;
            return Shares{0.0, open * (1.0 - lump)};
        });
        const Grid& grid = scene.scan.hu.grid();
        double lumpMl = 0.0;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            if (glm::distance(grid.patientFromVoxelPoint(grid.voxelAt(n)), middle) > radiusMm)
                continue;
            scene.labels.writable()[n] = std::uint8_t(LumenLabel::tagged);
            lumpMl += grid.voxelVolumeMm3() / 1000.0;
        }
        const auto mixture = cleansing::estimateMixture(scene.scan, scene.tissue, scene.labels,
                                                        gravityDirection(scene.scan.position), {});
        ASSERT_TRUE(mixture);
        auto part = cleansing::cropToLumen(scene.scan, scene.labels, 1);
        ASSERT_TRUE(part && *part);
        const auto lost =
            cleansing::cleanse(scene.scan, scene.tissue, *mixture,
                               cleansing::measureTaggedLumen(std::move(**part), scene.tissue, 1))
                .lost;
        // A lump of half a millilitre is a polyp that residue covers.
        ASSERT_EQ(lost.size(), radiusMm > 6.0 ? 1u : 0u);
        if (lost.empty()) continue;
        EXPECT_GT(lost[0].ml, 0.7 * lumpMl);  // of its rim the blur is lumen's
        EXPECT_LT(lost[0].ml, lumpMl);
        EXPECT_LT(glm::distance(lost[0].placeMm, middle), 0.5);
    }
}

}  // namespace
