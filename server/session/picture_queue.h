// Pictures that wait to be drawn: one a session, in turn, and always the newest.
#pragma once

#include "core/result.h"
#include "protocol/framing.h"
#include "render/view.h"
#include "session/open_case.h"

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <variant>

namespace haustra::session {

using Clock = std::chrono::steady_clock;
using SessionId = std::uint64_t;

/// One picture to draw. Immutable once queued.
struct PictureJob {
    SessionId session = 0;
    std::shared_ptr<const OpenCase> of;
    std::variant<render::CameraView, render::SliceView, render::FlatView, render::FlatOverview>
        view;
    int width = 0, height = 0;
    /// What the picture answers: viewport, codec, exact and sequence are set.
    protocol::TileHeader header;
    Clock::time_point inputAt;  ///< when its newest input arrived
    /// Called on the render thread with the job's own header, times filled in.
    std::function<void(const protocol::TileHeader&, Result<render::Image>)> done;
};

/// Holds at most one job of a session. Sessions are served in the order in which they came, so one
/// that asks without a pause gets every n-th picture of n. Not thread-safe: RenderThread guards it,
/// and a job may be its case's last user, whose end wants the same guard: so what leaves the line
/// is handed back, to be destroyed when the guard is let go.
class PictureQueue {
public:
    /// To the end of the line; hands back a job of the same session that still waited.
    [[nodiscard]] std::optional<PictureJob> add(PictureJob job);
    /// Puts `job` in the place of the waiting one of its session and viewport, and keeps that
    /// one's place in the line; `job` is then the one replaced. False, with `job` untouched, where
    /// none waits.
    bool replace(PictureJob& job);
    /// Takes out what waits of a session.
    [[nodiscard]] std::optional<PictureJob> withdraw(SessionId session);
    /// The first in the line.
    std::optional<PictureJob> take();
    bool empty() const { return jobs_.empty(); }

private:
    std::deque<PictureJob> jobs_;
};

}  // namespace haustra::session
