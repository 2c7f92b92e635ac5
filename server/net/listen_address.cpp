#include "net/listen_address.h"

#include <charconv>

#include <asio/ip/address.hpp>

namespace haustra::net {

Result<ListenAddress> parseListenAddress(const std::string& text) {
    const auto refuse = [&](const char* what) {
        return fail(ErrorKind::badInput, "\"" + text + "\" " + what, "listen address");
    };
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) return refuse("is not IP:PORT");
    std::string ip = text.substr(0, colon);
    if (ip.size() > 2 && ip.front() == '[' && ip.back() == ']')
        ip = ip.substr(1, ip.size() - 2);
    else if (ip.find(':') != std::string::npos)
        return refuse("needs brackets around its IPv6 address");
    if (ip == "localhost") ip = "127.0.0.1";
    asio::error_code error;
    asio::ip::make_address(ip, error);
    if (error) return refuse("has no numeric IP address before its port");

    ListenAddress address{ip, 0};
    const char* const first = text.data() + colon + 1;
    const char* const last = text.data() + text.size();
    const auto [end, code] = std::from_chars(first, last, address.port);
    if (code != std::errc{} || end != last) return refuse("has no port of 0 to 65535");
    return address;
}

std::string toString(const ListenAddress& address) {
    const bool v6 = address.ip.find(':') != std::string::npos;
    return (v6 ? "[" + address.ip + "]" : address.ip) + ":" + std::to_string(address.port);
}

}  // namespace haustra::net
