// Reading .gz or plain files, and writing .gz files on several threads.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <span>

namespace haustra::nifti {

/// A file read from front to back, decompressed where it is gzip, as it is where not.
class MaybeGzipFile {
public:
    static Result<MaybeGzipFile> open(const std::filesystem::path& file);

    /// Fills `bytes` wholly, or fails: the file is truncated or its compression damaged.
    Result<void> read(std::span<std::byte> bytes);
    /// Reads up to 64 KiB more: where the compressed data end within that, their checksum is
    /// verified. Fails (badInput) where they are damaged.
    Result<void> finish();
    bool compressed() const { return compressed_; }
    /// No file of this size holds more bytes than this once decompressed.
    std::uint64_t mostBytes() const { return mostBytes_; }

private:
    MaybeGzipFile() = default;
    Error error() const;

    std::shared_ptr<void> stream_;
    std::string place_;
    bool compressed_ = false;
    std::uint64_t mostBytes_ = 0;
};

/// The body of a file, of which any part can be had at any time and from any thread.
struct ByteSource {
    std::size_t size = 0;
    /// The bytes from `offset` on, as many as `room` has: where they lie already, or made in it.
    std::function<std::span<const std::byte>(std::size_t offset, std::span<std::byte> room)> part;
};

/// Writes `head` and then `body` to `out` as one gzip member, compressed for speed in blocks on
/// `threads` threads (≤ 0: all cores). The bytes do not depend on the number of threads. Check
/// `out` afterwards.
void writeGzip(std::ostream& out, std::span<const std::byte> head, const ByteSource& body,
               int threads);
/// The same, not compressed.
void writePlain(std::ostream& out, std::span<const std::byte> head, const ByteSource& body);

}  // namespace haustra::nifti
