// Threads that wait for work.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace haustra {

/// Threads that stay between one run of tasks and the next. Each begins with its own stretch of the
/// tasks, so that neighbouring tasks (tiles of a picture) share a core's cache, and takes half of
/// another's rest when it has done. parallelFor (parallel.h) starts threads of its own instead: for
/// work of many milliseconds.
class ThreadPool {
public:
    /// `threads` in all, with the one that calls run(); ≤ 0: all cores.
    explicit ThreadPool(int threads);
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    int threads() const { return int(rests_.size()); }
    /// Calls body(task) once for each of 0 … tasks − 1, and returns when all have returned; then
    /// the first exception of a body is thrown here. The body must not depend on order or thread.
    /// One thread calls run at a time.
    void run(int tasks, const std::function<void(int task)>& body);

private:
    /// Tasks not begun yet: the first in the upper half, the end in the lower.
    struct alignas(64) Rest {
        std::atomic<std::uint64_t> range{0};
    };
    void serve(std::size_t self);
    void work(std::size_t self);
    bool steal(std::size_t self);

    std::vector<Rest> rests_;
    std::mutex mutex_;
    std::condition_variable begin_, done_;
    const std::function<void(int)>* body_ = nullptr;
    std::uint64_t round_ = 0;
    std::size_t working_ = 0;
    std::exception_ptr failure_;
    bool ending_ = false;
    std::vector<std::thread> threads_;  // last: they use the rest
};

}  // namespace haustra
