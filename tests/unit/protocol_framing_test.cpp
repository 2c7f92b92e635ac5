// Frames and tile headers: what is written is read back, and nothing else is believed.
#include "core/raycasters.h"
#include "protocol/framing.h"
#include "protocol/haustra.pb.h"

#include <random>

#include <gtest/gtest.h>

namespace haustra::protocol {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes headerBytes(std::uint32_t length, std::uint8_t type) {
    return {std::uint8_t(length), std::uint8_t(length >> 8), std::uint8_t(length >> 16),
            std::uint8_t(length >> 24), type};
}

TileHeader someTile() {
    TileHeader header;
    header.viewport = 7;
    header.codec = TileCodec::lossless;
    header.last = true;
    header.exact = true;
    header.picture = 0xdeadbeef;
    header.sequence = 0x0123456789abcdefu;
    header.pictureWidth = 2048;
    header.pictureHeight = 300;
    header.x = 1536;
    header.y = 1;
    header.width = 512;
    header.height = 299;
    header.renderMicroseconds = 1;
    header.encodeMicroseconds = 0xffffffff;
    header.queueMicroseconds = 0x10203;
    header.raycaster = 5;
    header.viewportWidth = 2048;
    header.viewportHeight = 1500;
    return header;
}

Bytes tileBytes(const TileHeader& header) {
    Bytes bytes;
    appendTileHeader(bytes, header);
    return bytes;
}

TEST(FrameHeader, IsLittleEndianAndComesBack) {
    Bytes bytes;
    appendFrameHeader(bytes, {0x00012345, FrameType::tile});
    EXPECT_EQ(bytes, headerBytes(0x00012345, 2));
    const auto header = parseFrameHeader(bytes, clientReceives);
    ASSERT_TRUE(header);
    EXPECT_EQ(header->payloadBytes, 0x00012345u);
    EXPECT_EQ(header->type, FrameType::tile);
}

TEST(FrameHeader, EveryTruncationIsRefused) {
    const Bytes bytes = headerBytes(10, 1);
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_FALSE(parseFrameHeader(std::span(bytes).first(length), serverReceives)) << length;
    EXPECT_TRUE(parseFrameHeader(bytes, serverReceives));
}

TEST(FrameHeader, EveryUnknownTypeIsRefused) {
    for (int type = 0; type < 256; ++type)
        EXPECT_EQ(parseFrameHeader(headerBytes(1, std::uint8_t(type)), clientReceives).has_value(),
                  type == 1 || type == 2)
            << type;
}

TEST(FrameHeader, LengthsAreBoundedByReceiverAndType) {
    const auto accepted = [](std::uint32_t length, FrameType type, FrameLimits limits) {
        return parseFrameHeader(headerBytes(length, std::uint8_t(type)), limits).has_value();
    };
    EXPECT_TRUE(accepted(maxClientControlBytes, FrameType::control, serverReceives));
    EXPECT_FALSE(accepted(maxClientControlBytes + 1, FrameType::control, serverReceives));
    EXPECT_FALSE(accepted(0, FrameType::tile, serverReceives));
    EXPECT_TRUE(accepted(maxServerControlBytes, FrameType::control, clientReceives));
    EXPECT_FALSE(accepted(maxServerControlBytes + 1, FrameType::control, clientReceives));
    EXPECT_TRUE(accepted(maxTileBytes, FrameType::tile, clientReceives));
    EXPECT_FALSE(accepted(maxTileBytes + 1, FrameType::tile, clientReceives));
    EXPECT_FALSE(accepted(0xffffffff, FrameType::tile, clientReceives));
    EXPECT_TRUE(accepted(0, FrameType::control, serverReceives));
}

TEST(TileHeader, ComesBackFieldByField) {
    const TileHeader out = someTile();
    const Bytes bytes = tileBytes(out);
    ASSERT_EQ(bytes.size(), tileHeaderBytes);
    const auto in = parseTileHeader(bytes);
    ASSERT_TRUE(in);
    EXPECT_EQ(in->viewport, out.viewport);
    EXPECT_EQ(in->codec, out.codec);
    EXPECT_EQ(in->last, out.last);
    EXPECT_EQ(in->exact, out.exact);
    EXPECT_EQ(in->picture, out.picture);
    EXPECT_EQ(in->sequence, out.sequence);
    EXPECT_EQ(in->pictureWidth, out.pictureWidth);
    EXPECT_EQ(in->pictureHeight, out.pictureHeight);
    EXPECT_EQ(in->x, out.x);
    EXPECT_EQ(in->y, out.y);
    EXPECT_EQ(in->width, out.width);
    EXPECT_EQ(in->height, out.height);
    EXPECT_EQ(in->renderMicroseconds, out.renderMicroseconds);
    EXPECT_EQ(in->encodeMicroseconds, out.encodeMicroseconds);
    EXPECT_EQ(in->queueMicroseconds, out.queueMicroseconds);
    EXPECT_EQ(in->raycaster, out.raycaster);
    EXPECT_EQ(in->viewportWidth, out.viewportWidth);
    EXPECT_EQ(in->viewportHeight, out.viewportHeight);
    EXPECT_TRUE(in->coarse());
}

// PROTOCOL.md §5 fixes the offsets: another implementation must find the same fields.
TEST(TileHeader, FieldsLieWhereTheTableSays) {
    const Bytes bytes = tileBytes(someTile());
    EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + 4), (Bytes{7, 2, 3, 0}));
    EXPECT_EQ(Bytes(bytes.begin() + 4, bytes.begin() + 8), (Bytes{0xef, 0xbe, 0xad, 0xde}));
    EXPECT_EQ(bytes[8], 0xef);
    EXPECT_EQ(bytes[15], 0x01);
    EXPECT_EQ(Bytes(bytes.begin() + 16, bytes.begin() + 28),
              (Bytes{0, 8, 44, 1, 0, 6, 1, 0, 0, 2, 43, 1}));
    EXPECT_EQ(bytes[28], 1);
    EXPECT_EQ(Bytes(bytes.begin() + 32, bytes.begin() + 36), (Bytes{255, 255, 255, 255}));
    EXPECT_EQ(Bytes(bytes.begin() + 36, bytes.begin() + 40), (Bytes{3, 2, 1, 0}));
    EXPECT_EQ(Bytes(bytes.begin() + 40, bytes.begin() + 46), (Bytes{5, 0, 0, 8, 0xdc, 5}));
    EXPECT_EQ(Bytes(bytes.begin() + 46, bytes.end()), Bytes(10, 0));
}

