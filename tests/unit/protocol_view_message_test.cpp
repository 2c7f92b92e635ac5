// Views cross the link unchanged, and what is not sound does not cross it.
#include "protocol/limits.h"
#include "protocol/view_message.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra::protocol {
namespace {

class Views {
public:
    double within(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    bool flip() { return random_() % 2 == 0; }
    glm::dvec3 place() {
        return {within(-maxCoordinateMm, maxCoordinateMm), within(-500, 500), within(-500, 500)};
    }
    haustra::Camera camera(haustra::Lens lens) {
        haustra::Camera camera{place(), {0.1, within(-1, 1), 1.0}, {0.0, -1.0, within(-1, 0)}};
        camera.lens = lens;
        if (lens == haustra::Lens::orthographic)
            camera.heightMm = within(1, 900);
        else
            camera.fovDegrees = within(1, lens == haustra::Lens::fisheye ? 360 : 170);
        return camera;
    }
    Scan scan() { return flip() ? Scan::cleansed : Scan::original; }
    haustra::Slab slab() {
        return {flip() ? within(0, maxSlabMm) : 0.0,
                flip() ? haustra::Projection::maximum : haustra::Projection::mean};
    }
    /// Sound, and of this view.
    ViewState stateOf(haustra::View view) {
        using enum haustra::Lens;
        switch (view) {
            case haustra::View::endoscopic:
                return camera(std::array{perspective, fisheye, orthographic}[random_() % 3]);
            case haustra::View::axial:
            case haustra::View::coronal:
            case haustra::View::sagittal:
                return SliceView{view,  place(), within(1, maxSliceZoom),
                                 {},    scan(),  {within(-maxPanMm, maxPanMm), within(-300, 300)},
                                 slab()};
            case haustra::View::flattened:
                return WholeStrip{};
            case haustra::View::flattenedZoom:
                return FlatWindow{{within(0, 0.999), within(-maxFlatHeight, maxFlatHeight)},
                                  within(minPixelsPerCircumference, maxPixelsPerCircumference)};
            case haustra::View::oblique:
                return ObliqueView{
                    place(), {0, 0, 2}, {0, 1, 0}, within(minObliqueMm, maxObliqueMm),
                    {},      scan(),    slab()};
            case haustra::View::overview:
                break;
        }
        Overview overview;
        overview.camera = camera(flip() ? perspective : orthographic);
        if (flip()) overview.reader = camera(fisheye);
        for (std::size_t n = random_() % 20; n > 0; --n)
            overview.bookmarksMm.push_back(place());
        overview.path = flip();
        overview.body = flip();
        return overview;
    }

private:
    std::mt19937 random_{7};
};

ClientMessage overTheWire(const ClientMessage& sent) {
    ClientMessage message;
    EXPECT_TRUE(message.ParseFromString(sent.SerializeAsString()));
    return message;
}

TEST(ViewMessage, EveryStateComesBackAsItWasSent) {
    Views views;
    for (int n = 0; n < 200; ++n) {
        for (const haustra::View view : allViews) {
            const ViewState state = views.stateOf(view);
            ASSERT_EQ(viewOf(state), view);
            const InputHeader header{std::uint64_t(n + 1), std::uint32_t(n % 8), views.flip()};
            const ClientMessage message = overTheWire(stateMessage(header, state));
            const auto told = inputHeader(message);
            ASSERT_TRUE(told);
            EXPECT_EQ(told->sequence, header.sequence);
            EXPECT_EQ(told->viewport, header.viewport);
            EXPECT_EQ(told->moving, header.moving);
            const auto back = stateFrom(message, view);
            ASSERT_TRUE(back) << toString(view) << ": " << describe(back.error());
            EXPECT_EQ(*back, state) << toString(view);
            for (const haustra::View other : allViews) {
                // Slices share a message, and so do both views of the strip.
                const bool takes =
                    (isSlice(view) && isSlice(other)) || (isFlat(view) && isFlat(other));
                if (other != view && !takes) {
                    EXPECT_FALSE(stateFrom(message, other)) << toString(view) << toString(other);
                }
            }
        }
    }
}

TEST(ViewMessage, ViewsWindowsAndPaintComeBackAsTheyWereSent) {
    for (const haustra::View view : allViews) {
        const auto message = overTheWire(viewportMessage({5, 3}, view, 640, 480));
        EXPECT_EQ(*viewFrom(message.set_viewport().view()), view);
        EXPECT_EQ(message.set_viewport().width(), 640u);
        EXPECT_EQ(inputHeader(message)->viewport, 3u);
        EXPECT_FALSE(message.set_viewport().lens());
    }
    EXPECT_TRUE(overTheWire(viewportMessage({6, 8}, haustra::View::endoscopic, 64, 64, true))
                    .set_viewport()
                    .lens());
    EXPECT_FALSE(viewFrom(VIEW_UNSPECIFIED));
    EXPECT_FALSE(viewFrom(View(99)));
    const haustra::WindowLevel window{40.0, 400.0};
    EXPECT_EQ(*windowFrom(overTheWire(windowMessage({6, 1}, window)).set_window_level().window()),
              window);
    const WallPaintChoice paint{true, false, 12.0};
    EXPECT_EQ(*paintFrom(overTheWire(paintMessage(7, paint)).set_wall_paint()), paint);
    SetWallPaint usual;
    EXPECT_EQ(*paintFrom(usual), WallPaintChoice{});
}

TEST(ViewMessage, TheDetectionChoiceComesBackAsItWasSent) {
    for (const DetectionChoice& choice :
         {DetectionChoice{}, DetectionChoice{DetectionMode::secondReader},
          DetectionChoice{DetectionMode::secondReader, true, 0.0},
          DetectionChoice{DetectionMode::concurrent, false, 1.0}}) {
        const auto message = detectionMessage(7, choice);
        EXPECT_EQ(message.set_detection().sequence(), 7u);
        const auto back = detectionFrom(message.set_detection());
        ASSERT_TRUE(back);
        EXPECT_EQ(*back, choice);
    }
    SetDetection wrong;
    for (const double least : {1.01, -0.01, std::nan("")}) {
        wrong.set_least_probability(least);
        EXPECT_FALSE(detectionFrom(wrong));
    }
    wrong.set_least_probability(0.5);
    EXPECT_TRUE(detectionFrom(wrong));
    wrong.set_mode(SetDetection::Mode(3));
    EXPECT_FALSE(detectionFrom(wrong));
}

TEST(ViewMessage, MessagesThatAreNoInputOfAViewportHaveNoHeader) {
    ClientMessage message;
    EXPECT_FALSE(inputHeader(message));
    message.mutable_ping()->set_request(3);
    EXPECT_FALSE(inputHeader(message));
    EXPECT_FALSE(inputHeader(paintMessage(1, {})));
    EXPECT_FALSE(stateFrom(message, haustra::View::axial));
    EXPECT_FALSE(
        stateFrom(viewportMessage({1, 0}, haustra::View::axial, 64, 64), haustra::View::axial));
}

TEST(ViewMessage, WhatIsOutOfBoundsIsRefused) {
    Views views;
    const auto refused = [](const ViewState& state) {
        return !stateFrom(overTheWire(stateMessage({1, 0}, state)), viewOf(state));
    };
    for (const double bad : {double(NAN), double(INFINITY), 1.01 * maxCoordinateMm}) {
        haustra::Camera camera;
        camera.positionMm.y = bad;
        EXPECT_TRUE(refused(camera));
        EXPECT_TRUE(refused(SliceView{haustra::View::coronal, {0, 0, bad}}));
        EXPECT_TRUE(refused(ObliqueView{{bad, 0, 0}}));
        Overview overview;
        overview.bookmarksMm = {{0, bad, 0}};
        EXPECT_TRUE(refused(overview));
        EXPECT_TRUE(refused(FlatWindow{{bad, 0.0}, 512.0}));
    }
    for (const double bad : {-0.01, 1.01 * maxSlabMm, double(NAN), double(INFINITY)}) {
        SliceView slice;
        slice.slab.thicknessMm = bad;
        EXPECT_TRUE(refused(slice));
        ObliqueView oblique;
        oblique.slab.thicknessMm = bad;
        EXPECT_TRUE(refused(oblique));
    }
    for (const double bad : {1.01 * maxPanMm, -1.01 * maxPanMm, double(NAN)}) {
        SliceView slice;
        slice.panMm.x = bad;
        EXPECT_TRUE(refused(slice));
        slice.panMm = {0.0, bad};
        EXPECT_TRUE(refused(slice));
    }
    Slab strange;
    strange.set_projection(Projection(2));
    EXPECT_FALSE(slabFrom(strange));
    EXPECT_TRUE(refused(SliceView{haustra::View::axial, {}, 1.01 * maxSliceZoom}));
    EXPECT_TRUE(refused(SliceView{haustra::View::axial, {}, 0.99}));
    EXPECT_TRUE(refused(ObliqueView{{}, {0, 0, 1}, {0, 0, 1}}));
    EXPECT_TRUE(refused(ObliqueView{{}, {0, 0, 1}, {0, 1, 0}, 1.01 * maxObliqueMm}));
    EXPECT_TRUE(refused(FlatWindow{{0.5, 1.01 * maxFlatHeight}, 512.0}));
    EXPECT_TRUE(refused(FlatWindow{{0.5, 1.0}, 0.99 * minPixelsPerCircumference}));
    Overview overview;
    overview.camera = views.camera(haustra::Lens::fisheye);
    EXPECT_TRUE(refused(overview));
    overview.camera = views.camera(haustra::Lens::orthographic);
    overview.bookmarksMm.resize(maxOverviewBookmarks);
    EXPECT_FALSE(refused(overview));
    overview.bookmarksMm.resize(maxOverviewBookmarks + 1);
    EXPECT_TRUE(refused(overview));
    WindowLevel window;
    EXPECT_FALSE(windowFrom(window));  // 0 HU wide
    SetWallPaint paint;
    paint.set_mark_radius_mm(1.01 * maxMarkRadiusMm);
    EXPECT_FALSE(paintFrom(paint));
}

}  // namespace
}  // namespace haustra::protocol
