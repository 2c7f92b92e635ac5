// Elapsed and processor time, for benches.
#pragma once

#include <chrono>

#include <sys/resource.h>

namespace haustra::bench {

inline double milliseconds() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// CPU time of the process, all threads: what a machine that others use does not blur.
inline double cpuMilliseconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) {
        return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec);
    };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

}  // namespace haustra::bench
