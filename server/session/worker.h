// Work that goes to other threads and comes back, and what an exception on the way costs: one
// request, never a thread, and with it the server.
#pragma once

#include "core/result.h"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <thread>
#include <utility>
#include <vector>

namespace asio {
class any_io_executor;
}

namespace haustra::session {

/// A queue between threads: any thread pushes, any thread takes, in order.
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

/// What `work` returns, a Result; memory that runs out in a library costs that one request.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::device, "there is not enough memory", "server");
    } catch (const std::exception& error) {
        return fail(ErrorKind::device, error.what(), "server");
    }
}

/// Logs that a thread goes on after a fault.
void logFault(const char* thread, const std::exception& fault);

/// A worker thread's loop: gives `serve` a queue's work, at most `most` pieces at a time, until the
/// queue is closed and drained. What `serve` throws is logged and costs those pieces alone; to
/// answer for them is its own affair (guarded).
template <class T, class Serve>
void serveQueue(WorkQueue<T>& queue, std::size_t most, const char* thread, Serve&& serve) {
    for (auto taken = queue.take(most); !taken.empty(); taken = queue.take(most)) {
        try {
            serve(taken);
        } catch (const std::exception& fault) {
            logFault(thread, fault);
        }
    }
}

/// A queue and the threads that serve it.
template <class T>
class Worker {
public:
    Worker() = default;
    /// Serves what waits, and joins.
    ~Worker() {
        queue_.close();
        for (std::thread& thread : threads_)
            thread.join();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// One thread more; what `serve` holds lives and dies with it. As serveQueue takes it.
    template <class Serve>
    void start(const char* thread, std::size_t most, Serve serve) {
        threads_.emplace_back([this, thread, most, serve = std::move(serve)]() mutable {
            serveQueue(queue_, most, thread, serve);
        });
    }

    /// From any thread; never blocks.
    void push(T work) { queue_.push(std::move(work)); }

private:
    WorkQueue<T> queue_;
    std::vector<std::thread> threads_;
};

void post(const asio::any_io_executor& io, std::function<void()> work);

/// Runs `work`(*owner) on the io thread, where the owner still lives. What it throws goes to
/// owner->broken(what), which ends the owner's session alone.
template <class Owner, class Work>
void postTo(const asio::any_io_executor& io, std::weak_ptr<Owner> owner, Work work) {
    post(io, [owner = std::move(owner), work = std::move(work)]() mutable {
        const auto self = owner.lock();
        if (!self) return;
        try {
            work(*self);
        } catch (const std::exception& fault) {
            self->broken(fault.what());
        }
    });
}

}  // namespace haustra::session
