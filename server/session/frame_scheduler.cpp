#include "session/frame_scheduler.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::session {
namespace {

constexpr int rowStep = 16;          // bands start at whole tiles of the raycasters
constexpr int unknownRows = 32;      // of the first band where nothing has been measured
constexpr double leastUsage = 0.02;  // who used less of the GPU does not count as a sharer

double remainingMs(const Frame& frame, double msPerPixel) {
    const double perRow =
        frame.rowsDrawn > 0 ? frame.spentMs / frame.rowsDrawn : msPerPixel * double(frame.size.x);
    return perRow * (frame.size.y - frame.rowsDrawn);
}

}  // namespace

void FrameScheduler::arrive(Entry& entry) {
    if (!entry.wants()) {
        entry.usedMs = std::max(entry.usedMs, virtualMs_ - savedMs);
        entry.since = ++arrivals_;
    }
}

FrameScheduler::GivenUp FrameScheduler::add(PictureJob job) {
    Entry& entry = entries_.try_emplace(job.session).first->second;
    arrive(entry);
    GivenUp givenUp{std::exchange(entry.waiting, std::nullopt),
                    std::exchange(entry.underWay, nullptr)};
    entry.waiting.emplace(std::move(job));
    return givenUp;
}

bool FrameScheduler::worthGivingUp(const Entry& entry, const PictureJob& newer) {
    const PictureJob& older = entry.underWay ? entry.underWay->job : *entry.waiting;
    const std::size_t viewport = older.header.viewport;
    const bool same = viewport == newer.header.viewport;
    if (!same && (older.moving || !newer.moving)) return false;
    if (!entry.underWay && same) return true;
    if (entry.gaveUp[viewport]) return false;
    if (!entry.underWay) return true;
    const Frame& frame = *entry.underWay;
    const double left = remainingMs(frame, entry.details[viewport].msPerPixel());
    return left > (older.moving ? std::max(frame.spentMs, nearlyDoneMs) : nearlyDoneMs);
}

bool FrameScheduler::replace(PictureJob& job, GivenUp& givenUp) {
    const auto found = entries_.find(job.session);
    if (found == entries_.end() || !found->second.wants()) return false;
    Entry& entry = found->second;
    if (!worthGivingUp(entry, job)) return false;
    if (entry.underWay) {
        entry.gaveUp[entry.underWay->job.header.viewport] = true;
        givenUp.frame = std::exchange(entry.underWay, nullptr);
        entry.waiting.emplace(std::move(job));
        return true;
    }
    if (entry.waiting->header.viewport != job.header.viewport)
        entry.gaveUp[entry.waiting->header.viewport] = true;
    std::swap(*entry.waiting, job);
    return true;
}

FrameScheduler::GivenUp FrameScheduler::withdraw(SessionId session) {
    const auto found = entries_.find(session);
    if (found == entries_.end()) return {};
    Entry& entry = found->second;
    entry.details = {};
    entry.gaveUp = {};
    return {std::exchange(entry.waiting, std::nullopt), std::exchange(entry.underWay, nullptr)};
}

FrameScheduler::GivenUp FrameScheduler::end(SessionId session) {
    GivenUp givenUp = withdraw(session);
    entries_.erase(session);
    return givenUp;
}

bool FrameScheduler::empty() const {
    return std::none_of(entries_.begin(), entries_.end(),
                        [](const auto& entry) { return entry.second.wants(); });
}

// ---- turns --------------------------------------------------------------------------------------

std::optional<FrameScheduler::Turn> FrameScheduler::next(Clock::time_point now) {
    auto first = entries_.end();
    for (auto it = entries_.begin(); it != entries_.end(); ++it) {
        const Entry& entry = it->second;
        if (!entry.wants()) continue;
        if (first == entries_.end() || entry.usedMs < first->second.usedMs ||
            (entry.usedMs == first->second.usedMs && entry.since < first->second.since))
            first = it;
    }
    if (first == entries_.end()) return std::nullopt;
    virtualMs_ = std::max(virtualMs_, first->second.usedMs);
    const auto before = entries_.find(served_);
    if (before != entries_.end() && before->second.underWay &&
        before->second.usedMs - first->second.usedMs < turnMs)
        first = before;
    auto& [session, entry] = *first;
    served_ = session;
    if (!entry.underWay) entry.underWay = begin(session, entry, now);
    return Turn{entry.underWay, nextBand(entry, *entry.underWay)};
}

