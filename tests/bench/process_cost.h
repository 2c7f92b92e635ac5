// What work costs the process: time, memory, and the same from a standing start.
#pragma once

#include <cstddef>
#include <functional>

namespace haustra::bench {

struct Cost {
    double wallS = 0.0, userS = 0.0, systemS = 0.0;  ///< of all threads
    double peakMiB = 0.0;                            ///< largest resident size, the mesh included
    double cpuS() const { return userS + systemS; }
};

/// Reads the process's clocks since it was made, and its peak since then.
class Stopwatch {
public:
    Stopwatch();
    Cost read() const;

private:
    Cost start_;
};

/// Runs `work`, which fills `size` bytes, in a process forked for it, whose memory is as fresh as
/// at a program's start: what is free here has been given back. Ends the program where that fails.
void inFreshProcess(void* outcome, std::size_t size, const std::function<void()>& work);

/// The same for work that returns a plain value.
template <class Outcome>
Outcome inFreshProcess(const std::function<Outcome()>& work) {
    Outcome outcome{};
    inFreshProcess(&outcome, sizeof outcome, [&] { outcome = work(); });
    return outcome;
}

}  // namespace haustra::bench
