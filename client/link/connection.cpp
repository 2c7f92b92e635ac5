#include "link/connection.h"

#include "core/quantile.h"
#include "link/fingerprint.h"
#include "link/peer_text.h"
#include "protocol/capabilities.h"
#include "protocol/framing.h"
#include "tiles/picture_stream.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include <asio.hpp>
#include <asio/ssl.hpp>
#include <openssl/ssl.h>
#include <openssl/x509.h>

namespace haustra::link {
namespace {

using Stream = asio::ssl::stream<asio::ip::tcp::socket>;
using protocol::ClientMessage;
using protocol::ServerMessage;
namespace capability = protocol::capability;

constexpr std::size_t maxQueuedBytes = 64u << 20;
// What a control message takes once it is read, by its bytes: an empty bookmark of two takes 130.
constexpr std::size_t messageWeight = 64;
constexpr std::chrono::seconds pingInterval{1};

std::string peerFingerprint(Stream& stream) {
    const std::unique_ptr<X509, decltype(&X509_free)> certificate(
        SSL_get1_peer_certificate(stream.native_handle()), X509_free);
    if (!certificate) return {};
    unsigned char* der = nullptr;
    const int bytes = i2d_X509(certificate.get(), &der);
    if (bytes <= 0) return {};
    std::string fingerprint = fingerprintOf({der, std::size_t(bytes)});
    OPENSSL_free(der);
    return fingerprint;
}

std::string inWords(const asio::error_code& error) {
    if (error == asio::error::eof || error == asio::ssl::error::stream_truncated)
        return "the server closed it";
    return error.message();
}

}  // namespace

struct Connection::Impl {
    // How one link ended.
    struct Ending {
        Error error;
        bool worthRetrying = true;
        bool wasUp = false;
    };

    explicit Impl(ConnectionOptions given)
        : options(std::move(given)), name(toString(options.address)) {
        tls.set_verify_mode(asio::ssl::verify_none);  // the pin decides, right after the handshake
        SSL_CTX_set_min_proto_version(tls.native_handle(), TLS1_3_VERSION);
        asio::co_spawn(io, run(), asio::detached);
        asio::co_spawn(io, watch(), asio::detached);
        network = std::thread([this] { io.run(); });
        decoder = std::thread([this] { decode(); });
    }
    ~Impl() {
        io.stop();
        network.join();
        {
            const std::lock_guard lock(mutex);
            stopping = true;
        }
        came.notify_one();
        decoder.join();
    }

    // ---- network thread -----------------------------------------------------------------
    asio::awaitable<void> run() {
        std::chrono::milliseconds pause{500};
        for (;;) {
            const Ending ending = co_await converse();
            ++link;
            stream.reset();
            outgoing.clear();
            writing = false;
            const bool retry = options.reconnect && ending.worthRetrying && !gaveUp;
            if (ending.wasUp) pause = std::chrono::milliseconds(500);
            push(LinkDown{ending.error, !retry}, 0);
            if (!retry) break;
            retryTimer.expires_after(pause);
            asio::error_code ignored;
            co_await retryTimer.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
            if (gaveUp) break;
            pause = std::min(2 * pause, std::chrono::milliseconds(5000));
        }
        watchdog.cancel();
        finished = true;
    }

    // Closes the socket when a deadline passes; the pending operation of converse() then fails.
    asio::awaitable<void> watch() {
        while (!finished) {
            watchdog.expires_at(deadline);
            asio::error_code ignored;
            co_await watchdog.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
            if (Clock::now() < deadline) continue;
            deadline = Clock::time_point::max();
            timedOut = true;
            resolver.cancel();
            if (stream) closeSocket();
        }
    }
    void expectWithin(std::chrono::milliseconds patience) {
        // The watchdog looks again when it wakes; only a nearer deadline must wake it.
        const bool nearer = Clock::now() + patience < deadline;
        deadline = Clock::now() + patience;
        if (nearer) watchdog.cancel();
    }
    void closeSocket() {
        asio::error_code ignored;
        stream->lowest_layer().close(ignored);
    }

