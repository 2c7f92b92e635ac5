#include "store/durable_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace haustra::store {
namespace {

tl::unexpected<Error> systemError(const std::string& doing, const std::filesystem::path& place) {
    return fail(ErrorKind::io, "cannot " + doing + ": " + std::strerror(errno), place.string());
}

bool writeAll(int descriptor, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        // Linux writes at most 2 GiB at once; smaller pieces let the disk start early.
        const std::size_t piece = std::min(bytes.size(), std::size_t(16) << 20);
        const ssize_t count = ::write(descriptor, bytes.data(), piece);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        bytes = bytes.subspan(std::size_t(count));
    }
    return true;
}

}  // namespace

Result<void> writeDurably(const std::filesystem::path& folder, const std::string& name,
                          const std::vector<std::span<const std::byte>>& parts,
                          unsigned permissions) {
    return writeDurably(
        folder, name,
        [&](int descriptor) {
            return std::all_of(parts.begin(), parts.end(),
                               [&](auto part) { return writeAll(descriptor, part); });
        },
        permissions);
}

Result<void> writeDurably(const std::filesystem::path& folder, const std::string& name,
                          const std::function<bool(int descriptor)>& write, unsigned permissions) {
    const std::filesystem::path temporary =
        folder / (temporaryPrefix + name + "-" + std::to_string(::getpid()));
    const int descriptor =
        ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, permissions);
    if (descriptor < 0) return systemError("create", temporary);

    if (!write(descriptor) || ::fsync(descriptor) != 0) {
        const auto error = systemError("write", folder / name);
        ::close(descriptor);
        ::unlink(temporary.c_str());
        return error;
    }
    if (::close(descriptor) != 0 || ::rename(temporary.c_str(), (folder / name).c_str()) != 0) {
        const auto error = systemError("publish", folder / name);
        ::unlink(temporary.c_str());
        return error;
    }
    return syncFolder(folder);
}

Result<void> syncFolder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return systemError("open", folder);
    const bool synced = ::fsync(descriptor) == 0;
    const auto error = systemError("fsync", folder);
    ::close(descriptor);
    if (!synced) return error;
    return {};
}

}  // namespace haustra::store
