// Where a server listens.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <string>

namespace haustra::link {

inline constexpr std::uint16_t defaultPort = 7117;

struct ServerAddress {
    std::string host;
    std::uint16_t port = defaultPort;
};

/// Reads HOST, HOST:PORT, [IPV6] or [IPV6]:PORT. Fails on an empty host or a port outside 1…65535.
Result<ServerAddress> parseServerAddress(const std::string& text);

/// "host:port", with brackets around an IPv6 host: the name under which a server is known.
std::string toString(const ServerAddress& address);

}  // namespace haustra::link
