#include "session/wall_thread.h"

#include "session/guarded.h"

namespace haustra::session {

std::unique_ptr<WallThread> WallThread::start() {
    std::unique_ptr<WallThread> self(new WallThread);
    self->thread_ = std::thread([&requests = self->requests_] {
        serveQueue(requests, 1, "wall", [](auto& taken) {
            const Request& request = taken.front();
            request.done(guarded([&] { return answer(*request.of->wall, request.question); }));
        });
    });
    return self;
}

WallThread::~WallThread() {
    requests_.close();
    if (thread_.joinable()) thread_.join();
}

void WallThread::ask(std::shared_ptr<const OpenCase> of, WallQuestion question, Done done) {
    requests_.push({std::move(of), std::move(question), std::move(done)});
}

}  // namespace haustra::session
