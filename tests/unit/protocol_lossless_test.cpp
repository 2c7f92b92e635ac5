// The lossless codec: what goes in comes out, and hostile bytes only fail.
#include "protocol/framing.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra::protocol {
namespace {

using Bytes = std::vector<std::uint8_t>;
enum class Content { noise, gradient, black, shaded };

Bytes picture(int width, int height, Content content) {
    std::mt19937 random(std::uint32_t(width * 4099 + height));
    Bytes rgb;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double shade = 110 + 90 * std::sin(0.02 * x) * std::cos(0.03 * y);
            switch (content) {
                case Content::noise:
                    for (int c = 0; c < 3; ++c)
                        rgb.push_back(std::uint8_t(random()));
                    break;
                case Content::gradient:  // wraps, so that differences leave a byte's range
                    rgb.insert(rgb.end(), {std::uint8_t(7 * x), std::uint8_t(5 * y),
                                           std::uint8_t(3 * x + 250 * y)});
                    break;
                case Content::black:
                    rgb.insert(rgb.end(), {0, 0, 0});
                    break;
                case Content::shaded:
                    rgb.insert(rgb.end(), {std::uint8_t(shade + 40), std::uint8_t(shade),
                                           std::uint8_t(shade * 0.8)});
                    break;
            }
        }
    }
    return rgb;
}

TEST(Lossless, EveryPictureComesBackBitForBit) {
    const int sizes[][2] = {{1, 1},   {1, 97},    {97, 1},    {2, 2},    {3, 5},
                            {17, 31}, {128, 128}, {511, 257}, {2048, 3}, {3, 2048}};
    for (const auto& [width, height] : sizes) {
        for (const Content content :
             {Content::noise, Content::gradient, Content::black, Content::shaded}) {
            const Bytes rgb = picture(width, height, content);
            const auto back = decodeLossless(encodeLossless(rgb, width, height), width, height);
            ASSERT_TRUE(back) << width << 'x' << height;
            ASSERT_EQ(*back, rgb) << width << 'x' << height;
        }
    }
}

TEST(Lossless, APredictablePictureShrinksAndTheWorstFitsAFrame) {
    const Bytes smooth = picture(512, 512, Content::shaded);
    EXPECT_LT(encodeLossless(smooth, 512, 512).size(), smooth.size() / 3);
    EXPECT_LT(
        encodeLossless(picture(2048, 2048, Content::noise), 2048, 2048).size() + tileHeaderBytes,
        maxTileBytes);
}

TEST(Lossless, EveryTruncationIsRefused) {
    const Bytes bytes = encodeLossless(picture(19, 23, Content::shaded), 19, 23);
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_FALSE(decodeLossless(std::span(bytes).first(length), 19, 23)) << length;
}

TEST(Lossless, AnotherSizeIsRefused) {
    const Bytes bytes = encodeLossless(picture(16, 16, Content::noise), 16, 16);
    EXPECT_TRUE(decodeLossless(bytes, 16, 16));
    EXPECT_FALSE(decodeLossless(bytes, 16, 15));
    EXPECT_FALSE(decodeLossless(bytes, 17, 16));
    for (const auto& [width, height] : {std::pair(0, 16), {-1, 16}, {16, 2049}, {1 << 30, 1 << 30}})
        EXPECT_FALSE(decodeLossless(bytes, width, height)) << width << 'x' << height;
}

TEST(Lossless, DamageIsRefusedOrGivesAPictureOfTheSize) {
    const Bytes sound = encodeLossless(picture(40, 30, Content::shaded), 40, 30);
    std::mt19937 random(3);
    for (int n = 0; n < 20'000; ++n) {
        Bytes bytes = sound;
        for (int change = 0; change < 2; ++change)
            bytes[random() % bytes.size()] ^= std::uint8_t(1u << (random() % 8));
        const auto rgb = decodeLossless(bytes, 40, 30);
        ASSERT_TRUE(!rgb || rgb->size() == 40u * 30u * 3u);
    }
}

}  // namespace
}  // namespace haustra::protocol
