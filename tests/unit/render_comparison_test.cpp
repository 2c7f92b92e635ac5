// The classification's colours and places.
#include "core/slice_placement.h"
#include "render/comparison.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra::render {
namespace {

// From percent, so that 100 % is 255.
TissueFractions percent(double air, double tagged) {
    const int airShare = int(std::lround(2.55 * air));
    return {std::uint8_t(airShare),
            std::uint8_t(std::min(int(std::lround(2.55 * tagged)), 255 - airShare))};
}

TEST(TissueColor, OverNinetyFivePercentOfOneTissueIsItsPureColor) {
    for (const double share : {95.3, 97.0, 100.0}) {
        const double rest = (100.0 - share) / 2.0;
        EXPECT_EQ(tissueColor(percent(share, 0.0)), airColor);
        EXPECT_EQ(tissueColor(percent(share, rest)), airColor);
        EXPECT_EQ(tissueColor(percent(0.0, share)), taggedColor);
        EXPECT_EQ(tissueColor(percent(rest, share)), taggedColor);
        EXPECT_EQ(tissueColor(percent(0.0, 100.0 - share)), softColor);
        EXPECT_EQ(tissueColor(percent(rest, rest)), softColor);
    }
}

TEST(TissueColor, AirAndTaggedMaterialInOneVoxelAreInterfaceWhateverTheirShares) {
    for (const double air : {6.0, 30.0, 50.0, 94.0})
        EXPECT_EQ(tissueColor(percent(air, 100.0 - air)), interfaceColor) << air;
    EXPECT_EQ(tissueColor(percent(60.0, 36.0)), interfaceColor);
    EXPECT_NE(tissueColor(percent(60.0, 30.0)), interfaceColor);  // the wall takes part
}

TEST(TissueColor, OtherMixturesBlendTheirTissuesByTheirShares) {
    const auto near = [](glm::u8vec3 a, glm::dvec3 b) {
        return glm::all(glm::lessThanEqual(glm::abs(glm::dvec3(a) - b), glm::dvec3(1.5)));
    };
    const glm::dvec3 air(airColor), soft(softColor), tagged(taggedColor), both(interfaceColor);
    for (const double share : {0.1, 0.25, 0.5, 0.8}) {
        const double percents = 100.0 * share;
        EXPECT_TRUE(near(tissueColor(percent(percents, 0.0)), glm::mix(soft, air, share)));
        EXPECT_TRUE(near(tissueColor(percent(0.0, percents)), glm::mix(soft, tagged, share)));
        EXPECT_TRUE(near(tissueColor(percent(10.0 + percents / 4, 10.0 + percents / 4)),
                         glm::mix(soft, both, 0.2 + share / 2)));
    }
}

TEST(TissuePicture, APixelHasTheColorOfTheVoxelThatItLiesIn) {
    std::mt19937 random(5);
    Grid grid = axisAlignedGrid({14, 11, 9}, {0.8, 1.0, 2.0}, {-30.0, 12.0, 5.0});
    grid.patientFromVoxel[1][0] = 0.3;  // axes that are not square to each other
    Volume<TissueFractions> mixture(grid);
    for (auto& voxel : mixture.writable()) {
        voxel.air = std::uint8_t(random() % 256);
        voxel.tagged = std::uint8_t(random() % (256 - voxel.air));
    }
    for (const View plane : {View::axial, View::coronal, View::sagittal}) {
        const SliceView view{plane, grid.patientFromVoxelPoint({6.2, 5.4, 3.7}), 1.3, {}};
        const Image image = *tissuePicture(mixture, view, 61, 47);
        const SlicePlacement placement = *placeSlice(view, grid, 61, 47);
        ASSERT_EQ(image.rgb.size(), 3u * 61 * 47);
        int inside = 0;
        for (int y = 0; y < 47; ++y) {
            for (int x = 0; x < 61; ++x) {
                const glm::dvec3 mm = placement.topLeftMm + double(x) * placement.rightMm +
                                      double(y) * placement.downMm;
                const glm::ivec3 voxel(glm::round(grid.voxelFromPatientPoint(mm)));
                const glm::u8vec3 expected =
                    grid.contains(voxel) ? tissueColor(mixture.at(voxel)) : glm::u8vec3(0);
                inside += grid.contains(voxel);
                const std::uint8_t* at = &image.rgb[3 * std::size_t(y * 61 + x)];
                ASSERT_EQ(glm::u8vec3(at[0], at[1], at[2]), expected) << x << " " << y;
            }
        }
        EXPECT_GT(inside, 500);
    }
}

TEST(TissuePicture, FailsWhereASliceWould) {
    const Volume<TissueFractions> mixture(axisAlignedGrid({3, 3, 3}, glm::dvec3(1.0)),
                                          TissueFractions{});
    EXPECT_FALSE(tissuePicture(mixture, SliceView{View::endoscopic, {}, 1.0, {}}, 8, 8));
    EXPECT_FALSE(tissuePicture(mixture, SliceView{View::axial, {}, 0.5, {}}, 8, 8));
    const Image away =
        *tissuePicture(mixture, SliceView{View::axial, {0, 0, 1e300}, 1.0, {}}, 8, 8);
    EXPECT_EQ(away.rgb, std::vector<std::uint8_t>(3 * 64, 0));
}

}  // namespace
}  // namespace haustra::render
