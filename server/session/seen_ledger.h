// What of a case's wall one reader has had on screen, in whatever sessions, and how it is kept.
#pragma once

#include "records/seen_walls.h"
#include "render/wall/review_camera.h"
#include "render/wall/wall_coverage.h"
#include "session/news.h"
#include "session/open_case.h"
#include "session/records_thread.h"
#include "session/worker.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <asio/any_io_executor.hpp>
#include <asio/steady_timer.hpp>

namespace haustra::session {

/// What has been seen goes to the disk, and is told, so often while there is more: one fsync a
/// second. After a failure it is tried again.
inline constexpr std::chrono::milliseconds ledgerEvery{1000}, ledgerAgainAfter{5000};

/// The thread that finds what pictures have shown of walls, and paints them: tasks, which must not
/// throw, one after the other.
class PaintThread : public Worker<std::function<void()>> {
public:
    PaintThread() {
        start("paint", 1, [](auto& taken) { taken.front()(); });
    }
};

/// A picture that shows the wall, and how much longer it has been on screen.
struct ShownPicture {
    ViewState shown;
    glm::ivec2 size{0};
    std::int64_t microseconds = 0;
    bool moving = false;
};

/// Patches from some area on.
struct Missed {
    double share = 0.0;  ///< of the wall that has been seen
    std::size_t count = 0;
    double areaMm2 = 0.0;
    struct Patch {
        double areaMm2 = 0.0;
        WallPlace place;
        std::optional<Camera> view;  ///< that sees most of it
    };
    std::vector<Patch> patches;  ///< the largest
};

/// What one reader has seen of a wall, for the report.
struct ReaderSeen {
    records::LedgerKey key;
    double share = 0.0;
    std::string changedUtc;  ///< empty where it is not kept
    Missed missed;
};

/// What a reader has seen, triangle by triangle.
struct SeenFlags {
    std::vector<std::uint8_t> shown, seen;  ///< as WallCoverage tells them
    double share = 0.0;
};

/// Of a case what its ledgers need: to hold it keeps nothing on the GPU, where an OpenCase would.
struct SeenWall {
    std::shared_ptr<const Wall> wall;
    Centerline centerline;
};

/// Finds the patches in flags as WallCoverage::seenTriangles gives them, at most `most`; with
/// `views`, from where each is seen. Some ten milliseconds, with views some more for each patch.
Missed missedOf(const SeenWall& of, std::span<const std::uint8_t> seen, double leastMm2, int most,
                bool views);

/// The paint thread's.
class SeenWork {
public:
    SeenWork(SeenWall of, const SeenLimits& limits) : of_(std::move(of)), limits_(limits) {}
    render::WallCoverage& coverage() {
        if (!coverage_) coverage_.emplace(of_.wall->painter->sharedSight(), limits_);
        return *coverage_;
    }
    const SeenWall& of() const { return of_; }

private:
    SeenWall of_;
    SeenLimits limits_;
    std::optional<render::WallCoverage> coverage_;
};

/// Belongs to the io thread; seeing is done on the paint thread, writing on the records thread. Of
/// a reader who is known it is kept, a second after it has been seen at the latest where the disk
/// does not tarry, and with the last session that has it; of another it lives as long as they do.
class SeenLedger : public std::enable_shared_from_this<SeenLedger> {
public:
    /// The case has a wall. With an empty reader nothing is kept.
    SeenLedger(asio::any_io_executor io, PaintThread& painting, RecordsThread& records,
               const OpenCase& of, records::LedgerKey key);
    ~SeenLedger();
    SeenLedger(const SeenLedger&) = delete;
    SeenLedger& operator=(const SeenLedger&) = delete;

    /// Reads what is kept, once, before anything else; then calls `done`. Until then somebody must
    /// hold this.
    void load(std::function<void()> done);

    const SeenLimits& limits() const { return key_.limits; }
    const records::LedgerKey& key() const { return key_; }
    /// Whether it is kept; false once that has failed for good.
    bool isRecorded() const { return recorded_; }

