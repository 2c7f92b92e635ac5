// The thread that owns the GPU: its EGL context and every case's renderer.
#pragma once

#include "session/open_case.h"
#include "session/picture_queue.h"
#include "store/case_store.h"

#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace haustra::session {

/// Its functions may be called from any thread and never block. Callbacks come on the render
/// thread; they must not throw, nor take long.
class RenderThread {
public:
    /// Makes the context; fails where there is none to be had.
    static Result<std::unique_ptr<RenderThread>> start(store::CaseStore store);
    /// Drops what waits, and joins.
    ~RenderThread();
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER

    using Opened = std::function<void(Result<std::shared_ptr<const OpenCase>>)>;
    /// Sessions on one case with the same products share one renderer. It is freed when the last
    /// copy of the pointer is gone. Takes seconds for a case that nobody has open, in which no
    /// picture is drawn.
    void openCase(std::string name, Opened opened);

    /// The session has no other job here, or does not want it any more.
    void submit(PictureJob job);
    /// Exchanges the waiting job for `job`; false where it no longer waits (or never did).
    bool replace(PictureJob job);
    void withdraw(SessionId session);

private:
    struct Shared;
    struct Drawing;
    RenderThread() = default;

    std::shared_ptr<Shared> shared_;  // the queues; OpenCase's deleter refers to them too
    std::string renderer_;
    std::thread thread_;
};

}  // namespace haustra::session
