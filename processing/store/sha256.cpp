#include "store/sha256.h"

#include "core/parallel.h"

#include <cerrno>
#include <cstring>
#include <new>
#include <vector>

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

namespace haustra::store {

std::string toHex(const Digest& digest) {
    static constexpr char digits[] = "0123456789abcdef";
    std::string hex;
    for (const std::uint8_t byte : digest) {
        hex += digits[byte >> 4];
        hex += digits[byte & 15];
    }
    return hex;
}

Digest digestFromHex(std::string_view hex) {
    const auto value = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
    Digest digest{};
    for (std::size_t n = 0; n < digest.size() && 2 * n + 1 < hex.size(); ++n)
        digest[n] = std::uint8_t(value(hex[2 * n]) << 4 | value(hex[2 * n + 1]));
    return digest;
}

void Sha256::Free::operator()(evp_md_ctx_st* context) const {
    EVP_MD_CTX_free(context);
}

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
    if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) {
        throw std::bad_alloc();
    }
}

void Sha256::add(std::span<const std::byte> bytes) {
    EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
}

void Sha256::addWithLength(std::string_view text) {
    std::array<std::byte, 8> length;
    for (int n = 0; n < 8; ++n)
        length[n] = std::byte(std::uint64_t(text.size()) >> (8 * n));
    add(length);
    add(text);
}

Digest Sha256::finish() {
    Digest digest{};
    EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr);
    return digest;
}

Digest blockwiseDigest(std::span<const std::byte> bytes, int threads) {
    constexpr std::size_t blockBytes = digestBlockBytes;
    std::vector<Digest> blocks((bytes.size() + blockBytes - 1) / blockBytes);
    parallelFor(blocks.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const std::size_t start = n * blockBytes;
            Sha256 hash;
            hash.add(bytes.subspan(start, std::min(blockBytes, bytes.size() - start)));
            blocks[n] = hash.finish();
        }
    });
    return blockwiseDigest(blocks);
}

Digest blockwiseDigest(std::span<const Digest> blocks) {
    Sha256 hash;
    hash.add(std::as_bytes(blocks));
    return hash.finish();
}

Result<Digest> fileDigest(const std::filesystem::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return fail(ErrorKind::io, std::string("cannot open: ") + std::strerror(errno),
                    file.string());
    }
    Sha256 hash;
    std::vector<std::byte> buffer(std::size_t(1) << 18);
    ssize_t count;
    do {
        count = ::read(descriptor, buffer.data(), buffer.size());
        if (count > 0) hash.add(std::span(buffer).first(std::size_t(count)));
    } while (count > 0 || (count < 0 && errno == EINTR));
    const int error = errno;
    ::close(descriptor);
    if (count < 0) {
        return fail(ErrorKind::io, std::string("cannot read: ") + std::strerror(error),
                    file.string());
    }
    return hash.finish();
}

Digest textDigest(std::string_view text) {
    Sha256 hash;
    hash.add(text);
    return hash.finish();
}

}  // namespace haustra::store