    /// Takes these in, in order, and returns the number of this step. Where there are more than the
    /// paint thread can look at, some moving ones are passed over, but not the newest that is at
    /// rest: what counts as seen has been.
    std::uint64_t take(std::vector<ShownPicture> pictures);

    /// What has been taken in has become another share, or is kept now.
    struct Told {
        double share;
        std::uint64_t step;  ///< up to which all is taken in and, where `recorded`, on the disk
        bool recorded;       ///< as isRecorded() tells then
        std::optional<Error> error;  ///< why it is not kept, or not yet
    };
    News<Told>& news() { return news_; }

    // Of all that was taken in before; `told` is called on the io thread. They fail (device) where
    // there is not enough memory.
    void ask(std::function<void(Result<double> share)> told);
    /// Nothing has been seen; told once that is on the disk, too. Fails (io) where it cannot be.
    void forget(std::function<void(Result<double> share)> told);
    void missed(double leastMm2, std::function<void(Result<Missed>)> told);
    void flags(std::function<void(Result<SeenFlags>)> told);
    /// What all readers whose ledgers of this wall are kept have seen of it, the newest
    /// protocol::maxReportedLedgers; where this one is not kept, it first. Fails (io) where a
    /// record is damaged. Some ten milliseconds of the paint thread's for each reader, between
    /// which others have their turn. Where the asker has gone, `told` may not be called.
    void report(double leastMm2, std::weak_ptr<const void> asker,
                std::function<void(Result<std::vector<ReaderSeen>>)> told);

    const std::shared_ptr<SeenWork>& work() const { return work_; }
    /// After a fault in what was posted here (postTo).
    void broken(const std::string& what);

private:
    template <class T>
    void onPaintThread(std::function<Result<T>(SeenWork&)> what,
                       std::function<void(Result<T>)> told);
    void found(Result<std::optional<records::Ledger>> kept);
    void loaded(Result<void> read);
    void look(ShownPicture picture);
    void took(std::uint64_t step, Result<int> added);
    void writeSoon();
    void write();
    void wrote(std::uint64_t step, Result<double> share);
    void flush();
    records::Ledger record() const;

    asio::any_io_executor io_;
    PaintThread& painting_;
    RecordsThread& records_;
    const std::string caseName_, scan_;
    const records::LedgerKey key_;
    std::shared_ptr<SeenWork> work_;
    News<Told> news_;

    bool recorded_, loaded_ = false;
    std::function<void()> loadDone_;
    std::vector<std::function<void(bool loaded)>> whenLoaded_;  // false: it never will be
    std::optional<ShownPicture> still_;               // the newest that could not be looked at yet
    int looks_ = 0;                                   // that wait for the paint thread
    std::uint64_t asked_ = 0, taken_ = 0, told_ = 0;  // steps
    bool changed_ = false;                            // since it was written
    bool writing_ = false;
    std::chrono::steady_clock::time_point nextWrite_{};
    asio::steady_timer later_;
};

/// The ledgers that sessions have now: two of one reader, with the same wall and limits, share one.
/// Belongs to the io thread.
class SeenLedgers {
public:
    SeenLedgers(asio::any_io_executor io, PaintThread& painting, RecordsThread& records)
        : io_(std::move(io)), painting_(painting), records_(records) {}
    /// Of an empty reader each is another. The case has a wall.
    std::shared_ptr<SeenLedger> of(const std::string& reader, const OpenCase& of,
                                   const SeenLimits& limits);

private:
    asio::any_io_executor io_;
    PaintThread& painting_;
    RecordsThread& records_;
    std::vector<std::weak_ptr<SeenLedger>> ledgers_;
    /// What is asked of one that its session leaves meanwhile is still answered.
    std::vector<std::shared_ptr<SeenLedger>> loading_;
};

}  // namespace haustra::session
