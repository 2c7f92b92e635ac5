#include "session/paint_thread.h"

#include "session/guarded.h"

namespace haustra::session {

std::unique_ptr<PaintThread> PaintThread::start() {
    std::unique_ptr<PaintThread> self(new PaintThread);
    self->thread_ = std::thread([&tasks = self->tasks_] {
        serveQueue(tasks, 1, "paint", [](auto& taken) { taken.front()(); });
    });
    return self;
}

PaintThread::~PaintThread() {
    tasks_.close();
    if (thread_.joinable()) thread_.join();
}

}  // namespace haustra::session
