#include "end_to_end/server_test_client.h"

#include <algorithm>
#include <span>
#include <stdexcept>

#include <asio.hpp>
#include <asio/ssl.hpp>
#include <turbojpeg.h>

namespace haustra::tests {

struct TestClient::Stream {
    asio::io_context io;
    asio::ssl::context tls{asio::ssl::context::tls_client};
    asio::ssl::stream<asio::ip::tcp::socket> stream{io, tls};

    auto& socket() { return stream.lowest_layer(); }

    struct Frame {
        protocol::FrameType type;
        Bytes payload;
    };

    bool readExactly(Bytes& bytes, std::chrono::steady_clock::time_point until) {
        if (bytes.empty()) return true;
        std::optional<asio::error_code> result;
        asio::async_read(stream, asio::buffer(bytes),
                         [&](const asio::error_code& error, std::size_t) { result = error; });
        io.restart();
        io.run_until(until);
        if (!result) {  // too late: the connection is of no use any more
            socket().close();
            io.restart();
            io.run();
            return false;
        }
        return !*result;
    }

    std::optional<Frame> readFrame(std::chrono::steady_clock::time_point until) {
        Bytes head(protocol::frameHeaderBytes);
        if (!readExactly(head, until)) return std::nullopt;
        const auto header = protocol::parseFrameHeader(head, protocol::clientReceives);
        if (!header) throw std::runtime_error("the server's frame header is bad");
        Frame frame{header->type, Bytes(header->payloadBytes)};
        if (!readExactly(frame.payload, until)) return std::nullopt;
        return frame;
    }
};

TestClient::TestClient(std::uint16_t port) : stream_(std::make_unique<Stream>()) {
    stream_->socket().connect({asio::ip::address_v4::loopback(), port});
    stream_->socket().set_option(asio::ip::tcp::no_delay(true));
    stream_->stream.handshake(asio::ssl::stream_base::client);
}

TestClient::~TestClient() {
    asio::error_code ignored;
    stream_->socket().close(ignored);
}

void TestClient::sendBytes(const Bytes& bytes) {
    asio::write(stream_->stream, asio::buffer(bytes));
}

TestClient::Bytes TestClient::frameOf(const protocol::ClientMessage& message) {
    return protocol::controlFrame(message);
}

void TestClient::vanish() {
    stream_->socket().set_option(asio::socket_base::linger(true, 0));
    stream_->socket().close();
}

std::optional<TestClient::Event> TestClient::next(std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    for (;;) {
        const auto frame = stream_->readFrame(until);
        if (!frame) return std::nullopt;
        if (frame->type == protocol::FrameType::control) {
            protocol::ServerMessage message;
            if (!message.ParseFromArray(frame->payload.data(), int(frame->payload.size())))
                throw std::runtime_error("the server's message cannot be read");
            return message;
        }
        if (auto picture = addTile(frame->payload)) return std::move(*picture);
    }
}

std::optional<protocol::ServerMessage> TestClient::answer() {
    while (auto event = next())
        if (auto* message = std::get_if<protocol::ServerMessage>(&*event)) return *message;
    return std::nullopt;
}

std::optional<TestPicture> TestClient::picture() {
    while (auto event = next())
        if (auto* picture = std::get_if<TestPicture>(&*event)) return std::move(*picture);
    return std::nullopt;
}

std::optional<protocol::ServerMessage> TestClient::hello(
    std::uint32_t version, const std::vector<std::string>& capabilities) {
    protocol::ClientMessage message;
    message.mutable_hello()->set_protocol_version(version);
    for (const auto& capability : capabilities)
        message.mutable_hello()->add_capabilities(capability);
    send(message);
    return answer();
}

std::optional<protocol::ServerMessage> TestClient::openCase(const std::string& name) {
    protocol::ClientMessage message;
    message.mutable_open_case()->set_name(name);
    send(message);
    return answer();
}

void TestClient::viewport(std::uint64_t sequence, std::uint32_t id, protocol::View view, int width,
                          int height) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_viewport();
    body->set_sequence(sequence);
    body->set_viewport(id);
    body->set_view(view);
    body->set_width(std::uint32_t(width));
    body->set_height(std::uint32_t(height));
    send(message);
}

void TestClient::set(protocol::Vec3* out, const Vector& v) {
    out->set_x(v[0]);
    out->set_y(v[1]);
    out->set_z(v[2]);
}

void TestClient::camera(std::uint64_t sequence, std::uint32_t id, Vector position, bool moving,
                        Vector forward, Vector up, double fovDegrees) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_camera();
    body->set_sequence(sequence);
    body->set_viewport(id);
    set(body->mutable_position_mm(), position);
    set(body->mutable_forward(), forward);
    set(body->mutable_up(), up);
    body->set_fov_degrees(fovDegrees);
    body->set_moving(moving);
    send(message);
}

void TestClient::slice(std::uint64_t sequence, std::uint32_t id, Vector position, double zoom,
                       bool moving, bool cleansed) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_slice();
    body->set_cleansed(cleansed);
    body->set_sequence(sequence);
    body->set_viewport(id);
    set(body->mutable_position_mm(), position);
    body->set_zoom(zoom);
    body->set_moving(moving);
    send(message);
}

protocol::ClientMessage TestClient::bookmark(std::uint64_t request, const std::string& key,
                                             const std::string& note) {
    protocol::ClientMessage message;
    auto* body = message.mutable_add_bookmark();
    body->set_request(request);
    set(body->mutable_position_mm(), {1, 2, 3});
    set(body->mutable_forward(), {0, 0, 1});
    set(body->mutable_up(), {0, -1, 0});
    body->set_arc_mm(12.5);
    body->set_note(note);
    body->set_client_key(key);
    return message;
}

std::optional<TestPicture> TestClient::addTile(const Bytes& payload) {
    const auto header = protocol::parseTileHeader(payload);
    if (!header) throw std::runtime_error("the server's tile header is bad");
    const std::size_t width = header->width, height = header->height;
    const std::span<const std::uint8_t> coded =
        std::span(payload).subspan(protocol::tileHeaderBytes);
    Bytes rgb(width * height * 3);
    if (header->codec == protocol::TileCodec::lossless) {
        auto decoded = protocol::decodeLossless(coded, int(width), int(height));
        if (!decoded) throw std::runtime_error("a lossless tile cannot be decoded");
        rgb = std::move(*decoded);
    } else {
        const tjhandle jpeg = tjInitDecompress();
        const int failed = tjDecompress2(jpeg, coded.data(), coded.size(), rgb.data(), int(width),
                                         0, int(height), TJPF_RGB, 0);
        tjDestroy(jpeg);
        if (failed) throw std::runtime_error("a JPEG tile cannot be decoded");
    }
    if (partial_.header.picture != header->picture)
        partial_.rgb.assign(std::size_t(header->pictureWidth) * header->pictureHeight * 3, 0);
    partial_.header = *header;
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(&rgb[y * width * 3], width * 3,
                    &partial_.rgb[((header->y + y) * header->pictureWidth + header->x) * 3]);
    if (!header->last) return std::nullopt;
    return std::move(partial_);
}

}  // namespace haustra::tests
