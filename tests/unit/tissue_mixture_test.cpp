// The mixture model recovers what was planted.
#include "cleansing/tissue_mixture.h"

#include <random>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

struct Planted {
    double mean, sd, share;
};

CtScan scanOf(const std::vector<Planted>& classes, double quantumHu = 1.0) {
    CtScan scan{Volume<std::int16_t>(axisAlignedGrid({100, 100, 60}, {1, 1, 1})),
                PatientPosition::supine};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> pick(0.0, 1.0);
    for (std::int16_t& hu : scan.hu.writable()) {
        double at = pick(random);
        std::size_t n = 0;
        while (n + 1 < classes.size() && at > classes[n].share)
            at -= classes[n++].share;
        const double value =
            std::normal_distribution<double>(classes[n].mean, classes[n].sd)(random);
        hu = std::int16_t(std::lround(value / quantumHu) * quantumHu);
    }
    return scan;
}

class TissueMixture : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(TissueMixture, RecoversMeansAndWidths) {
    const auto [noise, tagging] = GetParam();
    const auto model = cleansing::fitTissueModel(
        scanOf({{-985, noise, 0.3}, {-95, noise, 0.25}, {45, noise, 0.4}, {tagging, 60, 0.05}}));
    ASSERT_TRUE(model) << describe(model.error());
    // Values at or below -1024 HU are padding and are not seen: wide noise loses its lower tail.
    EXPECT_NEAR(model->meanHu[int(Tissue::air)], -985, 0.35 * noise);
    EXPECT_NEAR(model->meanHu[int(Tissue::fat)], -95, 6);
    EXPECT_NEAR(model->meanHu[int(Tissue::soft)], 45, 6);
    EXPECT_NEAR(model->meanHu[int(Tissue::taggedOrBone)], tagging, 30);
    EXPECT_NEAR(model->sdHu[int(Tissue::soft)], noise, 0.25 * noise + 1);
    EXPECT_NEAR(model->airBelowHu, -470, 8);
    EXPECT_GT(model->taggedAboveHu, 45 + 2.0 * noise);
    EXPECT_LT(model->taggedAboveHu, tagging);
}

INSTANTIATE_TEST_SUITE_P(NoiseAndTagging, TissueMixture,
                         testing::Combine(testing::Values(10.0, 20.0, 40.0),
                                          testing::Values(350.0, 700.0, 1200.0)));

TEST(TissueMixtureOf, AQuantisedScan) {
    const auto model = cleansing::fitTissueModel(
        scanOf({{-985, 15, 0.3}, {-95, 15, 0.25}, {45, 15, 0.4}, {600, 60, 0.05}}, 17.5));
    ASSERT_TRUE(model);
    EXPECT_NEAR(model->meanHu[int(Tissue::soft)], 45, 8);
    EXPECT_NEAR(model->meanHu[int(Tissue::air)], -985, 8);
}

TEST(TissueMixtureOf, AScanWithoutTagging) {
    const auto model =
        cleansing::fitTissueModel(scanOf({{-985, 15, 0.3}, {-95, 15, 0.3}, {45, 15, 0.4}}));
    ASSERT_TRUE(model);
    EXPECT_LT(model->weight[int(Tissue::taggedOrBone)], 1e-3);
    EXPECT_GT(model->taggedAboveHu, 45 + 4 * 15);
}

TEST(TissueMixtureOf, ABodyWithoutAirIsRefused) {
    const auto model = cleansing::fitTissueModel(scanOf({{-95, 15, 0.5}, {45, 15, 0.5}}));
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().kind, ErrorKind::noResult);
    EXPECT_NE(model.error().message.find("air"), std::string::npos);
}

TEST(TissueMixtureOf, AnEmptyRoomIsRefused) {
    EXPECT_FALSE(cleansing::fitTissueModel(scanOf({{-985, 15, 1.0}})));
}

}  // namespace
