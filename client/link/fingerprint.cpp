#include "link/fingerprint.h"

#include <cctype>
#include <cstring>

#include <openssl/sha.h>

namespace haustra::link {

std::string fingerprintOf(std::span<const std::uint8_t> certificateDer) {
    unsigned char digest[SHA256_DIGEST_LENGTH];
    SHA256(certificateDer.data(), certificateDer.size(), digest);
    static constexpr char digits[] = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : digest) {
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

Result<std::string> normalizeFingerprint(const std::string& text) {
    static constexpr char prefix[] = "sha256:";
    std::string lower;
    for (const char c : text)
        lower += char(std::tolower(static_cast<unsigned char>(c)));
    if (lower.starts_with(prefix)) lower.erase(0, std::strlen(prefix));
    std::string digits;
    for (const char c : lower) {
        if (c == ':' || c == ' ') continue;
        if (!std::isxdigit(static_cast<unsigned char>(c)))
            return fail(ErrorKind::badInput, "a fingerprint has only hexadecimal digits", text);
        digits += c;
    }
    if (digits.size() != 2 * SHA256_DIGEST_LENGTH)
        return fail(ErrorKind::badInput, "a SHA-256 fingerprint has 64 hexadecimal digits", text);
    return digits;
}

}  // namespace haustra::link
