// The turns of sessions on the GPU, by a clock that only this test moves.
#include "session/frame_scheduler.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace haustra::session {
namespace {

using Ms = std::chrono::duration<double, std::milli>;
using Outcome = FrameScheduler::Outcome;

PictureJob someJob(SessionId session, std::uint64_t sequence, int side = 256,
                   std::uint8_t viewport = 0, bool moving = true) {
    PictureJob job;
    job.session = session;
    job.view = render::CameraView{};
    job.width = job.height = side;
    job.moving = moving;
    job.header.viewport = viewport;
    job.header.exact = !moving;
    job.header.sequence = sequence;
    return job;
}

/// A GPU that draws a row in a known time, and sessions that ask anew `pauseMs` after each picture.
class Simulation {
public:
    struct Reader {
        double msPerPicture = 10.0;  // at full size
        double pauseMs = 5.0;
        bool coarse = false;
        // ---- what came of it
        double usedMs = 0.0;
        std::vector<double> finishedAtMs{};
        std::vector<glm::ivec2> sizes{};
        double longestGapMs(std::size_t from) const {
            double longest = 0.0;
            for (std::size_t n = from + 1; n < finishedAtMs.size(); ++n)
                longest = std::max(longest, finishedAtMs[n] - finishedAtMs[n - 1]);
            return longest;
        }
    };
    std::map<SessionId, Reader> readers;
    static constexpr int side = 256;

    void run(double ms) {
        const double until = nowMs_ + ms;
        for (auto& [id, reader] : readers)
            asksAtMs_.try_emplace(id, nowMs_);
        while (nowMs_ < until) {
            for (auto& [id, at] : asksAtMs_)
                if (at <= nowMs_) ask(id);
            const auto turn = scheduler_.next(now());
            if (!turn) {
                nowMs_ += 0.5;
                continue;
            }
            const SessionId id = turn->frame->job.session;
            Reader& reader = readers.at(id);
            const double share = double(turn->band.rows) * turn->frame->size.x / (side * side);
            const double took = share * reader.msPerPicture;
            nowMs_ += took;
            reader.usedMs += took;
            if (scheduler_.drawn(*turn, took, now()) != Outcome::finished) continue;
            reader.finishedAtMs.push_back(nowMs_);
            reader.sizes.push_back(turn->frame->size);
            asksAtMs_[id] = nowMs_ + reader.pauseMs;
        }
    }

private:
    Clock::time_point now() const {
        return Clock::time_point{} + std::chrono::hours(1) +
               std::chrono::duration_cast<Clock::duration>(Ms(nowMs_));
    }
    void ask(SessionId id) {
        asksAtMs_[id] = INFINITY;
        PictureJob job = someJob(id, ++sequence_, side);
        job.coarse = readers.at(id).coarse;
        (void)scheduler_.add(std::move(job));
    }

