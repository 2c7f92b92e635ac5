// One client's TLS connection: frames in, frames out, and how long each may take.
#pragma once

#include "session/session.h"

#include <chrono>
#include <deque>
#include <functional>
#include <memory>

#include <asio/awaitable.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ssl/context.hpp>
#include <asio/ssl/stream.hpp>
#include <asio/steady_timer.hpp>

namespace haustra::net {

/// Belongs to the io thread, and keeps itself alive until its socket is closed.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    /// How long a peer may take (PROTOCOL.md §7).
    struct Patience {
        std::chrono::milliseconds handshake{10'000};  ///< TLS
        std::chrono::milliseconds hello{10'000};      ///< from the handshake to the hello
        std::chrono::milliseconds silence{60'000};    ///< from one frame's end to the next one's
        std::chrono::milliseconds send{30'000};       ///< for chunkBytes to leave
        std::chrono::milliseconds farewell{2'000};    ///< from the last byte sent to its closing
    };

    Connection(asio::ip::tcp::socket socket, asio::ssl::context& tls,
               const session::Services& services, session::SessionId id, Patience patience);

    /// Serves the client until it goes, or breaks the protocol, or is too slow. `admit` is asked
    /// once the client has said who it is (session::Peer).
    void start(std::function<bool()> admit, std::function<void()> closed);
    /// Tells the client that the server stops, and ends.
    void stop();
    /// Closes the socket, whatever is still to be sent.
    void abort();

private:
    using Bytes = std::vector<std::uint8_t>;
    struct Outgoing {
        Bytes bytes;
        bool picture;
    };

    asio::awaitable<void> run(std::function<bool()> admit);
    asio::awaitable<void> readFrames();
    asio::awaitable<void> writeQueued();
    void makeSession(std::function<bool()> admit);
    void send(Bytes bytes, bool picture);
    void expectWithin(asio::steady_timer& deadline, std::chrono::milliseconds patience);
    bool mustPause() const;

    asio::ssl::stream<asio::ip::tcp::socket> stream_;
    const session::Services& services_;
    const session::SessionId id_;
    const Patience patience_;
    std::shared_ptr<session::Session> session_;
    asio::steady_timer readDeadline_, writeDeadline_;
    asio::steady_timer resume_;  // cancelled to wake the reader
    std::deque<Outgoing> outgoing_;
    std::size_t outgoingControlBytes_ = 0;
    bool writing_ = false, ending_ = false, closed_ = false;
};

}  // namespace haustra::net
