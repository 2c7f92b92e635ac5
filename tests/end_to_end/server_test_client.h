// A small client for tests: blocking, every wait bounded, and able to misbehave.
#pragma once

#include "protocol/framing.h"
#include "protocol/haustra.pb.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace haustra::tests {

struct TestPicture {
    protocol::TileHeader header;  ///< of its last tile
    std::vector<std::uint8_t> rgb;
};

class TestClient {
public:
    using Bytes = std::vector<std::uint8_t>;
    using Event = std::variant<protocol::ServerMessage, TestPicture>;

    /// Throws where it cannot connect; so does what follows where the server's bytes are no frames.
    explicit TestClient(std::uint16_t port);
    ~TestClient();

    void sendBytes(const Bytes& bytes);
    void send(const protocol::ClientMessage& message) { sendBytes(frameOf(message)); }
    static Bytes frameOf(const protocol::ClientMessage& message);
    /// Resets the TCP connection, as a machine that fails does.
    void vanish();

    /// The next message or whole picture; none when the server closed, or stayed silent so long.
    std::optional<Event> next(std::chrono::milliseconds patience = std::chrono::seconds(60));
    /// The next control message, passing over pictures.
    std::optional<protocol::ServerMessage> answer();
    /// The next picture, passing over messages.
    std::optional<TestPicture> picture();

    // ---- what a well-behaved client says
    std::optional<protocol::ServerMessage> hello(std::uint32_t version = protocol::protocolVersion,
                                                 const std::vector<std::string>& capabilities = {
                                                     "jpeg", "lossless"});
    std::optional<protocol::ServerMessage> openCase(const std::string& name);
    void viewport(std::uint64_t sequence, std::uint32_t id, protocol::View view, int width,
                  int height);
    using Vector = std::array<double, 3>;
    static void set(protocol::Vec3* out, const Vector& v);
    void camera(std::uint64_t sequence, std::uint32_t id, Vector position, bool moving,
                Vector forward = {0, 0, 1}, Vector up = {0, -1, 0}, double fovDegrees = 90);
    void slice(std::uint64_t sequence, std::uint32_t id, Vector position, double zoom, bool moving,
               bool cleansed = false);
    static protocol::ClientMessage bookmark(std::uint64_t request, const std::string& key,
                                            const std::string& note);

private:
    struct Stream;
    std::unique_ptr<Stream> stream_;
    TestPicture partial_;

    std::optional<TestPicture> addTile(const Bytes& payload);
};

}  // namespace haustra::tests