    FrameScheduler scheduler_;
    std::map<SessionId, double> asksAtMs_;
    double nowMs_ = 0.0;
    std::uint64_t sequence_ = 0;
};

double meanOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

TEST(FrameScheduler, EightEqualSessionsGetTheSameRate) {
    Simulation simulation;
    for (SessionId id = 1; id <= 8; ++id)
        simulation.readers[id] = {};
    simulation.run(20'000.0);
    std::vector<double> counts;
    for (const auto& [id, reader] : simulation.readers)
        counts.push_back(double(reader.finishedAtMs.size()));
    for (const double count : counts)
        EXPECT_NEAR(count, meanOf(counts), 0.02 * meanOf(counts));
    EXPECT_NEAR(meanOf(counts), 20'000.0 / 80.0, 5.0);  // and nothing of the GPU is lost
}

TEST(FrameScheduler, ACostlyViewTakesItsFairShareAndNoMore) {
    Simulation simulation;
    for (SessionId id = 1; id <= 8; ++id)
        simulation.readers[id] = {};
    simulation.readers[5].msPerPicture = 100.0;
    simulation.run(40'000.0);
    for (const auto& [id, reader] : simulation.readers) {
        EXPECT_NEAR(reader.usedMs, 40'000.0 / 8.0, 0.03 * 5000.0) << id;
        if (id == 5) continue;
        EXPECT_NEAR(double(reader.finishedAtMs.size()), 500.0, 15.0) << id;
    }
}

TEST(FrameScheduler, SharesConvergeWhateverTheCosts) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 20; ++trial) {
        Simulation simulation;
        const SessionId count = 2 + random() % 7;
        for (SessionId id = 1; id <= count; ++id)
            simulation.readers[id] = {2.0 + double(random() % 200), 0.0};
        simulation.run(60'000.0);
        for (const auto& [id, reader] : simulation.readers)
            EXPECT_NEAR(reader.usedMs, 60'000.0 / double(count), turnMs + 2 * bandMs)
                << "trial " << trial;
    }
}

TEST(FrameScheduler, WhoAsksForLittleWaitsForATurnAtMost) {
    Simulation simulation;
    simulation.readers[1] = {2.0, 100.0};  // a slice now and then
    for (SessionId id = 2; id <= 4; ++id)
        simulation.readers[id] = {400.0, 0.0};
    simulation.run(20'000.0);
    // Until the costs are known bands may be long.
    EXPECT_LE(simulation.readers[1].longestGapMs(20), 100.0 + 2.0 + turnMs + 2 * bandMs + 1.0);
}

TEST(FrameScheduler, WhoWasAwaySavesHardlyAnythingUp) {
    Simulation simulation;
    simulation.readers[1] = {10.0, 0.0};
    simulation.run(10'000.0);
    simulation.readers[2] = {10.0, 0.0};
    const double before = simulation.readers[1].usedMs;
    simulation.run(1'000.0);
    EXPECT_NEAR(simulation.readers[1].usedMs - before, 500.0, savedMs / 2 + turnMs + 2 * bandMs);
    EXPECT_NEAR(simulation.readers[2].usedMs, 500.0, savedMs / 2 + turnMs + 2 * bandMs);
}

TEST(FrameScheduler, MovingPicturesAreCoarseWhereFullOnesWouldBeLate) {
    Simulation simulation;
    simulation.readers[1] = {180.0, 5.0, true};
    simulation.readers[2] = {20.0, 500.0, true};
    simulation.run(5'000.0);
    const auto& costly = simulation.readers[1];
    EXPECT_EQ(costly.sizes.front(), glm::ivec2(Simulation::side));  // nothing was known of it
    EXPECT_EQ(costly.sizes.back(), glm::ivec2(Simulation::side / 2));
    const auto& times = costly.finishedAtMs;
    for (std::size_t n = 2; n < times.size(); ++n)
        EXPECT_LE(times[n] - times[n - 1], movingPictureMs + 5.0 + 20.0 + 1.0) << n;
    for (const glm::ivec2 size : simulation.readers[2].sizes)
        EXPECT_EQ(size, glm::ivec2(Simulation::side));
}

TEST(FrameScheduler, TogetherPicturesGetCoarserUntilAllAreInTime) {
    Simulation simulation;
    for (SessionId id = 1; id <= 8; ++id)
        simulation.readers[id] = {24.0, 5.0, true};
    simulation.run(10'000.0);
    for (auto& [id, reader] : simulation.readers) {
        EXPECT_EQ(reader.sizes.back(), glm::ivec2(Simulation::side / 2)) << id;
        const auto& times = reader.finishedAtMs;
        ASSERT_GT(times.size(), 100u);
        for (std::size_t n = times.size() / 2; n < times.size(); ++n)
            EXPECT_LE(times[n] - times[n - 1], 2 * movingPictureMs) << id;
    }
}

// ---- one picture at a time ----------------------------------------------------------------------

class OneSession : public ::testing::Test {
protected:
    static constexpr double rowMs = 0.25;  // 64 ms for a picture of 256 rows

    void SetUp() override {
        add(someJob(1, 1));  // makes the costs known
        EXPECT_EQ(finish(), 1u);
    }
    void add(PictureJob job) {
        const auto givenUp = scheduler_.add(std::move(job));
        EXPECT_FALSE(givenUp.job);
        EXPECT_FALSE(givenUp.frame);
    }
    Outcome band() {
        const auto turn = scheduler_.next(now_);
        EXPECT_TRUE(turn);
        if (!turn) return Outcome::unwanted;
        sequence_ = turn->frame->job.header.sequence;
        EXPECT_EQ(turn->band.firstRow, turn->frame->rowsDrawn);
        EXPECT_LE(turn->band.rows * rowMs, 1.6 * bandMs);
        return scheduler_.drawn(*turn, turn->band.rows * rowMs, now_);
    }
    /// Draws on until a picture is finished: its sequence; 0 where nothing is to be drawn.
    std::uint64_t finish() {
        while (!scheduler_.empty())
            if (band() == Outcome::finished) return sequence_;
        return 0;
    }
    void drawFor(double ms) {
        for (double spent = 0.0; spent < ms; spent += bandMs)
            EXPECT_EQ(band(), Outcome::goesOn);
    }
    bool replace(std::uint64_t sequence, std::uint8_t viewport = 0, bool moving = true) {
        PictureJob job = someJob(1, sequence, 256, viewport, moving);
        FrameScheduler::GivenUp givenUp;
        return scheduler_.replace(job, givenUp);
    }

    FrameScheduler scheduler_;
    Clock::time_point now_{};
    std::uint64_t sequence_ = 0;
};

TEST_F(OneSession, TheNewestWaitingPictureIsDrawn) {
    add(someJob(1, 2));
    for (std::uint64_t sequence = 3; sequence < 50; ++sequence)
        EXPECT_TRUE(replace(sequence));
    EXPECT_EQ(finish(), 49u);
    EXPECT_TRUE(scheduler_.empty());
}

TEST_F(OneSession, APictureBarelyBegunGivesWayToANewerOne) {
    add(someJob(1, 2));
    drawFor(bandMs);
    EXPECT_TRUE(replace(3));
    EXPECT_EQ(finish(), 3u);
    EXPECT_EQ(finish(), 0u);
}

TEST_F(OneSession, APictureMoreThanHalfDoneIsFinished) {
    add(someJob(1, 2));
    drawFor(40.0);
    EXPECT_FALSE(replace(3));
    EXPECT_EQ(finish(), 2u);
}

TEST_F(OneSession, AStillGivesWayUnlessItIsNearlyDone) {
    add(someJob(1, 2, 256, 0, false));
    drawFor(40.0);
    EXPECT_TRUE(replace(3));
    EXPECT_EQ(finish(), 3u);
    add(someJob(1, 4, 256, 0, false));
    drawFor(56.0 - bandMs);
    EXPECT_FALSE(replace(5));
    EXPECT_EQ(finish(), 4u);
}

TEST_F(OneSession, InputsFasterThanPicturesStarveNobody) {
    std::uint64_t sequence = 2;
    std::vector<std::uint64_t> finished;
    add(someJob(1, sequence));
    for (int bands = 0; bands < 400; ++bands) {
        if (band() == Outcome::finished) {
            finished.push_back(sequence_);
            add(someJob(1, ++sequence));
        }
        replace(++sequence);
        if (scheduler_.empty()) add(someJob(1, ++sequence));
    }
    // 3200 ms of 64 ms each, of which no more than half of one is thrown away before each.
    EXPECT_GE(finished.size(), std::size_t(400 * bandMs / (1.5 * 64.0)) - 1);
    EXPECT_TRUE(std::is_sorted(finished.begin(), finished.end()));
}

TEST_F(OneSession, AMovingViewportDoesNotWaitForAnothersStillTwice) {
    add(someJob(1, 2, 256, 5, false));
    EXPECT_TRUE(replace(3, 0)) << "a still that only waits";
    EXPECT_EQ(finish(), 3u);
    add(someJob(1, 2, 256, 5, false));
    drawFor(bandMs);
    EXPECT_FALSE(replace(4, 0)) << "the still has given way once";
    EXPECT_EQ(finish(), 2u);
    add(someJob(1, 5, 256, 5, false));
    EXPECT_TRUE(replace(6, 0)) << "it has been finished meanwhile";
}

TEST_F(OneSession, AMovingPictureIsNotOvertakenByAnotherViewport) {
    add(someJob(1, 2, 256, 5, true));
    EXPECT_FALSE(replace(3, 0));
    add(someJob(2, 2));
    EXPECT_FALSE(replace(3, 1, false));
}

TEST_F(OneSession, WhatIsGivenUpWhileItIsDrawnIsUnwanted) {
    add(someJob(1, 2));
    const auto turn = scheduler_.next(now_);
    ASSERT_TRUE(turn);
    ASSERT_TRUE(replace(3));
    EXPECT_EQ(scheduler_.drawn(*turn, 1.0, now_), Outcome::unwanted);
    EXPECT_EQ(finish(), 3u);

    add(someJob(1, 4));
    const auto other = scheduler_.next(now_);
    EXPECT_EQ(scheduler_.withdraw(1).frame, other->frame);
    EXPECT_EQ(scheduler_.drawn(*other, 1.0, now_), Outcome::unwanted);
    EXPECT_TRUE(scheduler_.empty());
    EXPECT_FALSE(replace(5)) << "nothing is here to be overtaken";

    add(someJob(1, 6));
    const auto last = scheduler_.next(now_);
    EXPECT_TRUE(scheduler_.end(1).frame);
    EXPECT_FALSE(scheduler_.failed(*last, 1.0, now_));
    EXPECT_TRUE(scheduler_.empty());
}

TEST_F(OneSession, WhatFailsIsPaidForToo) {
    // Another session's picture fails each time, after as long as a band; it asks again at once.
    double ofFailing = 0.0, ofOther = 0.0;
    add(someJob(1, 2));
    add(someJob(2, 3));
    for (int turns = 0; turns < 500; ++turns) {
        const auto turn = scheduler_.next(now_);
        ASSERT_TRUE(turn);
        if (turn->frame->job.session == 2) {
            ofFailing += bandMs;
            ASSERT_TRUE(scheduler_.failed(*turn, bandMs, now_));
            add(someJob(2, 3));
        } else {
            const double ms = turn->band.rows * rowMs;
            ofOther += ms;
            if (scheduler_.drawn(*turn, ms, now_) == Outcome::finished) add(someJob(1, 2));
        }
    }
    EXPECT_NEAR(ofFailing, ofOther, savedMs + turnMs);
    EXPECT_NEAR(scheduler_.shareOf(1, now_), 0.5, 1e-9) << "and counts as a use of the GPU";
}

TEST_F(OneSession, BandsCoverThePictureOnce) {
    for (const int side : {16, 17, 100, 250, 512, 2048}) {
        PictureJob job = someJob(1, 9, side);
        job.height = side / 2 + 9;
        add(std::move(job));
        for (int row = 0;;) {
            const auto turn = scheduler_.next(now_);
            ASSERT_TRUE(turn);
            ASSERT_EQ(turn->band.firstRow, row);
            ASSERT_GT(turn->band.rows, 0);
            row += turn->band.rows;
            ASSERT_LE(row, turn->frame->size.y);
            const bool last = row == turn->frame->size.y;
            ASSERT_EQ(scheduler_.drawn(*turn, turn->band.rows * rowMs, now_) == Outcome::finished,
                      last);
            if (last) break;
        }
    }
}

TEST_F(OneSession, CheapPicturesSayNothingOfACostlyKind) {
    constexpr double cheapRowMs = 1e-3;
    const auto slice = [](std::uint64_t sequence, double slabMm) {
        PictureJob job = someJob(1, sequence, 256, 3);
        job.view = SliceView{.slab = {.thicknessMm = slabMm}};
        return job;
    };
    const auto drawCheap = [&](PictureJob job) {
        add(std::move(job));
        int bands = 0;
        for (auto outcome = Outcome::goesOn; outcome == Outcome::goesOn; ++bands) {
            const auto turn = scheduler_.next(now_);
            outcome = scheduler_.drawn(*turn, turn->band.rows * cheapRowMs, now_);
        }
        return bands;
    };
    for (std::uint64_t sequence = 2; sequence < 5; ++sequence)
        drawCheap(slice(sequence, 0.0));
    EXPECT_EQ(drawCheap(slice(5, 0.0)), 1) << "all of them cost the same";
    // Each band is no longer than band() bears, of those that follow, too.
    for (std::uint64_t sequence = 6; sequence < 9; ++sequence) {
        add(slice(sequence, 100.0));
        EXPECT_EQ(finish(), sequence);
    }
    EXPECT_EQ(drawCheap(slice(9, 0.0)), 2);
    add(slice(10, 50.0));
    EXPECT_EQ(finish(), 10u) << "another slab";
    add(someJob(1, 11, 256, 3));
    EXPECT_EQ(finish(), 11u);
}

template <std::size_t... kind>
std::vector<AnyView> oneOfEach(std::index_sequence<kind...>) {
    return {AnyView(std::in_place_index<kind>)...};
}

TEST_F(OneSession, AllViewsAreDrawnInBands) {
    for (const AnyView& view :
         oneOfEach(std::make_index_sequence<std::variant_size_v<AnyView>>())) {
        PictureJob job = someJob(1, 2);
        job.view = view;
        add(std::move(job));
        EXPECT_EQ(band(), Outcome::goesOn);
        EXPECT_EQ(finish(), 2u);
    }
}

}  // namespace
}  // namespace haustra::session
