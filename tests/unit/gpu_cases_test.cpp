// Room for another case on the GPU.
#include "session/gpu_cases.h"

#include <random>

#include <gtest/gtest.h>

namespace haustra::session {
namespace {

Clock::time_point at(int seconds) {
    return Clock::time_point{} + std::chrono::seconds(seconds);
}
using Indices = std::vector<std::size_t>;

TEST(Room, WithoutABudgetWhatNobodyReadsGoes) {
    const Room room = makeRoom({{100, true, {}}, {50, false, at(1)}, {70, false, at(2)}}, 0, 10);
    EXPECT_EQ(room.released, (Indices{1, 2}));
    EXPECT_GT(room.freeBytes, std::size_t(1) << 40);
}

TEST(Room, WhatFitsSendsNobodyAway) {
    const Room room = makeRoom({{100, true, {}}, {50, false, at(1)}}, 200, 50);
    EXPECT_TRUE(room.released.empty());
    EXPECT_EQ(room.freeBytes, 50u);
}

TEST(Room, TheOneLeftLongestAgoGoesFirst) {
    const std::vector<HeldCase> held{{40, false, at(3)}, {40, false, at(1)}, {40, false, at(2)}};
    EXPECT_EQ(makeRoom(held, 130, 20).released, (Indices{1}));
    EXPECT_EQ(makeRoom(held, 130, 60).released, (Indices{1, 2}));
    EXPECT_EQ(makeRoom(held, 130, 120).released, (Indices{0, 1, 2}));
}

TEST(Room, WhatIsOpenStaysAndTheRestIsWhatIsLeft) {
    const Room room = makeRoom({{100, true, {}}, {40, false, at(1)}, {30, true, {}}}, 160, 90);
    EXPECT_EQ(room.released, (Indices{1}));
    EXPECT_EQ(room.freeBytes, 30u);
    EXPECT_EQ(makeRoom({{100, true, {}}}, 80, 1).freeBytes, 0u);
}

TEST(Room, FreeIsWhatTheBudgetHasOverThoseThatStay) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<HeldCase> held(random() % 6);
        for (HeldCase& one : held)
            one = {random() % 100, random() % 2 == 0, at(int(random() % 50))};
        const std::size_t budget = 1 + random() % 300, bytes = random() % 200;
        const Room room = makeRoom(held, budget, bytes);
        std::size_t stays = 0, last = 0;
        bool open = false;
        for (std::size_t n = 0; n < held.size(); ++n) {
            const bool gone =
                std::find(room.released.begin(), room.released.end(), n) != room.released.end();
            open |= gone && held[n].open;
            if (!gone) stays += held[n].bytes;
            if (gone && held[n].leftAt >= held[room.released[last]].leftAt)
                last = std::size_t(std::find(room.released.begin(), room.released.end(), n) -
                                   room.released.begin());
        }
        EXPECT_FALSE(open);
        EXPECT_EQ(room.freeBytes, stays < budget ? budget - stays : 0u);
        // The one that went last was needed.
        if (!room.released.empty()) {
            const std::size_t with = stays + held[room.released[last]].bytes;
            EXPECT_TRUE(with > budget || budget - with < bytes);
        }
    }
}

}  // namespace
}  // namespace haustra::session
