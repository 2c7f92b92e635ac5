// The thread that owns the GPU: its EGL context and every case's renderer.
#pragma once

#include "render/scene/prepared_case.h"
#include "session/frame_scheduler.h"
#include "session/gpu_cases.h"
#include "session/open_case.h"

#include <memory>
#include <string>
#include <thread>

namespace haustra::session {

/// Its functions may be called from any thread. Those for pictures never block; callbacks come on
/// the render thread and must not throw, nor take long.
class RenderThread {
public:
    /// Called on the render thread for each picture of a case whose files turn out not to be whole
    /// any more; it can be opened anew.
    using Lost = std::function<void(std::shared_ptr<const OpenCase>)>;
    /// Makes the context; fails where there is none to be had.
    static Result<std::unique_ptr<RenderThread>> start(DrawingOptions options, Lost lost);
    /// Drops what waits, and joins. CaseLoader has ended.
    ~RenderThread();
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER

    /// The case of these products where it has a renderer, with its wall, else empty. One thread,
    /// the loader's, calls this and upload; both wait for the band under way.
    std::shared_ptr<const OpenCase> find(const OpenCase& facts);
    /// Copies a case to the GPU: some tenths of a second, in which no picture is drawn. Then finds
    /// the raycaster that draws it fastest, picture by picture in turn with those of the sessions.
    Result<std::shared_ptr<const OpenCase>> upload(OpenCase facts, render::PreparedCase prepared);

    /// The session has no other job here, or does not want it any more.
    void submit(PictureJob job);
    /// Lets `job` overtake the session's job by FrameScheduler's rules; false where it may not, or
    /// there is none. The overtaken job's `done` is not called.
    bool replace(PictureJob job);
    /// The session's job is not wanted any more; its `done` is not called unless it is already
    /// under way to it.
    void withdraw(SessionId session);
    /// And nothing else will come from it.
    void end(SessionId session);

private:
    struct Shared;
    struct Drawing;
    void runThere(std::function<void(Drawing&)> errand);
    RenderThread() = default;

    std::shared_ptr<Shared> shared_;  // the queues
    std::string renderer_;
    std::thread thread_;
};

}  // namespace haustra::session
