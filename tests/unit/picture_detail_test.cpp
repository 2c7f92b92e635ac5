// How many pixels a moving picture gets, and that it shows the same with fewer.
#include "session/picture_detail.h"

#include "session/picture_job.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace haustra::session {
namespace {

TEST(PictureDetail, SizesDoNotFlicker) {
    PictureDetail detail;
    const glm::ivec2 full(512);
    EXPECT_EQ(detail.nextSize(full, 1.0), full);
    for (int n = 0; n < 3; ++n)
        detail.drawn(52.0, full);
    EXPECT_EQ(detail.nextSize(full, 1.0), glm::ivec2(384));
    for (int n = 0; n < 3; ++n)
        detail.drawn(48.0, full);  // just in time: not enough to go back
    EXPECT_EQ(detail.nextSize(full, 1.0), glm::ivec2(384));
    for (int n = 0; n < 3; ++n)
        detail.drawn(39.0, full);
    EXPECT_EQ(detail.nextSize(full, 1.0), full);
    detail.drawn(5000.0, full);  // one that was slow
    EXPECT_EQ(detail.nextSize(full, 1.0), full);
    for (int n = 0; n < 3; ++n)
        detail.drawn(5000.0, full);
    EXPECT_EQ(detail.nextSize(full, 1.0), glm::ivec2(128));
    EXPECT_EQ(detail.nextSize({32, 20}, 0.001), glm::ivec2(26, 16));
}

TEST(PictureDetail, CoarsePicturesShowTheSame) {
    std::mt19937 random(11);
    std::uniform_int_distribution<int> anySide(1, 2048);
    std::vector<glm::ivec2> sizes{{1600, 20}, {20, 1600}, {2048, 17}, {2048, 16},  {2048, 1},
                                  {1, 2048},  {1, 1},     {512, 512}, {2048, 2047}};
    for (int n = 0; n < 2000; ++n)
        sizes.emplace_back(anySide(random), anySide(random));
    for (const glm::ivec2 full : sizes) {
        glm::ivec2 finer = full;
        for (const double scale : detailSteps) {
            const glm::ivec2 size = coarseSize(full, scale);
            if (scale == 1.0) {
                ASSERT_EQ(size, full);
            }
            ASSERT_TRUE(size.x <= finer.x && size.y <= finer.y && size.x >= 1 && size.y >= 1);
            ASSERT_GE(std::min(size.x, size.y), std::min({full.x, full.y, leastSide}));
            // What it shows along one side, were the other's edges the same, is off by half a
            // pixel.
            const double longer = std::max(size.x, size.y), shorter = std::min(size.x, size.y);
            const double wanted = shorter * std::max(full.x, full.y) / std::min(full.x, full.y);
            ASSERT_LE(std::abs(longer - wanted), 0.5 + 1e-9) << full.x << " " << full.y;
            // And it is as coarse as asked, where that leaves pixels enough.
            if (scale * std::min(full.x, full.y) >= leastSide) {
                ASSERT_NEAR(shorter, scale * std::min(full.x, full.y), 0.5 + 1e-9);
            }
            finer = size;
        }
    }
}

TEST(PictureDetail, CoarseFlatWindowsShowTheSame) {
    for (const glm::ivec2 full : {glm::ivec2(1600, 20), {20, 1600}, {1000, 333}, {333, 1000}}) {
        render::FlatView view;
        view.window = {{0.4, 0.3}, 300.0};
        const glm::ivec2 size = coarseSize(full, 0.25);
        const auto coarse = std::get<render::FlatView>(scaledView(view, full.x, size.x)).window;
        for (const glm::dvec2 corner : {glm::dvec2(0.0), {1.0, 0.0}, {1.0, 1.0}}) {
            const glm::dvec2 shown = coarse.flatFromPixel(corner * glm::dvec2(size), size);
            const glm::dvec2 wanted = view.window.flatFromPixel(corner * glm::dvec2(full), full);
            EXPECT_LE(std::abs(shown.x - wanted.x) * coarse.pixelsPerUnit, 0.5) << full.x;
            EXPECT_LE(std::abs(shown.y - wanted.y) * coarse.pixelsPerUnit, 0.5) << full.x;
        }
    }
}

}  // namespace
}  // namespace haustra::session
