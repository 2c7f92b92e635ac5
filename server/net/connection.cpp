#include "net/connection.h"

#include "protocol/framing.h"

#include <algorithm>
#include <array>

#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/read.hpp>
#include <asio/redirect_error.hpp>
#include <asio/use_awaitable.hpp>
#include <asio/write.hpp>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

namespace haustra::net {
namespace {

// The writer's deadline is for this much.
constexpr std::size_t chunkBytes = 256 * 1024;
// Reading pauses while more answers than this wait to be sent.
constexpr std::size_t maxOutgoingControlBytes = 1 << 20;
// What the kernel may hold unsent: a picture there can no longer be replaced by a newer one.
constexpr int maxKernelUnsentBytes = 128 * 1024;

}  // namespace

Connection::Connection(asio::ip::tcp::socket socket, asio::ssl::context& tls,
                       const session::Services& services, session::SessionId id, Patience patience)
    : stream_(std::move(socket), tls),
      services_(services),
      id_(id),
      patience_(patience),
      readDeadline_(stream_.get_executor()),
      writeDeadline_(stream_.get_executor()),
      resume_(stream_.get_executor()) {}

void Connection::start(std::function<bool()> admit, std::function<void()> closed) {
    asio::co_spawn(
        stream_.get_executor(),
        [self = shared_from_this(), admit = std::move(admit)]() mutable {
            return self->run(std::move(admit));
        },
        [self = shared_from_this(), closed = std::move(closed)](std::exception_ptr failure) {
            try {
                if (failure) std::rethrow_exception(failure);
            } catch (const asio::system_error& error) {
                const bool left = error.code() == asio::error::eof ||
                                  error.code() == asio::ssl::error::stream_truncated;
                spdlog::info("session {} is over: {}", self->id_,
                             left ? "the client left" : error.code().message());
            } catch (const std::exception& error) {
                spdlog::error("session {} is over: {}", self->id_, error.what());
            }
            self->abort();
            closed();
        });
}

void Connection::stop() {
    if (session_ && session_->greeted())
        session_->end(protocol::ErrorReport::BUSY, "the server stops");
    else
        abort();
}

asio::awaitable<void> Connection::run(std::function<bool()> admit) {
    auto& socket = stream_.lowest_layer();
    socket.set_option(asio::ip::tcp::no_delay(true));
    ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &maxKernelUnsentBytes,
                 sizeof maxKernelUnsentBytes);
    expectWithin(readDeadline_, patience_.handshake);
    co_await stream_.async_handshake(asio::ssl::stream_base::server, asio::use_awaitable);
    expectWithin(readDeadline_, patience_.hello);
    makeSession(std::move(admit));
    co_await readFrames();
}

void Connection::makeSession(std::function<bool()> admit) {
    const std::weak_ptr<Connection> weak = weak_from_this();
    session::Peer peer;
    peer.admit = std::move(admit);
    peer.send = [weak](Bytes frames, bool picture) {
        if (const auto self = weak.lock()) self->send(std::move(frames), picture);
    };
    peer.endAfterSending = [weak] {
        const auto self = weak.lock();
        if (!self) return;
        self->ending_ = true;
        self->resume_.cancel();
        self->send({}, false);
    };
    peer.answered = [weak] {
        if (const auto self = weak.lock()) self->resume_.cancel();
    };
    session_ = session::Session::create(id_, stream_.get_executor(), services_, std::move(peer));
}

// ---- reading ----------------------------------------------------------------------------------

bool Connection::mustPause() const {
    return !ending_ && (session_->tooBusy() || outgoingControlBytes_ > maxOutgoingControlBytes);
}

asio::awaitable<void> Connection::readFrames() {
    std::array<std::uint8_t, protocol::frameHeaderBytes> head;
    Bytes payload;
    while (!ending_) {
        co_await asio::async_read(stream_, asio::buffer(head), asio::use_awaitable);
        if (ending_) break;
        const auto header = protocol::parseFrameHeader(head, protocol::serverReceives);
        if (!header) {
            session_->end(protocol::ErrorReport::BAD_MESSAGE, describe(header.error()));
            break;
        }
        payload.resize(header->payloadBytes);
        co_await asio::async_read(stream_, asio::buffer(payload), asio::use_awaitable);
        session_->receive(payload);
        while (mustPause()) {
            readDeadline_.cancel();  // the writer's deadline watches over this
            asio::error_code woken;
            resume_.expires_at(asio::steady_timer::time_point::max());
            co_await resume_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
            if (closed_) co_return;
        }
        if (session_->greeted() && !ending_) expectWithin(readDeadline_, patience_.silence);
    }
    // A socket that is closed with bytes unread is reset, and the last error would be lost. The
    // writer's deadline ends this.
    readDeadline_.cancel();
    std::array<std::uint8_t, 4096> ignored;
    for (;;)
        co_await stream_.async_read_some(asio::buffer(ignored), asio::use_awaitable);
}

// ---- writing ----------------------------------------------------------------------------------

void Connection::send(Bytes bytes, bool picture) {
    if (closed_) return;
    if (!picture) outgoingControlBytes_ += bytes.size();
    outgoing_.push_back({std::move(bytes), picture});
    if (writing_) return;
    writing_ = true;
    asio::co_spawn(
        stream_.get_executor(), [self = shared_from_this()] { return self->writeQueued(); },
        [self = shared_from_this()](std::exception_ptr failure) {
            if (failure) self->abort();  // the reader then notices, and says so
        });
}

asio::awaitable<void> Connection::writeQueued() {
    while (!outgoing_.empty()) {
        const Outgoing out = std::move(outgoing_.front());
        outgoing_.pop_front();
        for (std::size_t at = 0; at < out.bytes.size(); at += chunkBytes) {
            expectWithin(writeDeadline_, patience_.send);
            co_await asio::async_write(
                stream_, asio::buffer(&out.bytes[at], std::min(chunkBytes, out.bytes.size() - at)),
                asio::use_awaitable);
        }
        writeDeadline_.cancel();
        if (out.picture) {
            session_->pictureSent();
        } else {
            outgoingControlBytes_ -= out.bytes.size();
            if (!mustPause()) resume_.cancel();
        }
    }
    writing_ = false;
    if (ending_) {
        // Only this direction: the client may still be sending, and is to read the last error.
        stream_.lowest_layer().shutdown(asio::ip::tcp::socket::shutdown_send);
        expectWithin(writeDeadline_, patience_.farewell);
    }
}

// ---- deadlines --------------------------------------------------------------------------------

void Connection::expectWithin(asio::steady_timer& deadline, std::chrono::milliseconds patience) {
    deadline.expires_after(patience);
    deadline.async_wait([weak = weak_from_this(), &deadline](const asio::error_code& error) {
        const auto self = weak.lock();
        if (!self || error || deadline.expiry() > asio::steady_timer::clock_type::now()) return;
        spdlog::info("session {} was too slow", self->id_);
        self->abort();
    });
}

void Connection::abort() {
    if (std::exchange(closed_, true)) return;
    if (session_) session_->disconnected();
    readDeadline_.cancel();
    writeDeadline_.cancel();
    resume_.cancel();
    asio::error_code ignored;
    stream_.lowest_layer().close(ignored);
}

}  // namespace haustra::net
