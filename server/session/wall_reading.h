// What one session's pictures colour the wall of a case with, and what they tell its reader's
// ledger.
#pragma once

#include "core/result.h"
#include "records/bookmarks.h"
#include "render/scene/picture.h"
#include "session/kept_shown.h"
#include "session/open_case.h"
#include "session/seen_ledger.h"
#include "session/worker.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <asio/any_io_executor.hpp>

namespace haustra::session {

/// Belongs to the io thread; seeing and painting are done on the paint thread. What has been seen
/// goes to the ledger whether or not it is painted, so that whoever turns the paint on learns of
/// all of it.
class WallReading : public std::enable_shared_from_this<WallReading> {
public:
    struct Outlet {
        std::function<void()> painted;  ///< paint() is another
        /// Of the wall's area, 0…1. What is kept of it KeptShown knows by then.
        std::function<void(double share)> seen;
        std::function<void(const Error& error)> unkept;       ///< why it is not kept
        std::function<void(const std::string& what)> broken;  ///< nothing else will come
    };
    /// The case has a wall.
    WallReading(asio::any_io_executor io, PaintThread& painting, std::shared_ptr<const OpenCase> of,
                std::shared_ptr<KeptShown> kept, Outlet outlet);
    /// Before anything else, and whenever the reader has chosen other limits.
    void setLedger(std::shared_ptr<SeenLedger> ledger);
    SeenLedger& ledger() { return *ledger_; }

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

    /// Pictures have been on the reader's screen; `number`: of the TellShown that said so, which
    /// grows.
    void shown(std::vector<ShownPicture> pictures, std::uint64_t number);
    /// Nothing has been seen: `told` as of SeenLedger::forget.
    void forget(std::function<void(Result<double> share)> told);

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
    void repaint();
    void startPainting();
    void painted(std::uint64_t number, const DetectionChoice& detection, Result<Paint> paint);
    void heard(const SeenLedger::Told& told);

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
    DetectionChoice paintedBy_;  ///< what paint_ shows of findings
    std::uint64_t wanted_ = 0;   // counts what changed the paint; the newest is to be shown
    std::uint64_t chosen_ = 0;   // its number when the newest choice was made
    bool isPainting_ = false, paintAgain_ = false;

    std::shared_ptr<SeenLedger> ledger_;
    std::shared_ptr<KeptShown> kept_;
};

}  // namespace haustra::session
