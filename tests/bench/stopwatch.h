// Elapsed and processor time for benches, and what is said of several of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

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

/// The smallest value that at least `share` of the values do not exceed, as near as they come;
/// 0 of none.
inline double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0.0 : values[std::size_t(share * double(values.size() - 1))];
}

/// The upper one of two in the middle; 0 of no values.
inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0.0 : values[values.size() / 2];
}

}  // namespace haustra::bench
