// The panes of the window: how large each is, what it has asked the server for and when, and the
// pictures that have come.
#pragma once

#include "reader/pacing.h"
#include "reader/picture_log.h"
#include "reader/session.h"

#include <array>
#include <deque>
#include <functional>
#include <utility>

namespace haustra::reader {

/// Belongs to the session's thread; the session must outlive it. Viewport numbers are those of
/// View: 0 endoscopic, 1 axial, 2 coronal, 3 sagittal, 4 flattened, 5 flattened zoom, 6 oblique, 7
/// overview; 4 and 5 only where the case has been flattened.
class Panes {
public:
    explicit Panes(Session& session);

    /// The pane's size in pixels; the server draws at this size, at most 2048 a side. A pane of
    /// 0 × 0 is not in sight: nothing is asked for it. False where it has been so before.
    bool setSize(View view, glm::ivec2 pixels);
    glm::ivec2 size(View view) const { return sizes_[std::size_t(view)]; }

    /// Another case is open: everything is asked for anew.
    void clear();
    /// Asks anew, as if the view had changed: its colours have.
    void touch(View view) { pacers_[std::size_t(view)].touch(); }
    void take(std::deque<link::PictureDone> arrivals, Clock::time_point now) {
        pictures_.take(std::move(arrivals), now);
    }
    /// Asks for the views that show another thing than was asked for, or owe their still.
    void askForViews(const std::function<ViewState(View)>& stateOf, Clock::time_point now);
    /// Whether some view will be asked for later even if nothing changes any more.
    bool owe() const;
    bool owes(View view) const;

    /// The newest picture of a view, and how many there were; nothing shown: count 0.
    const tiles::Picture& picture(View view) const { return pictures_.picture(view); }
    std::uint64_t pictureCount(View view) const { return pictures_.count(view); }
    /// What the newest picture of a view shows, which lags behind what the view is asked to show
    /// now; nothing before there is one. The flat window is in pixels of
    /// that pane.
    const std::optional<ViewState>& shownState(View view) const { return pictures_.shown(view); }
    /// How large the pane was for which the newest picture was asked, which is what its state is in
    /// pixels of; before there is one, how large it is.
    glm::ivec2 shownPaneSize(View view) const {
        const glm::ivec2 shown = pictures_.shownPaneSize(view);
        return shown.x > 0 ? shown : size(view);
    }
    /// The same as a view's own state; null before there is one.
    template <class State>
    const State* shown(View view) const {
        const std::optional<ViewState>& shown = shownState(view);
        return shown ? std::get_if<State>(&*shown) : nullptr;
    }
    /// See PictureLog.
    Summary latencyMs() const { return pictures_.latencyMs(); }
    double picturesPerSecond() const { return double(pictures_.picturesPerSecond()); }

private:
    bool close(View view);
    bool inUse(View view) const;
    void open(View view, bool moving);
    ViewState toSend(View view, ViewState state, bool moving) const;

    Session& session_;
    std::array<glm::ivec2, viewCount> sizes_{}, openSizes_{};
    std::array<ViewPacer, viewCount> pacers_;
    std::array<ViewState, viewCount> asked_;  // last, of each view
    PictureLog pictures_;
};

}  // namespace haustra::reader
