#include "link/peer_text.h"

#include <cstdint>

namespace haustra::link {
namespace {

// C0 and C1, the separators of lines and paragraphs, the marks that turn the direction round.
bool isControl(std::uint32_t c) {
    return c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0x2028 && c <= 0x202e) ||
           (c >= 0x2066 && c <= 0x2069) || c == 0x200e || c == 0x200f || c == 0x61c;
}

// The length of the character that begins with this byte.
std::size_t lengthOf(unsigned char first) {
    return first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

}  // namespace

std::string peerText(const std::string& said, std::size_t mostBytes, bool keepLines) {
    std::string text;
    for (std::size_t at = 0; at < said.size();) {
        const auto first = static_cast<unsigned char>(said[at]);
        const std::size_t length = lengthOf(first);
        if (at + length > said.size()) break;
        if (at + length > mostBytes) return text + "…";
        std::uint32_t code = length == 1 ? first : first & (0x7fu >> length);
        for (std::size_t n = 1; n < length; ++n)
            code = code << 6 | (static_cast<unsigned char>(said[at + n]) & 0x3fu);
        if (isControl(code) && !(keepLines && (code == '\n' || code == '\t')))
            text += ' ';
        else
            text.append(said, at, length);
        at += length;
    }
    return text;
}

}  // namespace haustra::link
