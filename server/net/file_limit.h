// How many files and sockets the server may have open at a time.
#pragma once

#include "core/result.h"

namespace haustra::net {

/// Raises this process's soft limit of open files (RLIMIT_NOFILE) towards its hard one, so that
/// on top of what is open now there is room for `sessions`, for `strangers` who have not said hello
/// yet, a socket each, and for the files of the cases that are being read. Fails (device) where the
/// hard limit is too low, saying how many sessions fit, or the system refuses. For the end of the
/// server's start, when the records, the GPU and all else that stays open is.
Result<void> makeRoomForSockets(int sessions, int strangers);

}  // namespace haustra::net