    asio::awaitable<Ending> converse() {
        Ending ending;
        timedOut = false;
        writeFailure = {};
        expectWithin(options.connectPatience);
        try {
            stream = std::make_shared<Stream>(io, tls);
            const auto endpoints = co_await resolver.async_resolve(
                options.address.host, std::to_string(options.address.port), asio::use_awaitable);
            co_await asio::async_connect(stream->lowest_layer(), endpoints, asio::use_awaitable);
            stream->lowest_layer().set_option(asio::ip::tcp::no_delay(true));
            co_await stream->async_handshake(Stream::client, asio::use_awaitable);

            LinkUp up;
            up.fingerprint = peerFingerprint(*stream);
            const auto trust = checkPin(options.pinning, name, up.fingerprint);
            if (!trust) {
                closeSocket();
                co_return Ending{trust.error(), false, false};
            }
            up.firstUse = *trust == Trust::firstUse;

            if (auto welcomed = co_await greet(up); !welcomed) {
                closeSocket();
                co_return Ending{welcomed.error(), welcomed.error().kind == ErrorKind::device,
                                 false};
            }
            ending.wasUp = true;
            open = true;
            expectWithin(options.silencePatience);
            push(std::move(up), 0);
            asio::co_spawn(io, ping(link), asio::detached);
            for (;;) {
                auto read = co_await readFrame();
                if (!read) {
                    ending.error = read.error();
                    break;
                }
            }
            closeSocket();
        } catch (const asio::system_error& failure) {
            const std::string what =
                ending.wasUp ? "the connection was lost: " : "cannot connect: ";
            const auto patience = ending.wasUp ? options.silencePatience : options.connectPatience;
            ending.error = {
                ErrorKind::device,
                what + (timedOut ? "no answer for " + std::to_string(patience.count() / 1000) + " s"
                                 : inWords(writeFailure ? writeFailure : failure.code())),
                name};
        } catch (const std::exception& fault) {
            ending.error = {ErrorKind::device,
                            std::string("the connection failed: ") + fault.what(), name};
            ending.worthRetrying = false;
            if (stream) closeSocket();
        }
        open = false;
        deadline = Clock::time_point::max();
        co_return ending;
    }

    asio::awaitable<Result<void>> greet(LinkUp& up) {
        ClientMessage hello;
        hello.mutable_hello()->set_protocol_version(protocol::protocolVersion);
        for (const char* name : {capability::jpeg, capability::lossless, capability::coarse,
                                 capability::bookmarkPush, capability::ledger})
            hello.mutable_hello()->add_capabilities(name);
        hello.mutable_hello()->set_software(options.software);
        hello.mutable_hello()->set_reader(options.reader);
        co_await asio::async_write(*stream, asio::buffer(protocol::controlFrame(hello)),
                                   asio::use_awaitable);
        ServerMessage answer;
        if (auto read = co_await readFrame(&answer); !read) co_return read;
        if (answer.has_error()) {
            const bool busy = answer.error().code() == protocol::ErrorReport::BUSY;
            co_return fail(
                busy ? ErrorKind::device : ErrorKind::unsupported,
                "the server refused the connection: " + peerText(answer.error().message()), name);
        }
        if (!answer.has_welcome())
            co_return fail(ErrorKind::badInput,
                           "the server did not answer the hello with a welcome", name);
        if (answer.welcome().protocol_version() != protocol::protocolVersion)
            co_return fail(ErrorKind::unsupported,
                           "the server speaks protocol version " +
                               std::to_string(answer.welcome().protocol_version()) +
                               ", this client version " + std::to_string(protocol::protocolVersion),
                           name);
        up.serverSoftware = peerText(answer.welcome().software());
        up.renderer = peerText(answer.welcome().renderer());
        up.capabilities.insert(answer.welcome().capabilities().begin(),
                               answer.welcome().capabilities().end());
        co_return Result<void>{};
    }

