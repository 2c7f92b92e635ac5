// The TLS connection to a server: one thread owns the socket, another decodes the tiles that come
// over it; queues lead to and from them.
#pragma once

#include "link/known_servers.h"
#include "link/server_address.h"
#include "protocol/haustra.pb.h"
#include "tiles/picture.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace haustra::link {

using Clock = std::chrono::steady_clock;

struct ConnectionOptions {
    ServerAddress address;
    Pinning pinning;
    std::string software = "haustra-client";
    std::string reader;      ///< whose ledger it is of what has been seen; empty: nobody's
    bool reconnect = false;  ///< try again after a loss, with growing pauses of up to 5 s
    std::chrono::milliseconds connectPatience{10'000};  ///< for name, TCP, TLS and welcome together
    std::chrono::milliseconds silencePatience{
        30'000};                    ///< without one byte the link counts as lost
    std::function<void()> onEvent;  ///< called on the decoding thread after an event was queued
};

/// The server was met, its certificate accepted and the hello answered.
struct LinkUp {
    std::string fingerprint;
    bool firstUse = false;                 ///< the certificate was pinned just now
    std::string serverSoftware, renderer;  ///< fit to be shown (peer_text.h)
    std::set<std::string> capabilities;    ///< of the server (protocol/capabilities.h)
};
/// The link is gone. Where `final`, no further event follows.
struct LinkDown {
    Error error;
    bool final = true;
};
/// A picture all of whose tiles have come, and when they were decoded.
struct PictureDone {
    tiles::Picture picture;
    Clock::time_point decodedAt;
};
using Event = std::variant<LinkUp, LinkDown, PictureDone, protocol::ServerMessage>;

/// Connects from construction on. Says hello and keeps the link alive with pings by itself. TLS
/// 1.3 only; the certificate is checked by its pinned fingerprint (known_servers.h), before any
/// byte of the protocol is sent. Events come in the order in which their last bytes did; a tile
/// that is none ends the connection for good. All functions may be called from any thread, `next`
/// from one.
class Connection {
public:
    explicit Connection(ConnectionOptions options);
    /// Closes the socket and joins the threads; what `send` queued may be lost.
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Queues a message. It goes out only over the link whose LinkUp `next` has returned: after a
    /// loss the caller learns of it, and decides what to say again. Never blocks.
    void send(const protocol::ClientMessage& message);

    /// The next event, waiting at most `patience` for it. Reading from the socket pauses while
    /// 64 MiB of tiles and messages wait to be decoded, and decoding while as much of pictures and
    /// messages waits here; a message counts as what it takes in memory, at most.
    std::optional<Event> next(std::chrono::milliseconds patience);

    /// Median of the last few ping times; 0 before the first.
    double roundTripMs() const;
    /// Payload and header bytes received since construction.
    std::uint64_t receivedBytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::link
