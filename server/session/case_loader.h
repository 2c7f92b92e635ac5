// The thread that reads cases and prepares them, so that no picture has to wait for it.
#pragma once

#include "session/open_case.h"
#include "session/render_thread.h"
#include "session/worker.h"

#include <atomic>
#include <functional>
#include <memory>
#include <string>

namespace haustra::session {

/// Opens one case after the other. Its functions may be called from any thread and never block.
class CaseLoader {
public:
    /// The render thread must outlive the loader.
    CaseLoader(store::CaseStore store, RenderThread& renderer);
    /// Finishes the case under way, drops those that wait, and joins.
    ~CaseLoader() { stopping_ = true; }

    using Opened = std::function<void(Result<std::shared_ptr<const OpenCase>>)>;
    /// Sessions on one case with the same products share one renderer. `opened` is called on the
    /// loader thread, and must not throw; after seconds, for a case that has no renderer. Nothing
    /// is read for a session that has ended by its turn, and `opened` is not called.
    void openCase(std::string name, std::weak_ptr<const void> session, Opened opened);

private:
    struct Request {
        std::string name;
        std::weak_ptr<const void> session;
        Opened opened;
    };

    std::atomic<bool> stopping_{false};
    Worker<Request> worker_;  // last: it reads the rest
};

}  // namespace haustra::session
