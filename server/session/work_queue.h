// A queue between threads.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

namespace haustra::session {

/// Any thread pushes, any thread takes, in order.
template <class T>
class WorkQueue {
public:
    void push(T work) {
        {
            const std::lock_guard lock(mutex_);
            work_.push_back(std::move(work));
        }
        arrived_.notify_one();
    }

    /// Waits for work and takes at most `most` of it. Empty once the queue is closed and drained.
    std::deque<T> take(std::size_t most) {
        std::unique_lock lock(mutex_);
        arrived_.wait(lock, [this] { return closed_ || !work_.empty(); });
        std::deque<T> taken;
        while (!work_.empty() && taken.size() < most) {
            taken.push_back(std::move(work_.front()));
            work_.pop_front();
        }
        return taken;
    }

    /// Nothing is pushed after this. Wakes everybody who waits.
    void close() {
        {
            const std::lock_guard lock(mutex_);
            closed_ = true;
        }
        arrived_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<T> work_;   // guarded by mutex_
    bool closed_ = false;  // guarded by mutex_
};

}  // namespace haustra::session
