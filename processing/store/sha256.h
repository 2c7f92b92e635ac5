// SHA-256, for keys and for finding damage.
#pragma once

#include "core/result.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct evp_md_ctx_st;

namespace haustra::store {

using Digest = std::array<std::uint8_t, 32>;

/// 64 lower-case hexadecimal digits.
std::string toHex(const Digest& digest);
/// The other way; digits that are missing are 0.
Digest digestFromHex(std::string_view hex);

/// One running hash (OpenSSL EVP). Belongs to one thread.
class Sha256 {
public:
    Sha256();
    void add(std::span<const std::byte> bytes);
    void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
    /// The length in 8 bytes, little endian, then the text: no two sequences of texts run together
    /// to the same bytes.
    void addWithLength(std::string_view text);
    /// The hash of all that was added; call it once.
    Digest finish();

private:
    struct Free {
        void operator()(evp_md_ctx_st* context) const;
    };
    std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// SHA-256 of one text.
Digest textDigest(std::string_view text);

inline constexpr std::size_t digestBlockBytes = std::size_t(4) << 20;

/// SHA-256 of the SHA-256s of consecutive blocks of 4 MiB: the same value for any number of
/// threads (≤ 0: all cores), at the speed of all of them.
Digest blockwiseDigest(std::span<const std::byte> bytes, int threads = 0);

/// The same from the blocks' own.
Digest blockwiseDigest(std::span<const Digest> blocks);

/// SHA-256 of a file's content, read once from front to back.
Result<Digest> fileDigest(const std::filesystem::path& file);

}  // namespace haustra::store
