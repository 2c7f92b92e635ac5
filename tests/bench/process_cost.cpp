#include "process_cost.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace haustra::bench {
namespace {

Cost clocks() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    const auto wall = std::chrono::steady_clock::now().time_since_epoch();
    return {std::chrono::duration<double>(wall).count(), seconds(usage.ru_utime),
            seconds(usage.ru_stime), 0.0};
}

double peakMiB() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) / 1024.0;
    }
    return 0.0;
}

[[noreturn]] void giveUp(const char* what) {
    std::perror(what);
    std::exit(EXIT_FAILURE);
}

}  // namespace

Stopwatch::Stopwatch() {
    std::ofstream("/proc/self/clear_refs") << "5";  // begins the peak anew
    start_ = clocks();
}

Cost Stopwatch::read() const {
    const Cost now = clocks();
    return {now.wallS - start_.wallS, now.userS - start_.userS, now.systemS - start_.systemS,
            peakMiB()};
}

void inFreshProcess(void* outcome, std::size_t size, const std::function<void()>& work) {
    malloc_trim(0);
    std::fflush(nullptr);
    int ends[2];
    if (pipe(ends) != 0) giveUp("pipe");
    const pid_t child = fork();
    if (child < 0) giveUp("fork");
    if (child == 0) {
        work();
        const bool told = write(ends[1], outcome, size) == ssize_t(size);
        std::fflush(nullptr);
        _exit(told ? EXIT_SUCCESS : EXIT_FAILURE);
    }
    close(ends[1]);
    std::size_t got = 0;
    while (got < size) {
        const ssize_t more = read(ends[0], static_cast<char*>(outcome) + got, size - got);
        if (more <= 0) break;
        got += std::size_t(more);
    }
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (got != size || status != 0) {
        std::fprintf(stderr, "a measurement's process failed\n");
        std::exit(EXIT_FAILURE);
    }
}

}  // namespace haustra::bench