TEST(TileHeader, EveryTruncationIsRefused) {
    const Bytes bytes = tileBytes(someTile());
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_FALSE(parseTileHeader(std::span(bytes).first(length))) << length;
}

TEST(TileHeader, ATileOutsideItsPictureIsRefused) {
    const auto refused = [](auto change) {
        TileHeader header = someTile();
        change(header);
        return !parseTileHeader(tileBytes(header));
    };
    EXPECT_FALSE(refused([](TileHeader&) {}));
    EXPECT_TRUE(refused([](TileHeader& h) { h.viewport = maxViewports; }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.codec = TileCodec(0); }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.codec = TileCodec(3); }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.pictureWidth = 2049; }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.pictureHeight = 0; }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.width = 0; }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.height = 300; }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.x = 1537; }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.x = 65535, h.width = 65535; }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.viewportHeight = 299; }));
    EXPECT_TRUE(refused([](TileHeader& h) { h.viewportWidth = 2049; }));
    EXPECT_FALSE(refused([](TileHeader& h) { h.viewportWidth = h.viewportHeight = 0; }));
}

TEST(TileHeader, WhateverIsAcceptedLiesWithinItsPicture) {
    std::mt19937 random(7);
    int accepted = 0;
    for (int n = 0; n < 200'000; ++n) {
        Bytes bytes = tileBytes(someTile());
        for (int change = 0; change < 3; ++change)
            bytes[random() % bytes.size()] = std::uint8_t(random());
        const auto header = parseTileHeader(bytes);
        if (!header) continue;
        ++accepted;
        ASSERT_LT(header->viewport, maxViewports);
        ASSERT_LE(header->x + header->width, header->pictureWidth);
        ASSERT_LE(header->y + header->height, header->pictureHeight);
        ASSERT_LE(std::max(header->pictureWidth, header->pictureHeight), maxViewportPixels);
    }
    EXPECT_GT(accepted, 1000);
}

TEST(TileHeader, RaycastersHaveNames) {
    EXPECT_STREQ(raycasterName(0), "");
    EXPECT_STREQ(raycasterName(1), "native");
    EXPECT_STREQ(raycasterName(5), "hybrid");
    for (int number = 6; number < 256; ++number)
        EXPECT_STREQ(raycasterName(std::uint8_t(number)), "");
}

// The notes that readers write must be text; protobuf is relied on to refuse anything else.
TEST(Messages, BrokenUtf8IsRefused) {
    ClientMessage message;
    message.mutable_add_bookmark()->set_note("note");
    std::string bytes = message.SerializeAsString();
    EXPECT_TRUE(message.ParseFromString(bytes));
    bytes[bytes.find("note")] = char(0xff);
    EXPECT_FALSE(message.ParseFromString(bytes));
}

}  // namespace
}  // namespace haustra::protocol