    // Reads one frame: into `message` where given, else onto the queue.
    asio::awaitable<Result<void>> readFrame(ServerMessage* message = nullptr) {
        std::array<std::uint8_t, protocol::frameHeaderBytes> head;
        co_await asio::async_read(*stream, asio::buffer(head), asio::use_awaitable);
        const auto header = protocol::parseFrameHeader(head, protocol::clientReceives);
        if (!header) co_return tl::make_unexpected(header.error());
        std::vector<std::uint8_t> payload(header->payloadBytes);
        co_await asio::async_read(*stream, asio::buffer(payload), asio::use_awaitable);
        bytesReceived += head.size() + payload.size();
        if (!message) expectWithin(options.silencePatience);

        if (header->type == protocol::FrameType::tile) {
            if (message)
                co_return fail(ErrorKind::badInput, "a tile came before the welcome", name);
            const std::size_t bytes = payload.size();
            push(TilePayload{std::move(payload)}, bytes);
        } else {
            ServerMessage parsed;
            if (!parsed.ParseFromArray(payload.data(), int(payload.size())))
                co_return fail(ErrorKind::badInput,
                               "the server sent a control message that cannot be read", name);
            if (message)
                *message = std::move(parsed);
            else if (parsed.has_pong())
                notePong(parsed.pong().request());
            else
                push(std::move(parsed), messageWeight * payload.size());
        }
        while (queueIsFull()) {
            asio::steady_timer timer(io, std::chrono::milliseconds(2));
            co_await timer.async_wait(asio::use_awaitable);
            expectWithin(options.silencePatience);
        }
        co_return Result<void>{};
    }

    asio::awaitable<void> ping(std::uint64_t ofLink) {
        while (open && link == ofLink) {
            ClientMessage message;
            message.mutable_ping()->set_request(++pingRequest);
            pingSentAt = Clock::now();
            queueOut(protocol::controlFrame(message));
            asio::steady_timer timer(io, pingInterval);
            co_await timer.async_wait(asio::use_awaitable);
        }
    }
    void notePong(std::uint64_t request) {
        if (request != pingRequest) return;
        roundTripsMs.push_back(
            std::chrono::duration<double, std::milli>(Clock::now() - pingSentAt).count());
        if (roundTripsMs.size() > 5) roundTripsMs.pop_front();
        std::vector<double> sorted(roundTripsMs.begin(), roundTripsMs.end());
        medianRoundTripMs = medianOf(sorted);
    }

    void queueOut(const std::vector<std::uint8_t>& frame) {
        outgoing.insert(outgoing.end(), frame.begin(), frame.end());
        writeOut();
    }
    void writeOut() {
        if (writing || outgoing.empty()) return;
        writing = true;
        auto bytes = std::make_shared<std::vector<std::uint8_t>>(std::exchange(outgoing, {}));
        asio::async_write(
            *stream, asio::buffer(*bytes),
            [this, bytes, held = stream, ofLink = link](asio::error_code error, std::size_t) {
                if (link != ofLink) return;
                writing = false;
                if (error) {
                    writeFailure = error;
                    closeSocket();  // the reader notices, and says so
                } else {
                    writeOut();
                }
            });
    }

    /// Queues what has come for the decoding thread.
    template <class Body>
    void push(Body body, std::size_t bytes) {
        {
            const std::lock_guard lock(mutex);
            incoming.push_back({std::move(body), bytes, link});
            incomingBytes += bytes;
        }
        came.notify_one();
    }
    bool queueIsFull() {
        const std::lock_guard lock(mutex);
        return incomingBytes > maxQueuedBytes;
    }

    // ---- decoding thread ------------------------------------------------------------------
    void decode() {
        tiles::PictureStream pictures;
        for (;;) {
            std::unique_lock lock(mutex);
            came.wait(lock, [this] {
                return stopping || (!incoming.empty() && eventBytes <= maxQueuedBytes);
            });
            if (stopping) return;
            Incoming next = std::move(incoming.front());
            incoming.pop_front();
            incomingBytes -= next.bytes;
            lock.unlock();
            if (gaveUp) continue;
            if (auto* tile = std::get_if<TilePayload>(&next.body)) {
                auto picture = decoded(pictures, tile->bytes);
                if (!picture) {
                    gaveUp = true;
                    deliver(next, LinkDown{picture.error(), true}, 0);
                    // Ends what the network thread waits for now, be it the next attempt.
                    asio::post(io, [this] {
                        retryTimer.cancel();
                        resolver.cancel();
                        if (stream) closeSocket();
                    });
                } else if (*picture) {
                    const std::size_t bytes = (*picture)->pixels.size();
                    deliver(next, PictureDone{std::move(**picture), Clock::now()}, bytes);
                }
            } else if (auto* up = std::get_if<LinkUp>(&next.body)) {
                pictures.reset();
                deliver(next, std::move(*up), 0);
            } else if (auto* down = std::get_if<LinkDown>(&next.body)) {
                deliver(next, std::move(*down), 0);
            } else {
                deliver(next, std::move(std::get<ServerMessage>(next.body)), next.bytes);
            }
        }
    }

