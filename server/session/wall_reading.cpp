#include "session/wall_reading.h"

#include "render/wall/strip_painter.h"
#include "render/wall/wall_coverage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <asio/post.hpp>

namespace haustra::session {
namespace {

constexpr int maxLooks = 16;  // of moving pictures that wait
// So near to the wall a bookmark is a place of it, wherever it looks.
constexpr double onWallMm = 2.0;

/// The place of the wall that a bookmark means: its own, or else where its gaze meets the wall.
std::optional<render::WallMark> markOf(const Wall& wall, const records::Bookmark& bookmark) {
    const WallPlace near = wall.lookup.nearest(bookmark.positionMm);
    if (glm::distance(near.positionMm, bookmark.positionMm) <= onWallMm)
        return render::WallMark{near.flat, near.positionMm};
    const auto met = wall.painter->sight().firstMet(bookmark.positionMm, bookmark.forward);
    if (!met || met->distanceMm > render::seenLimits.farthestMm) return std::nullopt;
    return render::WallMark{met->flat, met->positionMm};
}

bool nearlySame(const render::Camera& a, const render::Camera& b) {
    const double cosine = glm::dot(glm::normalize(a.forward), glm::normalize(b.forward));
    return a.lens == b.lens && a.fovDegrees == b.fovDegrees && a.heightMm == b.heightMm &&
           glm::distance(a.positionMm, b.positionMm) < sameCameraMm &&
           cosine > std::cos(glm::radians(sameCameraDegrees));
}

}  // namespace

// Its functions are called on the paint thread, one after the other.
struct WallReading::Work {
    std::shared_ptr<const OpenCase> of;
    std::optional<render::WallCoverage> coverage;
    std::vector<render::WallMark> marks;
    std::vector<render::MarkedPixel> discs;
    double discsRadiusMm = 0.0;  // 0: they have not been drawn

    render::WallCoverage& seen() {
        if (!coverage) coverage.emplace(of->wall->painter->sharedSight());
        return *coverage;
    }
    void mark(const std::vector<records::Bookmark>& bookmarks) {
        for (const records::Bookmark& bookmark : bookmarks)
            if (const auto mark = markOf(*of->wall, bookmark)) marks.push_back(*mark);
        discsRadiusMm = 0.0;
    }
    std::shared_ptr<const render::WallPaint> paint(const WallPaintChoice& choice) {
        const render::StripPainter& painter = *of->wall->painter;
        if (choice.marks && discsRadiusMm != choice.markRadiusMm) {
            discs = painter.discs(marks, choice.markRadiusMm);
            discsRadiusMm = choice.markRadiusMm;
        }
        using Marked = std::span<const render::MarkedPixel>;
        using Seen = std::span<const std::uint8_t>;
        return painter.paint(choice.marks ? Marked(discs) : Marked(),
                             choice.unseen ? Seen(seen().seenTriangles()) : Seen());
    }
};

WallReading::WallReading(asio::any_io_executor io, PaintThread& painting,
                         std::shared_ptr<const OpenCase> of, Outlet outlet)
    : io_(std::move(io)),
      painting_(painting),
      work_(std::make_shared<Work>(Work{std::move(of), {}, {}, {}, 0.0})),
      outlet_(std::move(outlet)),
      later_(io_) {}

// ---- paint --------------------------------------------------------------------------------------

void WallReading::choose(const WallPaintChoice& choice) {
    choice_ = choice;
    listed_ = !choice.marks;
    chosen_ = ++wanted_;
    ready_ = !choice.any();
    if (ready_)
        paint_ = nullptr;
    else
        repaint(true);
}

void WallReading::setBookmarks(std::vector<records::Bookmark> bookmarks) {
    if (bookmarks.size() > maxPaintedBookmarks)
        bookmarks.erase(bookmarks.begin(), bookmarks.end() - std::ptrdiff_t(maxPaintedBookmarks));
    listed_ = true;
    painting_.run([work = work_, bookmarks = std::move(bookmarks)] {
        work->marks.clear();
        work->mark(bookmarks);
    });
    if (choice_.marks) repaint(true);
}

void WallReading::addBookmark(const records::Bookmark& bookmark) {
    if (!choice_.marks || !listed_) return;  // the list will have it
    painting_.run([work = work_, bookmark] {
        work->mark({bookmark});
        if (work->marks.size() > maxPaintedBookmarks) work->marks.erase(work->marks.begin());
    });
    repaint(true);
}

void WallReading::repaint(bool soon) {
    ++wanted_;
    if (!listed_) return;
    if (isPainting_) {
        paintAgain_ = true;
        paintAgainSoon_ |= soon;
        return;
    }
    const auto due =
        soon || !paintedAt_ ? std::chrono::steady_clock::now() : *paintedAt_ + repaintAfter;
    if (due <= std::chrono::steady_clock::now()) return startPainting();
    later_.expires_at(due);
    later_.async_wait([weak = weak_from_this()](const asio::error_code& error) {
        const auto self = weak.lock();
        if (!error && self && self->choice_.any() && self->listed_ && !self->isPainting_)
            self->startPainting();
    });
}

void WallReading::startPainting() {
    later_.cancel();
    isPainting_ = true;
    paintAgain_ = paintAgainSoon_ = false;
    painting_.run(
        [weak = weak_from_this(), io = io_, work = work_, choice = choice_, number = wanted_] {
            auto paint = work->paint(choice);
            asio::post(io, [weak, number, paint = std::move(paint)]() mutable {
                if (const auto self = weak.lock()) self->painted(number, std::move(paint));
            });
        });
}

void WallReading::painted(std::uint64_t number, std::shared_ptr<const render::WallPaint> paint) {
    isPainting_ = false;
    paintedAt_ = std::chrono::steady_clock::now();
    if (number >= chosen_ && choice_.any()) {
        paint_ = std::move(paint);
        ready_ = true;
        outlet_.painted();
    }
    if (choice_.any() && paintAgain_) repaint(paintAgainSoon_);
}

// ---- what has been seen -------------------------------------------------------------------------

void WallReading::shown(const render::Camera& camera, glm::ivec2 size, bool moving) {
    if (moving && lastCamera_ && (looks_ >= maxLooks || nearlySame(camera, *lastCamera_))) return;
    lastCamera_ = camera;
    ++looks_;
    painting_.run([weak = weak_from_this(), io = io_, work = work_, camera, size] {
        const bool more = work->seen().show(camera, size) > 0;
        asio::post(io, [weak, share = work->seen().share(), more] {
            const auto self = weak.lock();
            if (!self) return;
            --self->looks_;
            self->sawMore(share, more);
        });
    });
}

void WallReading::sawMore(double share, bool more) {
    if (!more) return;
    if (std::abs(share - told_) >= toldShare || share == 1.0) {
        told_ = share;
        outlet_.seen(share);
    }
    if (choice_.unseen) repaint(false);
}

void WallReading::ask(bool forget, std::function<void(double share)> told) {
    if (forget) lastCamera_.reset();
    painting_.run([weak = weak_from_this(), io = io_, work = work_, forget,
                   told = std::move(told)]() mutable {
        if (forget) work->seen().forget();
        asio::post(io, [weak, share = work->seen().share(), forget, told = std::move(told)] {
            const auto self = weak.lock();
            if (self) self->told_ = share;
            told(share);
            if (self && forget && self->choice_.unseen) self->repaint(true);
        });
    });
}

}  // namespace haustra::session
