// What a stage costs in time and memory.
#pragma once

#include <chrono>

namespace haustra::pipeline {

/// Measures from its construction. The peak is the whole process's, so one meter at a time.
class StageMeter {
public:
    /// Sets the kernel's mark of the process's peak memory back to what it holds now.
    StageMeter();
    /// What was done of the stage beside others, before its turn came.
    void addBeside(double seconds) { besideSeconds_ += seconds; }
    double besideSeconds() const { return besideSeconds_; }
    /// Since construction, and beside others before.
    double wallSeconds() const;
    /// Largest resident set since construction, MiB; since the process's start where the kernel
    /// does not let the mark be set back; 0 where it does not tell.
    double peakMemoryMib() const;

private:
    std::chrono::steady_clock::time_point start_;
    double besideSeconds_ = 0.0;
};

}  // namespace haustra::pipeline
