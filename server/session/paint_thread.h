// The thread that finds what pictures have shown of walls, and paints them.
#pragma once

#include "session/work_queue.h"

#include <functional>
#include <memory>
#include <thread>

namespace haustra::session {

/// Owns nothing but its queue. Tasks may come from any thread; never blocks. WallReading bounds how
/// many of a session's wait here.
class PaintThread {
public:
    static std::unique_ptr<PaintThread> start();
    /// Does what waits, and joins.
    ~PaintThread();
    PaintThread(const PaintThread&) = delete;
    PaintThread& operator=(const PaintThread&) = delete;

    /// Runs on the paint thread, after all that were given before; must not throw.
    void run(std::function<void()> task) { tasks_.push(std::move(task)); }

private:
    PaintThread() = default;

    WorkQueue<std::function<void()>> tasks_;
    std::thread thread_;
};

}  // namespace haustra::session
