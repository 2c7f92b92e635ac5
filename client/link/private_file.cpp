#include "link/private_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace haustra::link {
namespace {

bool writeWhole(int descriptor, const std::string& text) {
    for (std::size_t written = 0; written < text.size();) {
        const ssize_t count = ::write(descriptor, text.data() + written, text.size() - written);
        if (count > 0)
            written += std::size_t(count);
        else if (errno != EINTR)
            return false;
    }
    return ::fsync(descriptor) == 0;
}

// So that the names in it survive a power cut.
bool syncFolder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
    if (descriptor < 0) return false;
    // Some network file systems know no fsync of a folder.
    const bool synced = ::fsync(descriptor) == 0 || errno == EINVAL;
    ::close(descriptor);
    return synced;
}

}  // namespace

std::optional<std::filesystem::path> userFolder(const char* variable, const char* underHome) {
    const auto named = [](const char* name) {
        const char* value = std::getenv(name);
        return std::filesystem::path(value ? value : "");
    };
    if (const auto folder = named(variable); folder.is_absolute()) return folder;
    if (const auto home = named("HOME"); home.is_absolute()) return home / underHome;
    return std::nullopt;
}

Result<void> writePrivateFile(const std::filesystem::path& file, const std::string& text) {
    const auto folder = file.parent_path();
    if (!folder.empty()) {
        std::error_code error;
        const bool made = std::filesystem::create_directories(folder, error);
        if (error)
            return fail(ErrorKind::io, "cannot make the folder: " + error.message(),
                        folder.string());
        if (made) std::filesystem::permissions(folder, std::filesystem::perms::owner_all, error);
    }
    const auto refuse = [&](int reason) {
        return fail(ErrorKind::io, std::string("cannot write the file: ") + std::strerror(reason),
                    file.string());
    };
    std::string temporary = file.string() + ".XXXXXX";
    const int descriptor = ::mkstemp(temporary.data());  // of mode 0600
    if (descriptor < 0) return refuse(errno);
    int reason = writeWhole(descriptor, text) ? 0 : errno;
    if (::close(descriptor) != 0 && reason == 0) reason = errno;
    if (reason == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) reason = errno;
    if (reason != 0) {
        ::unlink(temporary.c_str());
        return refuse(reason);
    }
    if (!syncFolder(folder)) return refuse(errno);
    return {};
}

}  // namespace haustra::link
