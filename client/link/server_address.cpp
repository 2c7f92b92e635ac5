#include "link/server_address.h"

#include <charconv>

namespace haustra::link {

Result<ServerAddress> parseServerAddress(const std::string& text) {
    const auto refuse = [&] {
        return fail(ErrorKind::badInput, "not a server address (HOST, HOST:PORT or [IPV6]:PORT)",
                    text);
    };
    ServerAddress address;
    std::string port;
    if (text.starts_with('[')) {
        const std::size_t close = text.find(']');
        if (close == std::string::npos) return refuse();
        address.host = text.substr(1, close - 1);
        port = text.substr(close + 1);
    } else {
        const std::size_t colon = text.find(':');
        address.host = text.substr(0, colon);
        if (colon != std::string::npos) port = text.substr(colon);
    }
    if (address.host.empty() || address.host.find_first_of(" \t\n/") != std::string::npos)
        return refuse();
    if (port.empty()) return address;
    if (port[0] != ':') return refuse();
    unsigned number = 0;
    const char* end = port.data() + port.size();
    const auto [stop, error] = std::from_chars(port.data() + 1, end, number);
    if (error != std::errc{} || stop != end || number < 1 || number > 65535) return refuse();
    address.port = std::uint16_t(number);
    return address;
}

std::string toString(const ServerAddress& address) {
    const bool bracketed = address.host.find(':') != std::string::npos;
    return (bracketed ? "[" + address.host + "]" : address.host) + ":" +
           std::to_string(address.port);
}

}  // namespace haustra::link
