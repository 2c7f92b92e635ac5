#include "core/durable_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace haustra {
namespace {

tl::unexpected<Error> systemError(const std::string& doing, const std::filesystem::path& place,
                                  int error = errno) {
    return fail(ErrorKind::io, "cannot " + doing + ": " + std::strerror(error), place.string());
}

bool writeAll(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        // Linux writes at most 2 GiB at once; smaller pieces let the disk start early.
        const std::size_t piece = std::min(bytes.size(), std::size_t(16) << 20);
        const ssize_t count = ::write(descriptor, bytes.data(), piece);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        bytes.remove_prefix(std::size_t(count));
    }
    return true;
}

}  // namespace

DurableFile::DurableFile(std::filesystem::path file, unsigned permissions)
    : file_(std::move(file)) {
    const std::string stem =
        temporaryPrefix + file_.filename().string() + "-" + std::to_string(::getpid()) + "-";
    int n = 0;
    do {
        beside_ = file_.parent_path() / (stem + std::to_string(n++));
        descriptor_ = ::open(beside_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, permissions);
    } while (descriptor_ < 0 && errno == EEXIST);
    isThere_ = descriptor_ >= 0;
    if (!isThere_) error_ = errno;
}

DurableFile::~DurableFile() {
    const int error = errno;  // may still be asked for
    if (descriptor_ >= 0) ::close(descriptor_);
    if (isThere_) ::unlink(beside_.c_str());
    errno = error;
}

Result<void> DurableFile::isMade() const {
    if (error_ != 0) return systemError("create", file_, error_);
    return {};
}

Result<void> DurableFile::publish() {
    TRY(isMade());
    const bool synced = ::fsync(descriptor_) == 0;
    if (::close(std::exchange(descriptor_, -1)) != 0 || !synced) return systemError("write", file_);
    if (::rename(beside_.c_str(), file_.c_str()) != 0) return systemError("publish", file_);
    isThere_ = false;
    return syncFolder(file_.parent_path());
}

Result<void> writeDurably(const std::filesystem::path& file, std::string_view text,
                          unsigned permissions) {
    return writeDurably(
        file, [&](int descriptor) { return writeAll(descriptor, text); }, permissions);
}

Result<void> writeDurably(const std::filesystem::path& file,
                          const std::function<bool(int descriptor)>& write, unsigned permissions) {
    DurableFile made(file, permissions);
    TRY(made.isMade());
    if (!write(made.descriptor())) return systemError("write", file);
    return made.publish();
}

Result<void> syncFolder(const std::filesystem::path& folder) {
    const std::filesystem::path named = folder.empty() ? "." : folder;
    const int descriptor = ::open(named.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    // Into a folder that may be written and not read, files are dropped for others: each is whole,
    // and its name cannot be waited for. A store's folders are listed, hence read.
    if (descriptor < 0 && errno == EACCES) return {};
    if (descriptor < 0) return systemError("open", named);
    // Some network file systems know no fsync of a folder.
    const bool synced = ::fsync(descriptor) == 0 || errno == EINVAL;
    const auto error = systemError("fsync", named);
    ::close(descriptor);
    if (!synced) return error;
    return {};
}

}  // namespace haustra
