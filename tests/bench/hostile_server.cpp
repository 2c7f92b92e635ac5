// A server that lies, to try the client's window on (hostile_window drives both): between the
// client and a fake server that is sound it changes what goes to the client, in another way on each
// connection. Prints its port and certificate, and in the end how often each way was used.
#include "bench/lies.h"
#include "end_to_end/fake_server.h"
#include "end_to_end/self_signed.h"
#include "protocol/framing.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <map>

#include <CLI/CLI.hpp>
#include <asio.hpp>
#include <asio/ssl.hpp>
#include <fmt/format.h>
#include <openssl/ssl.h>

namespace haustra::bench {
namespace {

using asio::use_awaitable;
using asio::ip::tcp;
using Stream = asio::ssl::stream<tcp::socket>;
using Bytes = std::vector<std::uint8_t>;
using protocol::ClientMessage;
using protocol::ServerMessage;
using std::chrono::milliseconds;

/// What the link itself does, beside the messages that lie.
enum class Wrong {
    closesAtOnce,
    silentBeforeTls,
    garbageForTls,
    endsWithinHandshake,
    closesAfterTls,
    silentAfterTls,
    randomAfterTls,
    randomBytes,
    randomPayloads,
    randomTiles,
    giantLength,
    unknownType,
    stallsWithinFrame,
    byteByByte,
    halfOpen,
    reset,
    floodOfErrors,
    floodOfPongs,
    floodOfLists,
    floodOfPictures,
    floodOfUnfinished,
    wildTiles,
    mutatedTiles,
    mutatedMessages,
    misbehaves,
    sound
};
constexpr std::array wrongNames{"link: closes at once",
                                "link: silent before TLS",
                                "link: garbage for TLS",
                                "link: ends within the handshake",
                                "link: closes after TLS",
                                "link: silent after TLS",
                                "link: random bytes after TLS",
                                "frames: random bytes",
                                "frames: random messages",
                                "frames: random tiles",
                                "frames: giant length",
                                "frames: unknown type",
                                "link: stalls within a frame",
                                "link: byte by byte",
                                "link: half open",
                                "link: reset",
                                "flood: refusals",
                                "flood: pongs",
                                "flood: lists of cases",
                                "flood: pictures",
                                "flood: pictures never finished",
                                "tiles: wild headers",
                                "tiles: mutated",
                                "messages: mutated",
                                "fake server misbehaves",
                                "nothing wrong"};
// Of 1000 connections; what is left are lies.
constexpr std::array wrongShares{10, 3,  10, 10, 10, 3,  15, 20, 25, 25, 15, 15, 15,
                                 20, 10, 10, 25, 15, 15, 30, 25, 60, 60, 70, 50, 10};
static_assert(wrongNames.size() == wrongShares.size());

struct Plan {
    Wrong wrong = Wrong::sound;
    const Lie* lie = nullptr;
    std::uint64_t after = 0;  // frames of pictures that go before it
    bool atFirst = false;     // a lie changes what is answered; else it is said unasked
    milliseconds life{4000};
    std::string name() const { return lie ? lie->name : wrongNames[std::size_t(wrong)]; }
};

Plan makePlan(Random& random) {
    Plan plan;
    plan.after = chance(random, 0.2) ? 0 : pick(random, 150);
    plan.atFirst = chance(random, 0.5);
    plan.life = milliseconds(800 + pick(random, 3500));
    std::uint64_t drawn = pick(random, 999);
    for (std::size_t n = 0; n < wrongShares.size(); ++n) {
        if (drawn < std::uint64_t(wrongShares[n])) {
            plan.wrong = Wrong(n);
            if (plan.wrong == Wrong::stallsWithinFrame || plan.wrong == Wrong::halfOpen)
                if (chance(random, 0.2)) plan.life = milliseconds(33'000);
            return plan;
        }
        drawn -= std::uint64_t(wrongShares[n]);
    }
    plan.lie = &lies()[pick(random, lies().size() - 1)];
    return plan;
}

tests::Misbehaviour misbehaviour(Random& random) {
    tests::Misbehaviour wrong;
    switch (pick(random, 11)) {
        case 0:
            wrong.protocolVersion = std::uint32_t(random());
            break;
        case 1:
            wrong.garbageTiles = true;
            break;
        case 2:
            wrong.closesAfterTile = true;
            break;
        case 3:
            wrong.noStills = true;
            break;
        case 4:
            wrong.dropAfterBookmarks = 1;
            break;
        case 5:
            wrong.truncateWelcome = true;
            break;
        case 6:
            wrong.old = true;
            break;
        case 7:
            wrong.notFlattened = true;
            break;
        case 8:
            wrong.silentAboutTheWall = true;
            break;
        case 9:
            wrong.closesAtWallQuestions = true;
            break;
        case 10:
            wrong.refuseBookmarks = 100;
            break;
        default:
            wrong.refuseCaseWith = int(pick(random, 9));
    }
    return wrong;
}

class Conversation : public std::enable_shared_from_this<Conversation> {
public:
    Conversation(asio::io_context& io, asio::ssl::context& tls, tcp::socket socket, Plan plan,
                 std::uint64_t seed)
        : io_(io),
          client_(std::move(socket), tls),
          plan_(std::move(plan)),
          random_(seed),
          timer_(io) {}

    asio::awaitable<void> run() {
        const auto self = shared_from_this();
        try {
            co_await serve();
        } catch (const std::exception&) {
            // The client went away.
        }
        close();
    }

private:
    asio::awaitable<void> serve() {
        auto& raw = client_.next_layer();
        raw.set_option(tcp::no_delay(true));
        switch (plan_.wrong) {
            case Wrong::closesAtOnce:
                co_return;
            case Wrong::silentBeforeTls:
                co_return co_await sleep(milliseconds(12'000));
            case Wrong::garbageForTls:
            case Wrong::endsWithinHandshake: {
                std::array<std::uint8_t, 512> hello;
                co_await raw.async_read_some(asio::buffer(hello), use_awaitable);
                Bytes bytes = randomBytes(1 + pick(random_, 3000));
                if (chance(random_, 0.5))
                    bytes[0] = 22, bytes.resize(std::max<std::size_t>(5, bytes.size()));
                if (bytes[0] == 22) bytes[1] = 3, bytes[2] = 3, bytes[3] = 0, bytes[4] = 90;
                if (plan_.wrong == Wrong::garbageForTls)
                    co_await asio::async_write(raw, asio::buffer(bytes), use_awaitable);
                co_return co_await sleep(milliseconds(pick(random_, 200)));
            }
            default:
                break;
        }
        co_await client_.async_handshake(Stream::server, use_awaitable);
        switch (plan_.wrong) {
            case Wrong::closesAfterTls:
                co_return;
            case Wrong::silentAfterTls:
                co_return co_await sleep(milliseconds(12'000));
            case Wrong::randomAfterTls:
                co_await send(randomBytes(1 + pick(random_, 5000)));
                co_return co_await sleep(milliseconds(pick(random_, 1000)));
            default:
                break;
        }
        const tests::FakeServer fake(plan_.wrong == Wrong::misbehaves ? misbehaviour(random_)
                                                                      : tests::Misbehaviour{});
        co_await server_.lowest_layer().async_connect(
            tcp::endpoint(asio::ip::address_v4::loopback(), fake.port()), use_awaitable);
        co_await server_.async_handshake(Stream::client, use_awaitable);
        asio::co_spawn(
            io_, [self = shared_from_this()] { return self->forwardUp(); },
            [self = shared_from_this()](std::exception_ptr) {
                self->upEnded_ = true;
                self->close();
            });
        timer_.expires_after(plan_.life);
        timer_.async_wait([self = shared_from_this()](asio::error_code error) {
            if (!error) self->close();
        });
        try {
            co_await forwardDown();
        } catch (const std::exception&) {
            // One side went away; the other follows.
        }
        close();
        while (!upEnded_)
            co_await sleep(milliseconds(5));
    }

    void close() {
        asio::error_code ignored;
        client_.lowest_layer().close(ignored);
        server_.lowest_layer().close(ignored);
        timer_.cancel();
    }
    asio::awaitable<void> sleep(milliseconds time) {
        asio::steady_timer timer(io_, time);
        co_await timer.async_wait(use_awaitable);
    }
    Bytes randomBytes(std::size_t count) {
        Bytes bytes(std::max<std::size_t>(count, 8));
        for (std::uint8_t& byte : bytes)
            byte = std::uint8_t(random_());
        return bytes;
    }
    /// One write at a time: TLS has one stream of records.
    asio::awaitable<void> send(const Bytes& bytes) {
        while (std::exchange(writes_, true))
            co_await sleep(milliseconds(1));
        co_await asio::async_write(client_, asio::buffer(bytes), use_awaitable);
        writes_ = false;
    }
    asio::awaitable<void> send(const ServerMessage& message) {
        co_await send(protocol::controlFrame(message));
    }
    static Bytes framed(protocol::FrameType type, const Bytes& payload) {
        Bytes frame;
        protocol::appendFrameHeader(frame, {std::uint32_t(payload.size()), type});
        frame.insert(frame.end(), payload.begin(), payload.end());
        return frame;
    }
    static asio::awaitable<std::pair<protocol::FrameType, Bytes>> read(Stream& from) {
        std::array<std::uint8_t, protocol::frameHeaderBytes> head;
        co_await asio::async_read(from, asio::buffer(head), use_awaitable);
        const auto header = protocol::parseFrameHeader(head, protocol::clientReceives);
        if (!header) throw std::runtime_error("bad frame");
        Bytes payload(header->payloadBytes);
        co_await asio::async_read(from, asio::buffer(payload), use_awaitable);
        co_return std::pair(header->type, std::move(payload));
    }

    // ---- from the client ---------------------------------------------------------------------

    asio::awaitable<void> forwardUp() {
        for (;;) {
            auto [type, payload] = co_await read(client_);
            ClientMessage message;
            if (message.ParseFromArray(payload.data(), int(payload.size()))) {
                if (message.has_set_wall_paint()) continue;  // the fake server knows no paint
                if (message.has_ask_seen()) {
                    ServerMessage seen;
                    seen.mutable_wall_seen()->set_request(message.ask_seen().request());
                    seen.mutable_wall_seen()->set_share(0.5);
                    if (isLieAbout(seen)) plan_.lie->tell(random_, seen);
                    co_await send(seen);
                    continue;
                }
            }
            co_await asio::async_write(server_, asio::buffer(framed(type, payload)), use_awaitable);
        }
    }

    // ---- to the client -----------------------------------------------------------------------

    bool isLieAbout(const ServerMessage& message) const {
        return plan_.lie && plan_.lie->of == message.body_case();
    }

    asio::awaitable<void> forwardDown() {
        bool attacked = false;
        for (;;) {
            auto [type, payload] = co_await read(server_);
            if (type == protocol::FrameType::control)
                co_await forwardMessage(std::move(payload));
            else
                co_await forwardTile(std::move(payload));
            if (frames_ < plan_.after) continue;
            if (!attacked || chance(random_, 0.05)) co_await attack();
            attacked = true;
        }
    }

    asio::awaitable<void> forwardMessage(Bytes payload) {
        ServerMessage message;
        const bool sound = message.ParseFromArray(payload.data(), int(payload.size()));
        if (sound && message.has_case_opened()) opened_ = message;
        if (sound && isLieAbout(message) && (plan_.atFirst || !message.has_case_opened())) {
            plan_.lie->tell(random_, message);
            co_return co_await send(message);
        }
        // The welcome goes first: a session that does not begin tells little.
        if (plan_.wrong == Wrong::mutatedMessages && !message.has_pong() &&
            chance(random_, message.has_welcome()     ? 0.1
                            : message.has_case_list() ? 0.2
                                                      : 0.6))
            mutateBytes(random_, payload, 0);
        co_await send(framed(protocol::FrameType::control, payload));
    }

    asio::awaitable<void> forwardTile(Bytes payload) {
        ++frames_;
        const bool due = frames_ >= plan_.after;
        if (due && plan_.wrong == Wrong::mutatedTiles && chance(random_, 0.1)) {
            if (chance(random_, 0.3))
                payload.resize(pick(random_, payload.size()));
            else
                mutateBytes(random_, payload, chance(random_, 0.3) ? 0 : protocol::tileHeaderBytes);
        }
        lastTile_ = payload;
        co_await send(framed(protocol::FrameType::tile, payload));
    }

    // What is wrong comes to pass; where it lasts, until the connection's life is over.
    asio::awaitable<void> attack() {
        if (plan_.lie) {
            ServerMessage message;
            if (plan_.lie->of == ServerMessage::kCaseOpened) {
                if (plan_.atFirst || !opened_.has_case_opened()) co_return;
                message = opened_;
            }
            plan_.lie->tell(random_, message);
            co_return co_await send(message);
        }
        switch (plan_.wrong) {
            case Wrong::randomBytes:
                co_return co_await send(randomBytes(1 + pick(random_, 5000)));
            case Wrong::randomPayloads:
                co_return co_await send(
                    framed(protocol::FrameType::control,
                           randomBytes(pick(random_, chance(random_, 0.5) ? 60 : 50'000))));
            case Wrong::randomTiles:
                co_return co_await send(
                    framed(protocol::FrameType::tile,
                           randomBytes(pick(random_, chance(random_, 0.5) ? 60 : 50'000))));
            case Wrong::giantLength: {
                Bytes frame;
                constexpr std::array giant{4u << 20,        (4u << 20) + 1, 16u << 20,
                                           (16u << 20) + 1, 0x7fffffffu,    0xffffffffu};
                protocol::appendFrameHeader(
                    frame, {giant[pick(random_, 5)], protocol::FrameType(1 + pick(random_, 1))});
                co_return co_await send(frame);
            }
            case Wrong::unknownType:
                co_return co_await send(framed(protocol::FrameType(pick(random_, 255)),
                                               randomBytes(pick(random_, 100))));
            case Wrong::stallsWithinFrame: {
                Bytes frame = framed(protocol::FrameType::tile, lastTile_);
                frame.resize(pick(random_, frame.size()));
                co_await send(frame);
                co_return co_await sleep(milliseconds(40'000));
            }
            case Wrong::byteByByte: {
                const Bytes frame = framed(protocol::FrameType::tile, lastTile_);
                for (const std::uint8_t byte : frame) {
                    co_await send(Bytes(1, byte));
                    if (chance(random_, 0.2)) co_await sleep(milliseconds(1));
                }
                co_return;
            }
            case Wrong::halfOpen: {
                asio::error_code ignored;
                if (chance(random_, 0.5))
                    client_.lowest_layer().shutdown(chance(random_, 0.5)
                                                        ? tcp::socket::shutdown_send
                                                        : tcp::socket::shutdown_receive,
                                                    ignored);
                co_return co_await sleep(milliseconds(40'000));
            }
            case Wrong::reset:
                client_.lowest_layer().set_option(asio::socket_base::linger(true, 0));
                co_return close();
            case Wrong::floodOfErrors:
            case Wrong::floodOfPongs:
            case Wrong::floodOfLists:
                co_return co_await floodOfMessages();
            case Wrong::floodOfPictures:
            case Wrong::floodOfUnfinished:
                co_return co_await floodOfPictures();
            case Wrong::wildTiles:
                co_return co_await sendWildTile();
            default:
                co_return;
        }
    }

    asio::awaitable<void> floodOfMessages() {
        for (std::uint64_t n = 0;; ++n) {
            Bytes many;
            for (int k = 0; k < 200; ++k) {
                ServerMessage message;
                if (plan_.wrong == Wrong::floodOfErrors) {
                    message.mutable_error()->set_code(protocol::ErrorReport::BAD_VALUE);
                    message.mutable_error()->set_message(fmt::format("refusal {}", 200 * n + k));
                } else if (plan_.wrong == Wrong::floodOfPongs) {
                    message.mutable_wall_seen()->set_share(0.001 * k);
                } else {
                    message.mutable_case_list()->add_names(fmt::format("case-{}", 200 * n + k));
                }
                const Bytes frame = protocol::controlFrame(message);
                many.insert(many.end(), frame.begin(), frame.end());
            }
            co_await send(many);
        }
    }

    asio::awaitable<void> floodOfPictures() {
        const bool unfinished = plan_.wrong == Wrong::floodOfUnfinished;
        const int viewport = int(pick(random_, 7));
        const int side = chance(random_, 0.3) ? 2048 : 512;
        Bytes all =
            tests::framesOf({viewport, side, side, 1, 1, chance(random_, 0.5), {}, 0.0, false});
        for (std::uint32_t number = 1'000'000;; ++number) {
            Bytes frames = all;
            std::size_t last = 0;
            for (std::size_t at = 0; at < frames.size();) {
                std::uint32_t length = 0;
                for (unsigned n = 0; n < 4; ++n) {
                    length |= std::uint32_t(frames[at + n]) << 8 * n;
                    frames[at + protocol::frameHeaderBytes + 4 + n] = std::uint8_t(number >> 8 * n);
                }
                last = at;
                at += protocol::frameHeaderBytes + length;
            }
            if (unfinished) frames.resize(last);
            co_await send(frames);
        }
    }

    asio::awaitable<void> sendWildTile() {
        protocol::TileHeader header;
        const std::size_t viewport = pick(random_, 7);
        header.viewport = std::uint8_t(chance(random_, 0.1) ? pick(random_, 255) : viewport);
        header.codec =
            protocol::TileCodec(chance(random_, 0.1) ? pick(random_, 255) : 1 + pick(random_, 1));
        header.last = chance(random_, 0.7), header.exact = chance(random_, 0.5);
        header.picture = chance(random_, 0.5) ? 100'000 + std::uint32_t(frames_)
                                              : std::uint32_t(random_() >> pick(random_, 31));
        header.sequence = chance(random_, 0.5) ? pick(random_, 3000) : random_();
        constexpr std::array sizes{0, 1, 2, 16, 100, 511, 2048, 2049, 40'000, 65'535};
        const auto size = [&] {
            return std::uint16_t(sizes[pick(random_, chance(random_, 0.3) ? 9 : 6)]);
        };
        header.pictureWidth = size(), header.pictureHeight = size();
        header.width = chance(random_, 0.7) ? header.pictureWidth : size();
        header.height = chance(random_, 0.7) ? header.pictureHeight : size();
        if (chance(random_, 0.2)) header.x = size(), header.y = size();
        header.renderMicroseconds = std::uint32_t(random_());
        header.raycaster = std::uint8_t(random_());
        if (chance(random_, 0.3)) header.viewportWidth = size(), header.viewportHeight = size();
        Bytes payload;
        protocol::appendTileHeader(payload, header);
        const std::size_t pixels = std::size_t(header.width) * header.height;
        Bytes coded;
        if (pixels > 0 && pixels < 5'000'000 && chance(random_, 0.7)) {
            Bytes rgb(3 * pixels);
            for (std::uint8_t& byte : rgb)
                byte = std::uint8_t(random_());
            coded = protocol::encodeLossless(rgb, header.width, header.height);
            if (header.codec == protocol::TileCodec::jpeg && chance(random_, 0.5))
                header.codec = protocol::TileCodec::lossless;
            payload.clear();
            protocol::appendTileHeader(payload, header);
            if (coded.size() > protocol::maxTileBytes - 100) coded.resize(1000);
        } else {
            coded = randomBytes(pick(random_, 1000));
        }
        payload.insert(payload.end(), coded.begin(), coded.end());
        co_await send(framed(protocol::FrameType::tile, payload));
    }

    asio::io_context& io_;
    Stream client_;
    asio::ssl::context upTls_{asio::ssl::context::tls_client};
    Stream server_{io_, upTls_};
    Plan plan_;
    Random random_;
    asio::steady_timer timer_;
    bool upEnded_ = false, writes_ = false;
    std::uint64_t frames_ = 0;
    Bytes lastTile_;
    ServerMessage opened_;
};

asio::awaitable<void> listen(asio::io_context& io, asio::ssl::context& tls, tcp::acceptor& acceptor,
                             std::uint64_t seed, const std::string& only,
                             std::map<std::string, int>& used) {
    Random random(seed);
    for (;;) {
        tcp::socket socket = co_await acceptor.async_accept(use_awaitable);
        Plan plan = makePlan(random);
        while (!only.empty() && plan.name().find(only) == std::string::npos)
            plan = makePlan(random);
        ++used[plan.name()];
        fmt::print("connection: {}, after {} tiles, {} ms{}\n", plan.name(), plan.after,
                   plan.life.count(), plan.atFirst ? ", at first" : "");
        std::fflush(stdout);
        auto conversation =
            std::make_shared<Conversation>(io, tls, std::move(socket), plan, random());
        asio::co_spawn(
            io, [conversation] { return conversation->run(); }, asio::detached);
    }
}

}  // namespace
}  // namespace haustra::bench

int main(int argc, char** argv) {
    using namespace haustra;
    CLI::App app{"A server that lies, to try the client's window on."};
    std::uint64_t seed = 1;
    double seconds = 60.0;
    std::uint16_t port = 0;
    std::string only;
    app.add_option("--seed", seed, "of what is wrong, connection by connection");
    app.add_option("--seconds", seconds, "how long it serves");
    app.add_option("--port", port, "on 127.0.0.1 (0: chosen by the system, and printed)");
    app.add_option("--only", only, "none but the ways whose name has this in it");
    CLI11_PARSE(app, argc, argv);
    std::signal(SIGPIPE, SIG_IGN);

    asio::io_context io{1};
    asio::ssl::context tls{asio::ssl::context::tls_server};
    const tests::SelfSigned identity = tests::makeSelfSigned();
    SSL_CTX_set_min_proto_version(tls.native_handle(), TLS1_3_VERSION);
    SSL_CTX_use_certificate(tls.native_handle(), identity.certificate.get());
    SSL_CTX_use_PrivateKey(tls.native_handle(), identity.key.get());
    asio::ip::tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), port});
    fmt::print("port {}\nfingerprint {}\n", acceptor.local_endpoint().port(), identity.fingerprint);
    std::fflush(stdout);
    std::map<std::string, int> used;
    asio::co_spawn(io, bench::listen(io, tls, acceptor, seed, only, used), asio::detached);
    asio::signal_set signals(io, SIGTERM, SIGINT);
    signals.async_wait([&](asio::error_code, int) { io.stop(); });
    asio::steady_timer end(io, std::chrono::milliseconds(std::int64_t(1e3 * seconds)));
    end.async_wait([&](asio::error_code error) {
        if (!error) io.stop();
    });
    io.run();
    int all = 0;
    for (const auto& [name, times] : used)
        fmt::print("used {:5} {}\n", times, name), all += times;
    fmt::print("used {:5} in all\n", all);
    std::fflush(stdout);
    std::_Exit(0);  // conversations under way are left as they are
}
