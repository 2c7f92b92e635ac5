// Pictures in files: the same bytes in whatever bands, and nothing where the picture is not whole.
#include "render/png_file.h"

#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::render {
namespace {

namespace fs = std::filesystem;

class PngFiles : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("haustra-png-" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static Image noise(int width, int height) {
        Image image{width, height, {}};
        std::mt19937 random(3);
        for (int i = 0; i < 3 * width * height; ++i)
            image.rgb.push_back(std::uint8_t(random()));
        return image;
    }
    static Image band(const Image& image, int first, int rows) {
        const auto begin = image.rgb.begin() + 3 * std::ptrdiff_t(image.width) * first;
        return {image.width, rows, {begin, begin + 3 * std::ptrdiff_t(image.width) * rows}};
    }
    static std::string content(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    fs::path folder_;
};

TEST_F(PngFiles, BandsChangeNoByte) {
    const Image image = noise(37, 50);
    ASSERT_TRUE(writePng(folder_ / "whole.png", image));
    auto png = PngFile::create(folder_ / "bands.png", 37, 50);
    ASSERT_TRUE(png);
    for (const auto& [first, rows] : {std::pair(0, 20), {20, 0}, {20, 1}, {21, 29}})
        ASSERT_TRUE(png->append(band(image, first, rows)));
    EXPECT_FALSE(fs::exists(folder_ / "bands.png"));
    ASSERT_TRUE(png->finish());
    EXPECT_FALSE(content(folder_ / "whole.png").empty());
    EXPECT_EQ(content(folder_ / "whole.png"), content(folder_ / "bands.png"));
}

TEST_F(PngFiles, APictureThatIsNotWholeLeavesNothing) {
    const Image image = noise(20, 10);
    {
        auto png = PngFile::create(folder_ / "half.png", 20, 10);
        ASSERT_TRUE(png->append(band(image, 0, 4)));
        EXPECT_FALSE(png->finish());
        EXPECT_FALSE(png->append(noise(19, 2)));
        EXPECT_FALSE(png->append(noise(20, 7)));
    }
    EXPECT_TRUE(fs::is_empty(folder_));
    EXPECT_FALSE(PngFile::create(folder_ / "none.png", 0, 10));
    EXPECT_FALSE(PngFile::create(folder_ / "missing" / "a.png", 2, 2));
    EXPECT_FALSE(writePng(folder_ / "wrong.png", {4, 4, {1, 2, 3}}));
    EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace haustra::render
