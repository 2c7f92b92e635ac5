// Pages of mapped files that can no longer be read: the file was cut short, or its disk fails.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

namespace haustra::store {

/// From now on such a page reads as zeros, and isWhole() and firstLostFile() tell, where otherwise
/// SIGBUS would end the program. A program's main calls this, once, before it maps a product.
/// SIGBUS of any other cause ends the program as ever.
void surviveLostPages();

/// A file mapped into memory, read-only, and watched. Immutable; unmapped when it dies.
class MappedFile {
public:
    /// Fails (notFound, io) where the file cannot be opened or mapped, (badInput) where it has
    /// fewer than `leastBytes`, (io) where 4096 files are mapped already.
    static Result<std::shared_ptr<const MappedFile>> open(const std::filesystem::path& file,
                                                          std::size_t leastBytes);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::span<const std::byte> bytes() const { return {address_, size_}; }

private:
    MappedFile() = default;

    const std::byte* address_ = nullptr;
    std::size_t size_ = 0;
    std::size_t slot_ = 0;
    std::filesystem::path file_;
};

/// Whether all pages that have been read of the mapped file which `address` lies in were there.
/// True of other memory. What was computed from a file that is not whole is worth nothing. Any
/// thread.
bool isWhole(const void* address);

/// The first file of which this program has lost a page; none where all were whole. Any thread.
std::optional<std::filesystem::path> firstLostFile();

}  // namespace haustra::store
