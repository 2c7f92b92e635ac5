// A fuzzer's input as a file that never touches a disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace haustra::tests {

class MemoryFile {
public:
    MemoryFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("fuzz", 0)) {
        for (std::size_t at = 0; file_ >= 0 && at < size;) {
            const ssize_t wrote = write(file_, data + at, size - at);
            if (wrote <= 0) break;
            at += std::size_t(wrote);
        }
    }
    ~MemoryFile() {
        if (file_ >= 0) close(file_);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(file_); }

private:
    int file_;
};

}  // namespace haustra::tests
