// The SHA-256 fingerprint of a server's certificate: what a client pins.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <span>
#include <string>

namespace haustra::link {

/// SHA-256 of the certificate's DER bytes as 64 lower-case hexadecimal digits.
std::string fingerprintOf(std::span<const std::uint8_t> certificateDer);

/// Accepts what people paste: either case, colons or spaces between digits, a leading "SHA256:".
/// Returns 64 lower-case digits; fails on anything else.
Result<std::string> normalizeFingerprint(const std::string& text);

}  // namespace haustra::link
