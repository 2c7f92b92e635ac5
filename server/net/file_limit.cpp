#include "net/file_limit.h"

#include <algorithm>
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

}  // namespace

Result<void> makeRoomForSockets(int sessions, int strangers) {
    rlimit limit{};
    std::error_code error;
    const std::filesystem::directory_iterator open("/proc/self/fd", error);
    if (error || ::getrlimit(RLIMIT_NOFILE, &limit) != 0)
        return fail(ErrorKind::device, "cannot tell how many files are open", "server");
    const rlim_t others = rlim_t(std::distance(begin(open), end(open)) + strangers) + passing;
    const rlim_t wanted = others + rlim_t(sessions);
    if (limit.rlim_cur >= wanted) return {};
    const rlim_t most = limit.rlim_max;
    limit.rlim_cur = std::min(wanted, most);
    if (most >= wanted && ::setrlimit(RLIMIT_NOFILE, &limit) == 0) return {};
    return fail(ErrorKind::device,
                std::to_string(sessions) + " sessions need " + std::to_string(wanted) +
                    " open files, and this process may have " + std::to_string(most) +
                    ", in which " + std::to_string(most - std::min(most, others)) +
                    " sessions fit: raise the limit (systemd's LimitNOFILE, a shell's ulimit -Hn)",
                "--max-sessions");
}

}  // namespace haustra::net
