// What was asked of each view, and what has come of it.
#pragma once

#include "reader/case_info.h"
#include "reader/latency.h"
#include "reader/pacing.h"
#include "reader/session.h"

#include <array>
#include <deque>
#include <optional>

namespace haustra::reader {

/// Belongs to one thread. Viewport numbers are those of View.
class PictureLog {
public:
    struct Asked {
        std::uint64_t sequence;
        Clock::time_point at;
        ViewState state;
        glm::ivec2 paneSize;
        bool moving;
    };

    /// Another case is open: nothing is shown, nothing owed.
    void clear();
    void asked(View view, const Asked& asked);
    void take(std::deque<link::PictureDone> arrivals, Clock::time_point now);

    /// The newest picture of a view, and how many there were; nothing shown: count 0.
    const tiles::Picture& picture(View view) const { return of(view).picture; }
    std::uint64_t count(View view) const { return of(view).count; }
    /// What the newest picture of a view was asked to show; it lags behind what is asked now.
    const std::optional<ViewState>& shown(View view) const { return of(view).shown; }
    /// How large the pane was for which the newest picture was asked; 0 × 0 before there is one.
    glm::ivec2 shownPaneSize(View view) const { return of(view).shownPaneSize; }
    /// The size at which moving pictures of a view keep up, as a share of its pane's.
    double movingScale(View view) const { return of(view).detail.scale(); }

    /// From camera message to decoded picture, of the last moving endoscopic pictures, ms.
    Summary latencyMs() const { return latencies_.summary(); }
    /// Endoscopic ones that came within a second before the last take().
    std::size_t picturesPerSecond() const { return decodedAt_.size(); }

private:
    struct ViewLog {
        std::deque<Asked> asked;  // without an answer, oldest first
        std::optional<ViewState> shown;
        glm::ivec2 shownPaneSize{0};
        tiles::Picture picture;
        std::uint64_t count = 0;
        MovingDetail detail;
    };
    const ViewLog& of(View view) const { return views_[std::size_t(view)]; }

    std::array<ViewLog, viewCount> views_;
    RecentTimes latencies_{40};
    std::deque<Clock::time_point> decodedAt_;  // endoscopic ones
};

}  // namespace haustra::reader
