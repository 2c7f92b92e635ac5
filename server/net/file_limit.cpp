#include "net/file_limit.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <string>

#include <sys/resource.h>

namespace haustra::net {
namespace {

// What comes and goes: the listening socket, one that is about to be refused, signals, a case's
// files on the loader and the records thread (a mapped one is closed), SQLite's journals, the
// driver's cache of programs.
constexpr rlim_t passing = 32;
// Open files where there is no /proc to count them by, as in a chroot.
constexpr rlim_t assumed = 64;

rlim_t openFiles() {
    std::error_code error;
    const std::filesystem::directory_iterator open("/proc/self/fd", error);
    return error ? assumed : rlim_t(std::distance(begin(open), end(open)));
}

}  // namespace

Result<void> makeRoomForSockets(int sessions, int strangers) {
    const auto refuse = [&](rlim_t wanted, const std::string& why) {
        return fail(ErrorKind::device,
                    std::to_string(sessions) + " sessions need " + std::to_string(wanted) +
                        " open files, and " + why,
                    "--max-sessions");
    };
    const rlim_t others = openFiles() + rlim_t(strangers) + passing;
    const rlim_t wanted = others + rlim_t(sessions);
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0)
        return refuse(wanted, std::string("their limit is not told: ") + std::strerror(errno));
    if (limit.rlim_cur >= wanted) return {};
    const rlim_t most = limit.rlim_max;
    if (most < wanted)
        return refuse(wanted, "this process may have " + std::to_string(most) + ", in which " +
                                  std::to_string(most - std::min(most, others)) +
                                  " sessions fit: raise the limit (systemd's LimitNOFILE, a "
                                  "shell's ulimit -Hn)");
    limit.rlim_cur = wanted;
    if (::setrlimit(RLIMIT_NOFILE, &limit) != 0)
        return refuse(wanted, std::string("their limit cannot be raised: ") + std::strerror(errno));
    return {};
}

}  // namespace haustra::net
