// Cameras, transfer functions and windows, where no GL is needed.
#include "render/optics/transfer_table.h"
#include "render/scene/picture.h"

#include <cmath>

#include <gtest/gtest.h>

namespace haustra::render {
namespace {

TEST(TransferFunction, PresetsPassTheirOwnCheck) {
    for (const std::string& name : opticsPresets()) {
        const auto preset = opticsPreset(name);
        ASSERT_TRUE(preset) << name;
        EXPECT_TRUE(checkOptics(*preset)) << name;
    }
    const auto unknown = opticsPreset("marble");
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("mucosa"), std::string::npos);
}

TEST(TransferTable, OpacityOfManyShortStepsIsThatOfOneLong) {
    const TransferFunction function{
        {{-100.0, {1, 1, 1}, 0.0}, {0.0, {1, 0, 0}, 0.3}, {200.0, {0, 0, 1}, 0.9}}};
    const TransferTable whole = makeTransferTable({function}, 1.0),
                        quarter = makeTransferTable({function}, 0.25);
    for (std::size_t i = 0; i < whole.rgba.size(); i += 97)
        EXPECT_NEAR(1.0 - std::pow(1.0 - quarter.rgba[i].a, 4.0), whole.rgba[i].a, 1e-5);
}

TEST(TransferTable, NothingOutsideTheVisibleRangeHasOpacity) {
    const TransferFunction function{{{-1000.0, {1, 1, 1}, 0.0},
                                     {-700.0, {1, 1, 1}, 0.0},
                                     {-500.0, {1, 1, 1}, 0.5},
                                     {300.0, {1, 1, 1}, 0.0}}};
    const TransferTable table = makeTransferTable({function}, 0.5);
    const double entryHu = 1300.0 / (TransferTable::entries - 1);
    EXPECT_NEAR(table.visibleAboveHu, -700.0, entryHu);
    EXPECT_NEAR(table.visibleBelowHu, 300.0, entryHu);
    EXPECT_FALSE(table.anyVisible(-1024.0, -702.0));
    EXPECT_TRUE(table.anyVisible(-1024.0, -690.0));
    EXPECT_TRUE(table.anyVisible(-600.0, -600.0));
    EXPECT_FALSE(table.anyVisible(302.0, 3000.0));
    EXPECT_TRUE(table.anyVisible(-2000.0, 3000.0));
    const TransferFunction open{{{-100.0, {1, 1, 1}, 0.1}, {100.0, {1, 1, 1}, 0.1}}};
    EXPECT_TRUE(std::isinf(makeTransferTable({open}, 1.0).visibleAboveHu));
    EXPECT_TRUE(makeTransferTable({open}, 1.0).anyVisible(-5000.0, -4000.0));
}

TEST(View, NamesGoThereAndBack) {
    for (const View view : allViews)
        EXPECT_EQ(*viewFromString(toString(view)), view);
    EXPECT_FALSE(viewFromString("sideways"));
}

TEST(Camera, ChecksItsFieldOfViewAndDirections) {
    EXPECT_TRUE(checkCamera({}));
    EXPECT_FALSE(checkCamera({{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 90.0}));
    EXPECT_FALSE(checkCamera({{0, 0, 0}, {0, 2, 0}, {0, -1, 0}, 90.0}));
    EXPECT_FALSE(checkCamera({{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 180.0}));
    EXPECT_FALSE(checkCamera({{0, NAN, 0}, {0, 0, 1}, {0, 1, 0}, 90.0}));
}

TEST(Overview, ChecksWhatItShows) {
    OverviewView view;
    view.optics = *opticsPreset("translucent");
    view.reader = Camera{};
    view.bookmarksMm = {{1, 2, 3}};
    EXPECT_TRUE(checkOverview(view));
    view.camera.lens = Lens::fisheye;
    EXPECT_FALSE(checkOverview(view));
    view.camera.lens = Lens::orthographic;
    EXPECT_TRUE(checkOverview(view));
    view.reader->up = view.reader->forward;
    EXPECT_FALSE(checkOverview(view));
    view.reader.reset();
    view.bookmarksMm.push_back({0, NAN, 0});
    EXPECT_FALSE(checkOverview(view));
    view.bookmarksMm.assign(maxOverviewBookmarks + 1, glm::dvec3(0.0));
    EXPECT_FALSE(checkOverview(view));
}

TEST(Window, EndsAreBlackAndWhite) {
    const WindowLevel window{-50.0, 400.0};
    EXPECT_EQ(windowed(-251.0, window), 0.0);
    EXPECT_EQ(windowed(151.0, window), 255.0);
    EXPECT_NEAR(windowed(-50.0, window), 127.5, 1e-9);
}

}  // namespace
}  // namespace haustra::render
