#include "session/wall_reading.h"

#include "protocol/limits.h"
#include "render/wall/finding_paint.h"
#include "render/wall/strip_painter.h"
#include "render/wall/wall_coverage.h"
#include "session/worker.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <asio/post.hpp>
#include <spdlog/spdlog.h>

namespace haustra::session {

// Its functions are called on the paint thread, one after the other.
struct WallReading::Work {
    std::shared_ptr<const OpenCase> of;
    std::vector<render::WallMark> marks;
    std::vector<render::MarkedPixel> discs;
    double discsRadiusMm = 0.0;  // 0: they have not been drawn

    void mark(const std::vector<Gaze>& gazes) {
        discsRadiusMm = 0.0;
        marks.clear();
        for (const Gaze& gaze : gazes)
            if (const auto mark = markOf(*of->wall, gaze.positionMm, gaze.forward))
                marks.push_back({mark->flat, mark->positionMm});
    }
    Paint paint(const WallPaintChoice& choice, const DetectionChoice& detection, SeenWork& seen) {
        const render::StripPainter& painter = *of->wall->painter;
        if (choice.marks && discsRadiusMm != choice.markRadiusMm) {
            discs = painter.discs(marks, choice.markRadiusMm);
            discsRadiusMm = choice.markRadiusMm;
        }
        std::vector<render::TintedPixel> findings;
        if (of->findings && detection.shows())
            findings = render::colorFindings(of->findings->paint, of->findings->shades(detection));
        using Marked = std::span<const render::MarkedPixel>;
        const auto seenTriangles =
            choice.unseen ? seen.coverage().seenTriangles() : std::vector<std::uint8_t>();
        return painter.paint(choice.marks ? Marked(discs) : Marked(), seenTriangles, findings);
    }
};

WallReading::WallReading(asio::any_io_executor io, PaintThread& painting,
                         std::shared_ptr<const OpenCase> of, std::shared_ptr<KeptShown> kept,
                         Outlet outlet)
    : io_(std::move(io)),
      painting_(painting),
      work_(std::make_shared<Work>(Work{std::move(of), {}, {}, 0.0})),
      outlet_(std::move(outlet)),
      kept_(std::move(kept)) {}

// ---- paint --------------------------------------------------------------------------------------

bool WallReading::paints() const {
    return choice_.any() || (work_->of->findings && detection_.shows()) ||
           work_->of->wall->painter->sight().hasBridges();
}

void WallReading::choose(const WallPaintChoice& choice) {
    choice_ = choice;
    listed_ = !choice.marks;
    chosen();
}

void WallReading::chooseFindings(const DetectionChoice& choice) {
    detection_ = choice;
    chosen();
}

void WallReading::chosen() {
    chosen_ = ++wanted_;
    ready_ = !paints();
    if (ready_)
        paint_ = nullptr;
    else
        repaint();
}

void WallReading::setBookmarks(const std::vector<records::Bookmark>& bookmarks) {
    gazes_.clear();
    const std::size_t most = protocol::maxMarkedBookmarks,
                      passedOver = bookmarks.size() - std::min(bookmarks.size(), most);
    for (const records::Bookmark& bookmark : std::span(bookmarks).subspan(passedOver))
        keep(bookmark);
    gazesAreNew_ = listed_ = true;
    if (choice_.marks) repaint();
}

void WallReading::addBookmark(const records::Bookmark& bookmark) {
    if (!choice_.marks || !listed_) return;  // the list will have it
    // A client that has lost an acknowledgement adds it again.
    if (std::any_of(gazes_.begin(), gazes_.end(),
                    [&](const Gaze& gaze) { return gaze.bookmark == bookmark.id; }))
        return;
    keep(bookmark);
    repaint();
}

void WallReading::keep(const records::Bookmark& bookmark) {
    if (gazes_.size() == protocol::maxMarkedBookmarks) gazes_.erase(gazes_.begin());
    gazes_.push_back({bookmark.id, bookmark.positionMm, bookmark.forward});
    gazesAreNew_ = true;
}

void WallReading::repaint() {
    ++wanted_;
    if (!listed_) return;
    if (isPainting_)
        paintAgain_ = true;
    else
        startPainting();
}

void WallReading::startPainting() {
    isPainting_ = true;
    paintAgain_ = false;
    std::optional<std::vector<Gaze>> gazes;
    if (choice_.marks && std::exchange(gazesAreNew_, false)) gazes = gazes_;
    painting_.push([weak = weak_from_this(), io = io_, work = work_, seen = ledger_->work(),
                    choice = choice_, detection = detection_, gazes = std::move(gazes),
                    number = wanted_] {
        auto paint = guarded([&]() -> Result<Paint> {
            if (gazes) work->mark(*gazes);
            return work->paint(choice, detection, *seen);
        });
        postTo(io, weak, [number, detection, paint = std::move(paint)](WallReading& self) mutable {
            self.painted(number, detection, std::move(paint));
        });
    });
}

void WallReading::painted(std::uint64_t number, const DetectionChoice& detection,
                          Result<Paint> paint) {
    isPainting_ = false;
    if (!paint) {
        spdlog::error("a wall cannot be painted: {}", paint.error().message);
        gazesAreNew_ = true;
        // So that its views are drawn; but never findings that the reader now is not to see.
        paint = paintedBy_ == detection ? paint_ : nullptr;
    }
    if (number >= chosen_ && paints()) {
        paint_ = std::move(*paint);
        paintedBy_ = detection;
        ready_ = true;
        outlet_.painted();
    }
    if (paints() && paintAgain_) repaint();
}

// ---- what has been seen -------------------------------------------------------------------------

void WallReading::setLedger(std::shared_ptr<SeenLedger> ledger) {
    ledger_ = std::move(ledger);
    kept_->read(*ledger_);
    // A former one lives on until it is written.
    ledger_->news().listen(weak_from_this(), [this, of = ledger_.get()](const auto& told) {
        if (of == ledger_.get()) heard(told);
    });
    if (choice_.unseen) repaint();
}

void WallReading::shown(std::vector<ShownPicture> pictures, std::uint64_t number) {
    kept_->given(ledger_, ledger_->take(std::move(pictures)), number);
}

void WallReading::heard(const SeenLedger::Told& told) {
    if (told.error) return outlet_.unkept(*told.error);
    outlet_.seen(told.share);
    if (choice_.unseen) repaint();
}

void WallReading::forget(std::function<void(Result<double>)> told) {
    ledger_->forget([weak = weak_from_this(), told = std::move(told)](Result<double> share) {
        told(std::move(share));
        const auto self = weak.lock();
        if (self && self->choice_.unseen) self->repaint();
    });
}

}  // namespace haustra::session
