#include "store/durable_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

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

/// Closed and removed again, unless it has been published.
class TemporaryFile {
public:
    TemporaryFile(std::filesystem::path file, unsigned permissions)
        : file_(std::move(file)),
          descriptor_(::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, permissions)),
          isThere_(descriptor_ >= 0) {}
    ~TemporaryFile() {
        const int error = errno;  // may still be asked for
        if (descriptor_ >= 0) ::close(descriptor_);
        if (isThere_) ::unlink(file_.c_str());
        errno = error;
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    int descriptor() const { return descriptor_; }
    /// False: it failed, and errno says why.
    bool publishAs(const std::filesystem::path& name) {
        if (::close(std::exchange(descriptor_, -1)) != 0) return false;
        if (::rename(file_.c_str(), name.c_str()) != 0) return false;
        isThere_ = false;
        return true;
    }

private:
    std::filesystem::path file_;
    int descriptor_;
    bool isThere_;
};

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
    TemporaryFile file(temporary, permissions);
    if (file.descriptor() < 0) return systemError("create", folder / name);
    if (!write(file.descriptor()) || ::fsync(file.descriptor()) != 0)
        return systemError("write", folder / name);
    if (!file.publishAs(folder / name)) return systemError("publish", folder / name);
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
