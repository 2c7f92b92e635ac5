#include "core/strip_layout.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

struct Picture {
    double height;
    glm::ivec2 size;
};

std::vector<Picture> pictures() {
    std::vector<Picture> all{{17.3, {1, 1}},       {0.01, {1, 1}},     {1e-6, {640, 480}},
                             {1e6, {640, 480}},    {17.3, {1, 900}},   {17.3, {900, 1}},
                             {20.0, {1024, 1024}}, {20.0, {400, 8000}}};
    std::mt19937 random(7);
    for (int n = 0; n < 300; ++n) {
        all.push_back({std::exp(-2.0 + 7.0 * double(random()) / 4294967296.0),
                       {1 + int(random() % 2000), 1 + int(random() % 1200)}});
    }
    return all;
}

glm::dvec2 randomFlat(std::mt19937& random, double height) {
    return {double(random()) / 4294967296.0, height * double(random()) / 4294967296.0};
}

TEST(StripLayout, ColumnsLieApartInThePicture) {
    for (const auto& [height, size] : pictures()) {
        const StripLayout layout = layOutStrip(height, size);
        ASSERT_FALSE(layout.columns.empty());
        int free = 0;
        for (const StripColumn& column : layout.columns) {
            EXPECT_GE(column.left, free);
            EXPECT_GE(column.size.x, 1);
            EXPECT_EQ(column.size.y, size.y);
            free = column.left + column.size.x + StripLayout::gutter;
        }
        EXPECT_LE(free - StripLayout::gutter, size.x);
    }
}

TEST(StripLayout, EveryPlaceIsDrawnWithinItsColumn) {
    std::mt19937 random(11);
    for (const auto& [height, size] : pictures()) {
        const StripLayout layout = layOutStrip(height, size);
        for (int n = 0; n < 50; ++n) {
            const glm::dvec2 flat = randomFlat(random, height);
            const glm::dvec2 pixel = layout.pixelFromFlat(flat);
            const auto column = std::size_t(flat.y / layout.unitsPerColumn);
            ASSERT_LT(column, layout.columns.size());
            const StripColumn& c = layout.columns[column];
            EXPECT_GE(pixel.x, c.left);
            EXPECT_LE(pixel.x, c.left + c.size.x);
            EXPECT_GE(pixel.y, 0.0);
            EXPECT_LE(pixel.y, size.y);
        }
    }
}

TEST(StripLayout, PlaceToPixelAndBack) {
    std::mt19937 random(13);
    for (const auto& [height, size] : pictures()) {
        const StripLayout layout = layOutStrip(height, size);
        for (int n = 0; n < 50; ++n) {
            const glm::dvec2 flat = randomFlat(random, height);
            const auto back = layout.flatFromPixel(layout.pixelFromFlat(flat), height);
            ASSERT_TRUE(back);
            EXPECT_NEAR(back->x, flat.x, 1e-9);
            EXPECT_NEAR(back->y, flat.y, 1e-9 * (1.0 + height));
        }
    }
}

TEST(StripLayout, PixelToPlaceAndBackNamesTheCopyInTheMiddle) {
    std::mt19937 random(17);
    for (const auto& [height, size] : pictures()) {
        const StripLayout layout = layOutStrip(height, size);
        for (int n = 0; n < 50; ++n) {
            const glm::dvec2 pixel = (glm::dvec2(random() % size.x, random() % size.y)) + 0.5;
            const auto flat = layout.flatFromPixel(pixel, height);
            if (!flat) continue;
            const double pixelsPerUnit = layout.columns[0].window.pixelsPerUnit;
            EXPECT_GE(flat->x, -StripLayout::seamMargin - 1.0 / pixelsPerUnit);
            EXPECT_LE(flat->x, 1.0 + StripLayout::seamMargin + 1.0 / pixelsPerUnit);
            const glm::dvec2 back = layout.pixelFromFlat(*flat);
            EXPECT_NEAR(back.x, pixel.x - std::floor(flat->x) * -pixelsPerUnit, 1e-6);
            EXPECT_NEAR(back.y, pixel.y, 1e-6);
        }
    }
}

TEST(StripLayout, GuttersAndWhatIsBeyondTheStripShowNothing) {
    const StripLayout layout = layOutStrip(20.0, {1024, 768});
    ASSERT_GT(layout.columns.size(), 1u);
    const StripColumn& first = layout.columns.front();
    EXPECT_FALSE(layout.flatFromPixel({first.left + first.size.x + 2.0, 100.0}, 20.0));
    EXPECT_FALSE(layout.flatFromPixel({-1.0, 100.0}, 20.0));
    EXPECT_FALSE(layout.flatFromPixel({first.left + 1.0, 768.5}, 20.0));
    const double beyond = layout.columns.size() * layout.unitsPerColumn - 20.0;
    if (beyond > 0.0) {
        const StripColumn& last = layout.columns.back();
        EXPECT_FALSE(layout.flatFromPixel({last.left + 1.0, 0.0}, 20.0));
    }
}

TEST(StripLayout, SeamIsShownOnBothSides) {
    const StripLayout layout = layOutStrip(20.0, {1400, 1000});
    for (const StripColumn& column : layout.columns) {
        const auto left = column.window.flatFromPixel({0.0, 10.0}, column.size);
        const auto right = column.window.flatFromPixel({column.size.x, 10.0}, column.size);
        EXPECT_GE(left.x, 1.0 + StripLayout::seamMargin - 1e-9);
        EXPECT_LE(right.x, -StripLayout::seamMargin + 1e-9);
    }
}

TEST(StripLayout, RectumIsAtTheBottomOfTheLeftColumn) {
    const StripLayout layout = layOutStrip(20.0, {1400, 1000});
    EXPECT_NEAR(layout.pixelFromFlat({0.5, 0.0}).y, 1000.0, 1e-9);
    EXPECT_LT(layout.pixelFromFlat({0.5, 0.0}).x, layout.pixelFromFlat({0.5, 20.0}).x);
}

// The scale of any number of columns: each must hold the circumference with both margins, all
// together the height.
TEST(StripLayout, NoOtherNumberOfColumnsShowsItLarger) {
    for (const auto& [height, size] : pictures()) {
        double best = 0.0;
        for (int n = 1; n <= size.x; ++n) {
            const int width = (size.x - (n - 1) * StripLayout::gutter) / n;
            if (width < 1) break;
            best = std::max(best, std::min(width / (1.0 + 2.0 * StripLayout::seamMargin),
                                           double(n) * size.y / height));
        }
        const StripLayout layout = layOutStrip(height, size);
        EXPECT_DOUBLE_EQ(layout.columns[0].window.pixelsPerUnit, best);
        EXPECT_GE(layout.columns.size() * layout.unitsPerColumn, height * (1.0 - 1e-12));
    }
}

}  // namespace
}  // namespace haustra
