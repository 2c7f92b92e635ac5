// Reading .gz or plain files, and writing .gz files on several threads.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
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
    /// Reads on to the end of the compressed data, so that its checksum is verified.
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

/// Writes `head` and then `body` to `out` as one gzip member, compressed for speed in blocks on
/// `threads` threads (≤ 0: all cores). The bytes do not depend on the number of threads. Check
/// `out` afterwards.
void writeGzip(std::ostream& out, std::span<const std::byte> head, std::span<const std::byte> body,
               int threads);

}  // namespace haustra::nifti
