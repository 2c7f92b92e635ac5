// What one session has been shown of a case's wall, and what its pictures colour the wall with.
#pragma once

#include "core/result.h"
#include "records/bookmarks.h"
#include "render/scene/picture.h"
#include "session/open_case.h"
#include "session/worker.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <asio/any_io_executor.hpp>
#include <asio/steady_timer.hpp>

namespace haustra::session {

/// A place stays painted for so long after it has been shown: long enough to be noticed as one that
/// had been missed.
inline constexpr std::chrono::milliseconds repaintAfter{1000};
/// The share of the wall that has been seen is told when it has changed by this.
inline constexpr double toldShare = 0.005;
/// While the hand moves, a camera that has moved and turned by less shows nothing new.
inline constexpr double sameCameraMm = 1.0, sameCameraDegrees = 2.0;

/// The thread that finds what pictures have shown of walls, and paints them: tasks, which must not
/// throw, one after the other. WallReading bounds how many of a session's wait here.
class PaintThread : public Worker<std::function<void()>> {
public:
    PaintThread() {
        start("paint", 1, [](auto& taken) { taken.front()(); });
    }
};

/// Belongs to the io thread; seeing and painting are done on the paint thread. The wall that has
/// been seen is kept whether or not it is painted, so that whoever turns the paint on learns of all
/// of the session.
class WallReading : public std::enable_shared_from_this<WallReading> {
public:
    struct Outlet {
        std::function<void()> painted;                        ///< paint() is another
        std::function<void(double share)> seen;               ///< of the wall's area, 0…1
        std::function<void(const std::string& what)> broken;  ///< nothing else will come
    };
    /// The case has a wall.
    WallReading(asio::any_io_executor io, PaintThread& painting, std::shared_ptr<const OpenCase> of,
                Outlet outlet);

    /// From now on paint() is to be this; until it is made, ready() is false. With marks,
    /// setBookmarks has to follow.
    /// Bridges are hatched whatever the choice; a session chooses once to have them so.
    void choose(const WallPaintChoice& choice);
    const WallPaintChoice& choice() const { return choice_; }
    /// Which of the case's findings are painted, whatever else is; likewise.
    void chooseFindings(const DetectionChoice& choice);
    const DetectionChoice& detection() const { return detection_; }
    /// All bookmarks of the case, and one more, or one that is known already.
    void setBookmarks(const std::vector<records::Bookmark>& bookmarks);
    void addBookmark(const records::Bookmark& bookmark);

    bool ready() const { return ready_; }
    /// Null where nothing is painted.
    const std::shared_ptr<const render::WallPaint>& paint() const { return paint_; }

    /// An endoscopic picture of `size` pixels has been drawn for the client. Where there are more
    /// than the paint thread can look at, some are passed over, but not the newest that is at rest:
    /// what is told as seen has been.
    void shown(const Camera& camera, glm::ivec2 size, bool moving);
    /// `told` is called on the io thread with the share that pictures drawn before this have shown;
    /// with `forget`, nothing has been. Fails (device) where there is not enough memory.
    void ask(bool forget, std::function<void(Result<double> share)> told);

    /// After a fault in what was posted here (postTo).
    void broken(const std::string& what) { outlet_.broken(what); }

private:
    struct Work;
    /// A bookmark, as far as it is painted.
    struct Gaze {
        std::uint64_t bookmark;
        glm::dvec3 positionMm, forward;
    };
    using Paint = std::shared_ptr<const render::WallPaint>;
    bool paints() const;
    void chosen();
    void keep(const records::Bookmark& bookmark);
    void repaint(bool soon);
    void startPainting();
    void painted(std::uint64_t number, Result<Paint> paint);
    void look(const Camera& camera, glm::ivec2 size);
    void lookAtStill();
    void sawMore(double share, bool more);

    asio::any_io_executor io_;
    PaintThread& painting_;
    std::shared_ptr<Work> work_;  // the paint thread's, but for its making and its end
    Outlet outlet_;

    WallPaintChoice choice_;
    DetectionChoice detection_;
    bool listed_ = false;  // the bookmarks of this choice are known
    std::vector<Gaze> gazes_;
    bool gazesAreNew_ = false;  // to work_
    bool ready_ = true;
    Paint paint_;
    std::uint64_t wanted_ = 0;  // counts what changed the paint; the newest is to be shown
    std::uint64_t chosen_ = 0;  // its number when the newest choice was made
    bool isPainting_ = false, paintAgain_ = false, paintAgainSoon_ = false;
    std::optional<std::chrono::steady_clock::time_point> paintedAt_;
    asio::steady_timer later_;

    struct Still {
        Camera camera;
        glm::ivec2 size;
    };
    std::optional<Camera> lastCamera_;
    std::optional<Still> still_;  // the newest that could not be looked at yet
    int looks_ = 0;               // that wait for the paint thread
    double told_ = 0.0;
};

}  // namespace haustra::session
