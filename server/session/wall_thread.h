// The thread that answers questions about walls: measuring may take longer than a socket can wait.
#pragma once

#include "session/open_case.h"
#include "session/wall.h"
#include "session/work_queue.h"

#include <functional>
#include <memory>
#include <thread>

namespace haustra::session {

/// Owns nothing but its queue. A session has one question here at a time, so that sessions take
/// turns however much one of them asks. Questions may come from any thread; never blocks.
class WallThread {
public:
    static std::unique_ptr<WallThread> start();
    /// Answers what waits, and joins.
    ~WallThread();
    WallThread(const WallThread&) = delete;
    WallThread& operator=(const WallThread&) = delete;

    /// `done` is called on the wall thread. The case has a wall.
    using Done = std::function<void(Result<WallAnswer>)>;
    void ask(std::shared_ptr<const OpenCase> of, WallQuestion question, Done done);

private:
    struct Request {
        std::shared_ptr<const OpenCase> of;
        WallQuestion question;
        Done done;
    };
    WallThread() = default;

    WorkQueue<Request> requests_;
    std::thread thread_;
};

}  // namespace haustra::session
