// Keeping one request's exceptions from ending its thread, and with it the server.
#pragma once

#include "core/result.h"
#include "session/work_queue.h"

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <utility>

namespace asio {
class any_io_executor;
}

namespace haustra::session {

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
void serveQueue(WorkQueue<T>& queue, std::size_t most, const char* thread, const Serve& serve) {
    for (auto taken = queue.take(most); !taken.empty(); taken = queue.take(most)) {
        try {
            serve(taken);
        } catch (const std::exception& fault) {
            logFault(thread, fault);
        }
    }
}

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