FrameScheduler::FramePointer FrameScheduler::begin(SessionId session, Entry& entry,
                                                   Clock::time_point now) {
    auto frame = std::make_shared<Frame>();
    frame->job = std::move(*entry.waiting);
    entry.waiting.reset();
    const std::size_t viewport = frame->job.header.viewport;
    PictureDetail& detail = entry.details[viewport];
    // What was measured of cheap pictures would make one band of a costly one.
    if (DrawingKind kind = kindOf(frame->job.view); kind != entry.kinds[viewport]) {
        entry.kinds[viewport] = std::move(kind);
        detail = {};
    }
    const glm::ivec2 full(frame->job.width, frame->job.height);
    frame->size = full;
    if (frame->job.coarse && frame->job.moving && canBeCoarse(frame->job.view))
        frame->size = detail.nextSize(full, shareOf(session, now));
    frame->begunAt = now;
    return frame;
}

render::Band FrameScheduler::nextBand(const Entry& entry, const Frame& frame) const {
    const int left = frame.size.y - frame.rowsDrawn;
    render::Band band{frame.size, frame.rowsDrawn, left};
    const double msPerRow =
        frame.rowsDrawn > 0
            ? frame.spentMs / frame.rowsDrawn
            : entry.details[frame.job.header.viewport].msPerPixel() * double(frame.size.x);
    const double rows = msPerRow > 0.0 ? std::min(bandMs / msPerRow, double(left)) : unknownRows;
    band.rows = std::max(1, int(rows / rowStep)) * rowStep;
    // A remainder of less than half a band is drawn with this one.
    if (left < band.rows + band.rows / 2) band.rows = left;
    return band;
}

FrameScheduler::Outcome FrameScheduler::drawn(const Turn& turn, double ms, Clock::time_point now) {
    Frame& frame = *turn.frame;
    frame.rowsDrawn += turn.band.rows;
    frame.spentMs += ms;
    const auto found = entries_.find(frame.job.session);
    if (found == entries_.end()) return Outcome::unwanted;
    Entry& entry = found->second;
    charge(entry, ms, now);
    if (entry.underWay != turn.frame) return Outcome::unwanted;
    if (frame.rowsDrawn < frame.size.y) return Outcome::goesOn;
    const std::size_t viewport = frame.job.header.viewport;
    entry.details[viewport].drawn(frame.spentMs, frame.size);
    entry.gaveUp[viewport] = false;
    entry.underWay = nullptr;
    return Outcome::finished;
}

bool FrameScheduler::failed(const Turn& turn, double ms, Clock::time_point now) {
    const auto found = entries_.find(turn.frame->job.session);
    if (found == entries_.end()) return false;
    Entry& entry = found->second;
    charge(entry, ms, now);
    if (entry.underWay != turn.frame) return false;
    entry.underWay = nullptr;
    return true;
}

// ---- shares -------------------------------------------------------------------------------------

void FrameScheduler::charge(Entry& entry, double ms, Clock::time_point now) {
    entry.usedMs += ms;
    entry.recentMs = usage(entry, now) + ms;
    entry.recentAt = now;
}

double FrameScheduler::usage(const Entry& entry, Clock::time_point now) {
    const std::chrono::duration<double> since = now - entry.recentAt, window = usageWindow;
    return entry.recentMs * std::exp(-since / window);
}

double FrameScheduler::shareOf(SessionId session, Clock::time_point now) const {
    const double windowMs = double(usageWindow.count());
    double others = 0.0;
    int sharers = 1;
    for (const auto& [id, entry] : entries_) {
        const double used = usage(entry, now) / windowMs;
        if (id == session || used < leastUsage) continue;
        others += used;
        ++sharers;
    }
    return std::clamp(1.0 - others, 1.0 / sharers, 1.0);
}

}  // namespace haustra::session
