// Who draws next on the GPU, and how much: the turns of sessions, by measured milliseconds. Pure
// logic over given times and costs; no GL, no clock of its own.
#pragma once

#include "session/picture_detail.h"
#include "session/picture_job.h"

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>

namespace haustra::session {

/// A band of a picture shall take so long: what may change the order waits no longer than that.
inline constexpr double bandMs = 8.0;
/// A session goes on with its picture until it is so far ahead of the one that had the least.
inline constexpr double turnMs = 30.0;
/// What a session that had nothing to draw may make up for afterwards.
inline constexpr double savedMs = 2 * turnMs;
/// A picture that is done within this is never given up for a newer one.
inline constexpr double nearlyDoneMs = 2 * bandMs;
/// How far back the use of the GPU is looked at, to know what share of it a session gets.
inline constexpr std::chrono::milliseconds usageWindow{500};

/// A picture under way. The render thread draws into it; nobody else looks at its pixels.
struct Frame {
    PictureJob job;
    glm::ivec2 size{0};  ///< smaller than the job's where it is drawn coarse
    Image picture;
    int rowsDrawn = 0;
    double spentMs = 0.0;
    Clock::time_point begunAt;
};

/// At most one picture of a session waits, and at most one is under way.
///
/// *Turns.* Each session has a virtual time, the milliseconds of the GPU that it has used. The
/// session with the least goes first, whatever its pictures cost (start-time fair queueing, Goyal
/// et al. 1996). One that had nothing to draw starts again at most savedMs below the least of the
/// others: the pause between a picture and the next input costs it nothing, and nobody saves up
/// more. To let pictures show the newest input, they are drawn one after the other as far as
/// fairness allows: a session keeps the GPU for up to turnMs.
///
/// *Newer inputs.* A waiting picture is exchanged for a newer one of its viewport in place. One
/// under way is given up for it if more is still to be drawn than has been, and more than
/// nearlyDoneMs; a still, if more than nearlyDoneMs is left. Then the next picture of that
/// viewport is drawn to its end: there are pictures however fast inputs come. A moving picture
/// overtakes a still of another viewport by the same rules.
///
/// Not thread-safe: RenderThread guards it. A job may be its case's last user, whose end wants the
/// same guard: so what is given up is handed back, to be destroyed when the guard is let go.
class FrameScheduler {
public:
    using FramePointer = std::shared_ptr<Frame>;
    struct GivenUp {
        std::optional<PictureJob> job;
        FramePointer frame;
    };

    /// The session has nothing else here.
    [[nodiscard]] GivenUp add(PictureJob job);
    /// Lets `job` overtake the session's picture that waits or is under way, by the rules above;
    /// `job` is then what waited, or has been moved from. False, with `job` untouched, where it
    /// may not, or there is none: then that picture will be finished, or has been.
    bool replace(PictureJob& job, GivenUp& givenUp);
    /// Takes out what the session has here.
    [[nodiscard]] GivenUp withdraw(SessionId session);
    /// Forgets the session, from which nothing will come any more.
    [[nodiscard]] GivenUp end(SessionId session);
    bool empty() const;

    /// What to draw now. The frame is the caller's to draw into until it calls drawn().
    struct Turn {
        FramePointer frame;
        render::Band band;
    };
    std::optional<Turn> next(Clock::time_point now);
    enum class Outcome { goesOn, finished, unwanted };
    /// The turn has taken `ms`. Finished: the frame is the caller's, and the session has none any
    /// more. Unwanted: it was given up meanwhile.
    Outcome drawn(const Turn& turn, double ms, Clock::time_point now);
    /// The frame cannot be drawn, which took `ms` to find out: as if it were finished. False where
    /// it was given up meanwhile.
    bool failed(const Turn& turn, double ms, Clock::time_point now);

    /// What share of the GPU the session can count on: what the others have left of it lately, and
    /// never less than its fair share.
    double shareOf(SessionId session, Clock::time_point now) const;

private:
    struct Entry {
        std::optional<PictureJob> waiting;
        FramePointer underWay;
        double usedMs = 0.0;         // virtual time
        std::uint64_t since = 0;     // order of arrival, to settle ties
        double recentMs = 0.0;       // used, fading with usageWindow
        Clock::time_point recentAt;  // when recentMs was true
        std::array<PictureDetail, protocol::maxViewports> details;
        std::array<DrawingKind, protocol::maxViewports> kinds;  // that details are of
        std::array<bool, protocol::maxViewports> gaveUp{};      // since its last finished picture
        bool wants() const { return waiting || underWay; }
    };

    static bool worthGivingUp(const Entry& entry, const PictureJob& newer);
    static double usage(const Entry& entry, Clock::time_point now);
    void arrive(Entry& entry);
    static void charge(Entry& entry, double ms, Clock::time_point now);
    FramePointer begin(SessionId session, Entry& entry, Clock::time_point now);
    render::Band nextBand(const Entry& entry, const Frame& frame) const;

    std::map<SessionId, Entry> entries_;
    SessionId served_ = 0;    // last
    double virtualMs_ = 0.0;  // the least of those who wanted something; never falls
    std::uint64_t arrivals_ = 0;
};

}  // namespace haustra::session
