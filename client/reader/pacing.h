// When to ask the server for a view, and at what size: pure rules over given times.
#pragma once

#include <chrono>

namespace haustra::reader {

/// While a view changes it is asked for as moving, at most once an interval; when it has rested a
/// while, once as the exact still.
class ViewPacer {
public:
    using Time = std::chrono::steady_clock::time_point;
    enum class Ask { nothing, moving, still };

    ViewPacer(std::chrono::milliseconds interval, std::chrono::milliseconds restAfter)
        : interval_(interval), restAfter_(restAfter) {}

    /// Call at every step of the loop; `changed` since the last call.
    Ask next(bool changed, Time now);
    /// Ask anew, as if the view had changed (another window level, a resized pane).
    void touch() { touched_ = true; }
    /// Whether a later call will ask, even if nothing changes any more.
    bool owes() const { return dirty_ || touched_ || !stillAsked_; }

private:
    std::chrono::milliseconds interval_, restAfter_;
    Time changedAt_{}, askedAt_{};
    bool dirty_ = false, touched_ = false, stillAsked_ = true;
};

/// The size of moving pictures, as a share of the pane's size: small enough that a slow server
/// stays fluid, and full where it can be. Stills are always full.
class MovingDetail {
public:
    static constexpr double slowMs = 90.0, fastMs = 40.0;
    static constexpr int picturesPerStep = 6;

    double scale() const;
    /// Takes in the latency of one moving picture; true where the scale changed. Steps down when
    /// pictures are slow, up when they are fast; never on one slow picture alone.
    bool add(double latencyMs);

private:
    int step_ = 0, slow_ = 0, fast_ = 0;
};

}  // namespace haustra::reader
