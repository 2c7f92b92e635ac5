// The thread that owns the GPU: its EGL context and every case's renderer.
#pragma once

#include "render/prepared_case.h"
#include "session/open_case.h"
#include "session/picture_queue.h"

#include <chrono>
#include <memory>
#include <string>
#include <thread>

namespace haustra::session {

/// Its functions may be called from any thread. Those for pictures never block; callbacks come on
/// the render thread and must not throw, nor take long.
class RenderThread {
public:
    /// Makes the context; fails where there is none to be had.
    static Result<std::unique_ptr<RenderThread>> start();
    /// Drops what waits, and joins. CaseLoader has ended.
    ~RenderThread();
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER

    /// For how long a renderer is kept after the last copy of its case's pointer is gone, unless
    /// another case is uploaded meanwhile.
    static constexpr std::chrono::seconds keptAfterUse{30};
    /// The case of these products where it has a renderer, with its wall, else empty. One thread,
    /// the loader's, calls this and upload; both wait for the picture under way.
    std::shared_ptr<const OpenCase> find(const OpenCase& facts);
    /// Copies a case to the GPU: some tenths of a second, in which no picture is drawn.
    Result<std::shared_ptr<const OpenCase>> upload(OpenCase facts, render::PreparedCase prepared);

    /// The session has no other job here, or does not want it any more.
    void submit(PictureJob job);
    /// Exchanges the waiting job for `job`; false where it no longer waits (or never did).
    bool replace(PictureJob job);
    void withdraw(SessionId session);

private:
    struct Shared;
    struct Drawing;
    void runThere(std::function<void(Drawing&)> errand);
    RenderThread() = default;

    std::shared_ptr<Shared> shared_;  // the queues; OpenCase's deleter refers to them too
    std::string renderer_;
    std::thread thread_;
};

}  // namespace haustra::session
