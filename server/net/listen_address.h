// Where the server listens.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <string>

namespace haustra::net {

struct ListenAddress {
    std::string ip = "127.0.0.1";
    std::uint16_t port = 7117;  ///< 0: any that is free
};

/// "127.0.0.1:7117", "[::1]:7117", "localhost:0". Only numeric addresses and localhost: what a
/// server listens on must not depend on a name service. Fails (badInput) with a sentence on what
/// is wrong.
Result<ListenAddress> parseListenAddress(const std::string& text);

/// As parseListenAddress reads it.
std::string toString(const ListenAddress& address);

}  // namespace haustra::net
