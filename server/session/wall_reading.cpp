#include "session/wall_reading.h"

#include "protocol/limits.h"
#include "render/wall/finding_paint.h"
#include "render/wall/strip_painter.h"
#include "render/wall/wall_coverage.h"
#include "session/worker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <asio/post.hpp>
#include <spdlog/spdlog.h>

namespace haustra::session {
namespace {

constexpr int maxLooks = 16;  // that wait
bool nearlySame(const Camera& a, const Camera& b) {
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
    void mark(const std::vector<Gaze>& gazes) {
        discsRadiusMm = 0.0;
        marks.clear();
        for (const Gaze& gaze : gazes)
            if (const auto mark = markOf(*of->wall, gaze.positionMm, gaze.forward))
                marks.push_back({mark->flat, mark->positionMm});
    }
    Paint paint(const WallPaintChoice& choice, const DetectionChoice& detection) {
        const render::StripPainter& painter = *of->wall->painter;
        if (choice.marks && discsRadiusMm != choice.markRadiusMm) {
            discs = painter.discs(marks, choice.markRadiusMm);
            discsRadiusMm = choice.markRadiusMm;
        }
        std::vector<render::TintedPixel> findings;
        if (of->findings && detection.shows())
            findings = render::colorFindings(of->findings->paint, of->findings->shades(detection));
        using Marked = std::span<const render::MarkedPixel>;
        using Seen = std::span<const std::uint8_t>;
        return painter.paint(choice.marks ? Marked(discs) : Marked(),
                             choice.unseen ? Seen(seen().seenTriangles()) : Seen(), findings);
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
        repaint(true);
}

void WallReading::setBookmarks(const std::vector<records::Bookmark>& bookmarks) {
    gazes_.clear();
    for (const records::Bookmark& bookmark : bookmarks)
        keep(bookmark);
    gazesAreNew_ = true;
    listed_ = true;
    if (choice_.marks) repaint(true);
}

void WallReading::addBookmark(const records::Bookmark& bookmark) {
    if (!choice_.marks || !listed_) return;  // the list will have it
    // A client that has lost an acknowledgement adds it again.
    if (std::any_of(gazes_.begin(), gazes_.end(),
                    [&](const Gaze& gaze) { return gaze.bookmark == bookmark.id; }))
        return;
    keep(bookmark);
    repaint(true);
}

void WallReading::keep(const records::Bookmark& bookmark) {
    if (gazes_.size() == protocol::maxMarkedBookmarks) gazes_.erase(gazes_.begin());
    gazes_.push_back({bookmark.id, bookmark.positionMm, bookmark.forward});
    gazesAreNew_ = true;
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
        if (!error && self && self->paints() && self->listed_ && !self->isPainting_)
            self->startPainting();
    });
}

void WallReading::startPainting() {
    later_.cancel();
    isPainting_ = true;
    paintAgain_ = paintAgainSoon_ = false;
    std::optional<std::vector<Gaze>> gazes;
    if (choice_.marks && std::exchange(gazesAreNew_, false)) gazes = gazes_;
    painting_.push([weak = weak_from_this(), io = io_, work = work_, choice = choice_,
                    detection = detection_, gazes = std::move(gazes), number = wanted_] {
        auto paint = guarded([&]() -> Result<Paint> {
            if (gazes) work->mark(*gazes);
            return work->paint(choice, detection);
        });
        postTo(io, weak, [number, paint = std::move(paint)](WallReading& self) mutable {
            self.painted(number, std::move(paint));
        });
    });
}

void WallReading::painted(std::uint64_t number, Result<Paint> paint) {
    isPainting_ = false;
    paintedAt_ = std::chrono::steady_clock::now();
    if (!paint) {
        spdlog::error("a wall cannot be painted: {}", paint.error().message);
        gazesAreNew_ = true;
        paint = paint_;  // so that its views are drawn
    }
    if (number >= chosen_ && paints()) {
        paint_ = std::move(*paint);
        ready_ = true;
        outlet_.painted();
    }
    if (paints() && paintAgain_) repaint(paintAgainSoon_);
}

// ---- what has been seen -------------------------------------------------------------------------

void WallReading::shown(const Camera& camera, glm::ivec2 size, bool moving) {
    if (moving && lastCamera_ && nearlySame(camera, *lastCamera_)) return;
    if (looks_ < maxLooks)
        look(camera, size);
    else if (!moving)
        still_ = Still{camera, size};
}

void WallReading::look(const Camera& camera, glm::ivec2 size) {
    lastCamera_ = camera;
    ++looks_;
    struct Saw {
        double share;
        bool more;
    };
    painting_.push([weak = weak_from_this(), io = io_, work = work_, camera, size] {
        const auto saw = guarded([&]() -> Result<Saw> {
            render::WallCoverage& seen = work->seen();
            const bool more = seen.show(camera, size) > 0;
            return Saw{seen.share(), more};
        });
        postTo(io, weak, [saw](WallReading& self) {
            --self.looks_;
            if (saw)
                self.sawMore(saw->share, saw->more);
            else
                spdlog::error("a wall cannot be looked at: {}", saw.error().message);
            self.lookAtStill();
        });
    });
}

void WallReading::lookAtStill() {
    if (const auto still = std::exchange(still_, std::nullopt)) look(still->camera, still->size);
}

void WallReading::sawMore(double share, bool more) {
    if (!more) return;
    if (std::abs(share - told_) >= toldShare || share == 1.0) {
        told_ = share;
        outlet_.seen(share);
    }
    if (choice_.unseen) repaint(false);
}

void WallReading::ask(bool forget, std::function<void(Result<double> share)> told) {
    if (forget) {
        lastCamera_.reset();
        still_.reset();
    }
    lookAtStill();
    painting_.push([weak = weak_from_this(), io = io_, work = work_, forget,
                    told = std::move(told)]() mutable {
        const auto share = guarded([&]() -> Result<double> {
            if (forget) work->seen().forget();
            return work->seen().share();
        });
        asio::post(io, [weak, share, forget, told = std::move(told)] {
            const auto self = weak.lock();
            if (self && share) self->told_ = *share;
            told(share);
            if (self && forget && self->choice_.unseen) self->repaint(true);
        });
    });
}

}  // namespace haustra::session