    struct TilePayload {
        std::vector<std::uint8_t> bytes;
    };
    struct Incoming {
        std::variant<LinkUp, LinkDown, TilePayload, ServerMessage> body;
        std::size_t bytes;
        std::uint64_t link;
    };
    static Result<std::optional<tiles::Picture>> decoded(tiles::PictureStream& pictures,
                                                         const std::vector<std::uint8_t>& tile) {
        try {
            return pictures.add(tile);
        } catch (const std::bad_alloc&) {
            return fail(ErrorKind::device, "there is no memory for a picture", "tile");
        }
    }
    /// Queues an event for the caller, of `bytes` while it waits there.
    template <class Body>
    void deliver(const Incoming& from, Body body, std::size_t bytes) {
        {
            const std::lock_guard lock(mutex);
            events.push_back({std::move(body), bytes, from.link});
            eventBytes += bytes;
        }
        arrived.notify_one();
        if (options.onEvent) options.onEvent();
    }

    struct Queued {
        Event event;
        std::size_t bytes;
        std::uint64_t link;
    };

    const ConnectionOptions options;
    const std::string name;

    std::mutex mutex;
    std::condition_variable came, arrived;
    std::deque<Incoming> incoming;                  // guarded by mutex: for the decoding thread
    std::deque<Queued> events;                      // guarded by mutex: for the caller
    std::size_t incomingBytes = 0, eventBytes = 0;  // guarded by mutex
    bool stopping = false;                          // guarded by mutex
    std::atomic<bool> gaveUp{false};                // a tile was none: nothing more is delivered
    std::atomic<std::uint64_t> seenLink{0};         // the link whose LinkUp the caller has taken
    std::atomic<double> medianRoundTripMs{0.0};
    std::atomic<std::uint64_t> bytesReceived{0};

    asio::io_context io{1};
    asio::ssl::context tls{asio::ssl::context::tls_client};
    asio::ip::tcp::resolver resolver{io};
    asio::steady_timer watchdog{io}, retryTimer{io};
    Clock::time_point deadline = Clock::time_point::max();
    std::shared_ptr<Stream> stream;
    std::uint64_t link = 1;  // counts the attempts
    bool open = false, timedOut = false, finished = false, writing = false;
    asio::error_code writeFailure;
    std::vector<std::uint8_t> outgoing;
    std::uint64_t pingRequest = 0;
    Clock::time_point pingSentAt;
    std::deque<double> roundTripsMs;
    std::thread network, decoder;  // last: they start when all of the above is there
};

Connection::Connection(ConnectionOptions options)
    : impl_(std::make_unique<Impl>(std::move(options))) {}
Connection::~Connection() = default;

void Connection::send(const protocol::ClientMessage& message) {
    asio::post(impl_->io, [impl = impl_.get(), frame = protocol::controlFrame(message),
                           ofLink = impl_->seenLink.load()] {
        if (impl->open && impl->link == ofLink) impl->queueOut(frame);
    });
}

std::optional<Event> Connection::next(std::chrono::milliseconds patience) {
    std::unique_lock lock(impl_->mutex);
    if (!impl_->arrived.wait_for(lock, patience, [&] { return !impl_->events.empty(); }))
        return std::nullopt;
    auto queued = std::move(impl_->events.front());
    impl_->events.pop_front();
    impl_->eventBytes -= queued.bytes;
    impl_->came.notify_one();
    if (std::holds_alternative<LinkUp>(queued.event)) impl_->seenLink = queued.link;
    return std::move(queued.event);
}

double Connection::roundTripMs() const {
    return impl_->medianRoundTripMs;
}
std::uint64_t Connection::receivedBytes() const {
    return impl_->bytesReceived;
}

}  // namespace haustra::link
