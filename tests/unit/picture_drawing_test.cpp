// Panels side by side, and marks on pictures.
#include "pictures/drawing.h"

#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace haustra::pictures {
namespace {

TEST(SideBySide, KeepsEveryPanelWhole) {
    std::mt19937 random(2);
    std::vector<Image> panels;
    for (const int width : {5, 1, 8}) {
        panels.push_back({width, 4, std::vector<std::uint8_t>(3u * 4 * std::size_t(width))});
        for (auto& value : panels.back().rgb)
            value = std::uint8_t(random() % 255);  // no white, which separates
    }
    const auto made = sideBySide(panels);
    ASSERT_TRUE(made);
    const Image& joined = *made;
    EXPECT_EQ(joined.width, 14 + 2 * separatorPixels);
    EXPECT_EQ(joined.height, 4);
    ASSERT_EQ(joined.rgb.size(), 3u * 4 * std::size_t(joined.width));
    for (int y = 0; y < 4; ++y) {
        auto pixel = joined.rgb.begin() + 3 * std::ptrdiff_t(joined.width) * y;
        for (std::size_t n = 0; n < panels.size(); ++n) {
            for (int value = 0; n > 0 && value < 3 * separatorPixels; ++value)
                EXPECT_EQ(*pixel++, 255);
            for (int value = 0; value < 3 * panels[n].width; ++value)
                EXPECT_EQ(*pixel++, panels[n].rgb[std::size_t(3 * panels[n].width * y + value)]);
        }
    }
    EXPECT_EQ(sideBySide({panels[0]})->rgb, panels[0].rgb);
    panels.back().height = 2;
    EXPECT_FALSE(sideBySide(panels));
}

Image noise(glm::ivec2 size) {
    std::mt19937 random(4);
    Image image = blankImage(size);
    for (auto& value : image.rgb)
        value = std::uint8_t(random());
    return image;
}

Marks someMarks() {
    Marks marks;
    marks.textHeight = 9.0;
    marks.words = {{"left, above", {3, 4}, {0.0, 0.0}, {255, 230, 0}},
                   {"400 mm", {120, 60}, {1.0, 0.5}},
                   {"beyond the edge", {118, 88}, {0.2, 0.3}}};
    marks.lines = {{{0, 37}, {30, 37}, {255, 0, 0}}, {{60, 20}, {60, 26}}};
    return marks;
}

TEST(Marks, AreTheSamePixelsInWhateverBands) {
    const glm::ivec2 size(130, 90);
    Image whole = noise(size);
    ASSERT_TRUE(draw(someMarks(), whole));
    EXPECT_NE(whole.rgb, noise(size).rgb);
    for (const int rows : {1, 7, 32, 61}) {
        const Image plain = noise(size);
        std::vector<std::uint8_t> joined;
        for (int first = 0; first < size.y; first += rows) {
            const int count = std::min(rows, size.y - first);
            const auto begin = plain.rgb.begin() + 3 * size.x * first;
            Image band{size.x, count, {begin, begin + 3 * size.x * count}};
            ASSERT_TRUE(draw(someMarks(), band, first));
            joined.insert(joined.end(), band.rgb.begin(), band.rgb.end());
        }
        EXPECT_EQ(joined, whole.rgb) << rows;
    }
}

TEST(Marks, LeaveAllElseAsItWas) {
    const glm::ivec2 size(130, 90);
    Image image = noise(size);
    ASSERT_TRUE(draw({}, image));
    EXPECT_EQ(image.rgb, noise(size).rgb);
    Marks one;
    one.lines = {{{20, 30}, {60, 30}, {10, 200, 30}}};
    ASSERT_TRUE(draw(one, image));
    const Image plain = noise(size);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const std::size_t at = 3 * std::size_t(y * size.x + x);
            const glm::u8vec3 now(image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]),
                before(plain.rgb[at], plain.rgb[at + 1], plain.rgb[at + 2]);
            if (y < 27 || y > 33 || x < 16 || x > 64) {
                ASSERT_EQ(now, before) << x << " " << y;
            }
            if (y == 30 && x > 22 && x < 58) {
                ASSERT_EQ(now, glm::u8vec3(10, 200, 30)) << x;
            }
        }
    }
}

// It takes that room and no more, but for its rim.
TEST(Marks, TextIsAsWideAsItIsSaidToBe) {
    const glm::ivec2 size(400, 60);
    for (const double height : {6.0, 11.4, 24.0}) {
        const std::string text = "Case.x-7 mm";
        const double width = textWidth(text, height).value();
        Image image = blankImage(size);
        Marks marks;
        marks.textHeight = height;
        marks.words = {{text, {20, 20}, {0.0, 0.0}}};
        ASSERT_TRUE(draw(marks, image));
        int first = size.x, last = 0;
        for (int i = 0; i < size.x * size.y; ++i)
            if (image.rgb[3 * std::size_t(i)] > 0) {
                first = std::min(first, i % size.x);
                last = std::max(last, i % size.x);
            }
        EXPECT_GE(first, 20 - 2) << height;
        EXPECT_LE(last, 20 + width + 2) << height;
        EXPECT_NEAR(last - first, width, 0.1 * width) << height;
    }
}

}  // namespace
}  // namespace haustra::pictures
