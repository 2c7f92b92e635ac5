// Characters that are not shown but do something to the text around them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace haustra {

/// C0 and C1, the separators of lines and paragraphs, the marks that turn the direction of writing
/// round.
constexpr bool isControlCharacter(std::uint32_t code) {
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || (code >= 0x2028 && code <= 0x202e) ||
           (code >= 0x2066 && code <= 0x2069) || code == 0x200e || code == 0x200f || code == 0x61c;
}

/// The character of a text in UTF-8 that begins at a byte, and its length; a length of 0 where the
/// text ends before it does. Bytes are not checked.
struct Utf8Character {
    std::uint32_t code = 0;
    std::size_t length = 0;
};
constexpr Utf8Character characterAt(std::string_view utf8, std::size_t at) {
    const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(utf8[at + n]); };
    const unsigned first = byte(0);
    const std::size_t length = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (at + length > utf8.size()) return {};
    std::uint32_t code = length == 1 ? first : first & (0x7fu >> length);
    for (std::size_t n = 1; n < length; ++n)
        code = code << 6 | (byte(n) & 0x3fu);
    return {code, length};
}

}  // namespace haustra
