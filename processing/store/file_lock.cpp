#include "store/file_lock.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace haustra::store {
namespace {

class Descriptor {
public:
    explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
    ~Descriptor() { ::close(descriptor_); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

private:
    int descriptor_;
};

}  // namespace

Result<std::shared_ptr<const void>> lockFile(const std::filesystem::path& file, WhereLocked then) {
    const auto refuse = [&](const char* doing) {
        return fail(ErrorKind::io, std::string("cannot ") + doing + ": " + std::strerror(errno),
                    file.string());
    };
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
    if (descriptor < 0) return refuse("open");
    auto lock = std::make_shared<const Descriptor>(descriptor);
    const int operation = then == WhereLocked::wait ? LOCK_EX : LOCK_EX | LOCK_NB;
    while (::flock(descriptor, operation) != 0) {
        if (errno == EWOULDBLOCK)
            return fail(ErrorKind::wrongState, "it is locked by another process", file.string());
        if (errno != EINTR) return refuse("lock");
    }
    return std::shared_ptr<const void>(std::move(lock));
}

}  // namespace haustra::store
