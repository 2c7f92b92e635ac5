// Tiles: decoding, assembly in any order, hostile bytes, PNG files.
#include "picture_files.h"
#include "temporary_folder.h"
#include "tiles/picture_stream.h"
#include "tiles/png_file.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>

#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <turbojpeg.h>
#include <unistd.h>

namespace haustra::tiles {
namespace {

using protocol::TileCodec;
using protocol::TileHeader;
using Bytes = std::vector<std::uint8_t>;

Bytes smoothPicture(int width, int height, double phase) {
    Bytes rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                rgb.push_back(std::uint8_t(128 + 90 * std::sin(0.05 * x + 0.03 * y + c + phase)));
    return rgb;
}

Bytes cut(const Bytes& rgb, int pictureWidth, int x, int y, int width, int height) {
    Bytes tile;
    for (int row = y; row < y + height; ++row) {
        const auto start = rgb.begin() + (row * pictureWidth + x) * 3;
        tile.insert(tile.end(), start, start + width * 3);
    }
    return tile;
}

Bytes encodeJpeg(const Bytes& rgb, int width, int height, int subsampling = TJSAMP_444) {
    tjhandle handle = tjInitCompress();
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    tjCompress2(handle, rgb.data(), width, width * 3, height, TJPF_RGB, &bytes, &size, subsampling,
                90, 0);
    Bytes jpeg(bytes, bytes + size);
    tjFree(bytes);
    tjDestroy(handle);
    return jpeg;
}

Bytes payload(const TileHeader& header, const Bytes& codecBytes) {
    Bytes bytes;
    protocol::appendTileHeader(bytes, header);
    bytes.insert(bytes.end(), codecBytes.begin(), codecBytes.end());
    return bytes;
}

// The payloads of a picture in tiles of 64 pixels, the last one flagged.
std::vector<Bytes> tilesOf(const Bytes& rgb, int width, int height, std::uint32_t number,
                           std::uint64_t sequence, TileCodec codec = TileCodec::lossless,
                           int subsampling = TJSAMP_444) {
    std::vector<Bytes> tiles;
    for (int y = 0; y < height; y += 64) {
        for (int x = 0; x < width; x += 64) {
            TileHeader header;
            header.codec = codec;
            header.exact = codec == TileCodec::lossless;
            header.picture = number;
            header.sequence = sequence;
            header.pictureWidth = std::uint16_t(width);
            header.pictureHeight = std::uint16_t(height);
            header.x = std::uint16_t(x);
            header.y = std::uint16_t(y);
            header.width = std::uint16_t(std::min(64, width - x));
            header.height = std::uint16_t(std::min(64, height - y));
            header.last = x + 64 >= width && y + 64 >= height;
            const Bytes tile = cut(rgb, width, x, y, header.width, header.height);
            tiles.push_back(
                payload(header, codec == TileCodec::jpeg
                                    ? encodeJpeg(tile, header.width, header.height, subsampling)
                                    : protocol::encodeLossless(tile, header.width, header.height)));
        }
    }
    return tiles;
}

std::optional<Picture> feed(PictureStream& stream, const Bytes& bytes) {
    auto picture = stream.add(bytes);
    EXPECT_TRUE(picture) << describe(picture.error());
    return std::move(*picture);
}

void expectOpaque(const Picture& picture) {
    ASSERT_EQ(picture.pixels.size(), std::size_t(picture.width) * std::size_t(picture.height) * 4);
    for (std::size_t n = 3; n < picture.pixels.size(); n += 4)
        ASSERT_EQ(picture.pixels[n], 255) << "pixel " << n / 4;
}

TEST(PictureStream, TilesInAnyOrderGiveTheSamePicture) {
    const Bytes rgb = smoothPicture(200, 150, 0.0);
    std::mt19937 random(5);
    PictureStream stream;
    for (std::uint32_t number = 1; number <= 20; ++number) {
        auto tiles = tilesOf(rgb, 200, 150, number, number * 10);
        std::shuffle(tiles.begin(), tiles.end(), random);
        for (std::size_t n = 0; n < tiles.size(); ++n) {
            const auto picture = feed(stream, tiles[n]);
            ASSERT_EQ(picture.has_value(), n + 1 == tiles.size());
            if (!picture) continue;
            EXPECT_EQ(rgbOf(*picture), rgb);
            expectOpaque(*picture);
            EXPECT_EQ(picture->number, number);
            EXPECT_EQ(picture->sequence, number * 10);
            EXPECT_TRUE(picture->exact);
        }
    }
}

// Tiles are decoded in place: one that wrote past its edge would spoil its neighbour.
TEST(PictureStream, NoJpegTileWritesIntoAnother) {
    std::mt19937 random(7);
    PictureStream stream;
    std::uint32_t number = 0;
    for (const int subsampling : {TJSAMP_444, TJSAMP_422, TJSAMP_420}) {
        for (const glm::ivec2 size : {glm::ivec2(200, 150), {65, 129}, {191, 67}, {64, 64}}) {
            const Bytes rgb = smoothPicture(size.x, size.y, 0.4);
            std::optional<Pixels> first;
            for (int order = 0; order < 12; ++order) {
                auto tiles =
                    tilesOf(rgb, size.x, size.y, ++number, 1, TileCodec::jpeg, subsampling);
                if (order > 0) std::shuffle(tiles.begin(), tiles.end(), random);
                std::optional<Picture> picture;
                for (const Bytes& tile : tiles)
                    picture = feed(stream, tile);
                ASSERT_TRUE(picture);
                expectOpaque(*picture);
                if (!first) first = picture->pixels;
                ASSERT_EQ(picture->pixels, *first) << size.x << "x" << size.y;
            }
        }
    }
}

TEST(PictureStream, StaleTilesAreIgnoredAndANewerPictureWins) {
    const Bytes older = smoothPicture(128, 64, 0.0), newer = smoothPicture(128, 64, 2.0);
    const auto a = tilesOf(older, 128, 64, 4, 40), b = tilesOf(newer, 128, 64, 5, 50);
    PictureStream stream;
    EXPECT_FALSE(feed(stream, a[0]));
    EXPECT_FALSE(feed(stream, b[0]));  // abandons picture 4
    EXPECT_FALSE(feed(stream, a[1]));  // would have finished it
    const auto picture = feed(stream, b[1]);
    ASSERT_TRUE(picture);
    EXPECT_EQ(rgbOf(*picture), newer);
    EXPECT_FALSE(feed(stream, b[1]));  // already finished
    stream.reset();
    EXPECT_FALSE(feed(stream, tilesOf(older, 128, 64, 1, 60)[0]));
    EXPECT_TRUE(feed(stream, tilesOf(older, 128, 64, 1, 60)[1]));
}

TEST(PictureStream, WithoutTheLastFlagOrWithAHoleNothingIsFinished) {
    const auto tiles = tilesOf(smoothPicture(192, 64, 0.0), 192, 64, 1, 1);
    PictureStream hole;
    EXPECT_FALSE(feed(hole, tiles[0]));
    EXPECT_FALSE(feed(hole, tiles[0]));
    EXPECT_FALSE(feed(hole, tiles[2]));
    EXPECT_TRUE(feed(hole, tiles[1]));
}

TEST(PictureStream, ATileThatContradictsItsPictureIsRefused) {
    const auto tiles = tilesOf(smoothPicture(128, 64, 0.0), 128, 64, 1, 1);
    for (int what = 0; what < 3; ++what) {
        PictureStream stream;
        ASSERT_FALSE(feed(stream, tiles[0]));
        TileHeader header = *protocol::parseTileHeader(tiles[1]);
        if (what == 0) header.pictureHeight = 65;
        if (what == 1) header.sequence = 2;
        if (what == 2) header.exact = false;
        const auto second = stream.add(
            payload(header, Bytes(tiles[1].begin() + protocol::tileHeaderBytes, tiles[1].end())));
        ASSERT_FALSE(second);
        EXPECT_NE(second.error().message.find("contradicts"), std::string::npos);
    }
}

// The same payload, of another viewport.
Bytes ofViewport(Bytes payload, std::uint8_t viewport) {
    payload[0] = viewport;
    return payload;
}

TEST(PictureStream, ViewportsDoNotDisturbEachOtherAndALostLinksTilesAreForgotten) {
    const Bytes rgb = smoothPicture(128, 64, 0.0), other = smoothPicture(128, 64, 1.0);
    const auto tiles = tilesOf(rgb, 128, 64, 7, 1), others = tilesOf(other, 128, 64, 2, 1);
    PictureStream stream;
    EXPECT_FALSE(*stream.add(tiles[0]));
    EXPECT_FALSE(*stream.add(ofViewport(others[0], 1)));
    const auto first = *stream.add(tiles[1]);
    const auto second = *stream.add(ofViewport(others[1], 1));
    ASSERT_TRUE(first && second);
    EXPECT_EQ(rgbOf(*first), rgb);
    EXPECT_EQ(rgbOf(*second), other);
    EXPECT_EQ(second->viewport, 1);

    EXPECT_FALSE(*stream.add(tilesOf(rgb, 128, 64, 8, 2)[0]));
    stream.reset();  // another link: its pictures are counted from 1
    EXPECT_FALSE(*stream.add(tilesOf(other, 128, 64, 1, 3)[1]));
    const auto anew = *stream.add(tilesOf(other, 128, 64, 1, 3)[0]);
    ASSERT_TRUE(anew);
    EXPECT_EQ(rgbOf(*anew), other);
}

TEST(PictureStream, AViewportThatCannotBeIsRefused) {
    const auto tiles = tilesOf(smoothPicture(64, 64, 0.0), 64, 64, 1, 1);
    PictureStream stream;
    EXPECT_TRUE(stream.add(ofViewport(tiles[0], std::uint8_t(protocol::maxViewports - 1))));
    const auto beyond = stream.add(ofViewport(tiles[0], std::uint8_t(protocol::maxViewports)));
    ASSERT_FALSE(beyond);
    EXPECT_EQ(beyond.error().kind, ErrorKind::badInput);
}

TEST(PictureStream, JpegComesBackNearlyAndLosslessExactly) {
    const Bytes rgb = smoothPicture(120, 90, 1.0);
    TileHeader header;
    header.picture = 1;
    header.pictureWidth = header.width = 120;
    header.pictureHeight = header.height = 90;
    header.last = true;
    PictureStream stream;
    const auto jpeg = feed(stream, payload(header, encodeJpeg(rgb, 120, 90)));
    ASSERT_TRUE(jpeg);
    const Bytes near = rgbOf(*jpeg);
    double error = 0.0;
    for (std::size_t n = 0; n < rgb.size(); ++n)
        error += std::pow(double(rgb[n]) - near[n], 2);
    EXPECT_GT(10 * std::log10(255.0 * 255.0 * double(rgb.size()) / error), 40.0);
    expectOpaque(*jpeg);
    header.codec = TileCodec::lossless;
    header.picture = 2;
    const auto exact = feed(stream, payload(header, protocol::encodeLossless(rgb, 120, 90)));
    ASSERT_TRUE(exact);
    EXPECT_EQ(rgbOf(*exact), rgb);
}

TEST(PictureStream, RefusesAJpegOfAnotherSizeThanItsHeaderSays) {
    TileHeader header;
    header.picture = 1;
    header.pictureWidth = header.width = 16;
    header.pictureHeight = header.height = 16;
    PictureStream stream;
    const auto tile = stream.add(payload(header, encodeJpeg(smoothPicture(400, 300, 0), 400, 300)));
    ASSERT_FALSE(tile);
    EXPECT_NE(tile.error().message.find("400x300"), std::string::npos) << tile.error().message;
}

TEST(PictureStream, SurvivesAnyBytes) {
    const Bytes rgb = smoothPicture(64, 48, 0.5);
    std::vector<Bytes> sound;
    for (const TileCodec codec : {TileCodec::jpeg, TileCodec::lossless}) {
        TileHeader header;
        header.codec = codec;
        header.picture = 1;
        header.pictureWidth = header.width = 64;
        header.pictureHeight = header.height = 48;
        header.last = true;
        sound.push_back(payload(header, codec == TileCodec::jpeg
                                            ? encodeJpeg(rgb, 64, 48)
                                            : protocol::encodeLossless(rgb, 64, 48)));
    }
    PictureStream stream;
    std::mt19937 random(2);
    int refused = 0;
    for (int n = 0; n < 6000; ++n) {
        Bytes bytes = sound[std::size_t(n % 2)];
        const int damage = n / 2 % 3;
        if (damage == 0) {
            for (int k = 0; k < 1 + n % 8; ++k)
                bytes[random() % bytes.size()] = std::uint8_t(random());
        } else if (damage == 1) {
            bytes.resize(random() % bytes.size());
        } else {
            bytes.resize(random() % 200);
            for (auto& byte : bytes)
                byte = std::uint8_t(random());
        }
        stream.reset();
        const auto picture = stream.add(bytes);
        refused += !picture;
        if (picture && *picture) expectOpaque(**picture);
    }
    EXPECT_GT(refused, 3000);
}

TEST(PngFile, ReadsBackThePixelsAndRefusesAFolderThatIsNotThere) {
    const Bytes rgb = smoothPicture(37, 21, 0.3);
    const tests::TemporaryFolder folder;
    const auto file = folder / "picture.png";
    ASSERT_TRUE(writePng(file, rgb, 37, 21));
    const Image read = tests::readPicture(file);
    EXPECT_EQ(read.width, 37);
    EXPECT_EQ(read.height, 21);
    EXPECT_EQ(read.rgb, rgb);
    EXPECT_FALSE(writePng(file / "no" / "folder.png", rgb, 37, 21));
    EXPECT_FALSE(writePng(file, rgb, 38, 21));
    EXPECT_EQ(tests::readPicture(file).rgb, rgb);  // what was there stays
    // A disk that is full.
    ::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    rlimit small = before;
    small.rlim_cur = std::filesystem::file_size(file) - 1;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    EXPECT_FALSE(writePng(file, rgb, 37, 21));
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_EQ(tests::readPicture(file).rgb, rgb);
}

}  // namespace
}  // namespace haustra::tiles
