// Whatever bytes come over the wire, the parsers only accept or refuse them.
#include "protocol/framing.h"
#include "protocol/haustra.pb.h"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <vector>

namespace {

using namespace haustra::protocol;

void require(bool holds) {
    if (!holds) std::abort();
}

void fuzzPayload(FrameType type, std::span<const std::uint8_t> payload) {
    if (type == FrameType::control) {
        ClientMessage fromClient;
        ServerMessage fromServer;
        (void)fromClient.ParseFromArray(payload.data(), int(payload.size()));
        (void)fromServer.ParseFromArray(payload.data(), int(payload.size()));
        return;
    }
    const auto header = parseTileHeader(payload);
    if (!header) return;
    std::vector<std::uint8_t> again;
    appendTileHeader(again, *header);
    require(again.size() == tileHeaderBytes && parseTileHeader(again).has_value());
    // Small enough for thousands of tries a second.
    const int width = 1 + header->width % 64, height = 1 + header->height % 64;
    const auto rgb = decodeLossless(payload.subspan(tileHeaderBytes), width, height);
    require(!rgb || rgb->size() == std::size_t(width * height * 3));
    if (rgb) require(*decodeLossless(encodeLossless(*rgb, width, height), width, height) == *rgb);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::span<const std::uint8_t> bytes(data, size);
    for (int frames = 0; frames < 8 && !bytes.empty(); ++frames) {
        const auto header = parseFrameHeader(bytes, clientReceives);
        if (!header) break;
        bytes = bytes.subspan(frameHeaderBytes);
        const auto payload = bytes.first(std::min<std::size_t>(header->payloadBytes, bytes.size()));
        fuzzPayload(header->type, payload);
        bytes = bytes.subspan(payload.size());
    }
    return 0;
}
