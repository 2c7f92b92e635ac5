// The choice of a raycaster by measurement, with raycasters that only have a speed.
#include "render/raycaster_choice.h"

#include <algorithm>
#include <map>
#include <utility>

#include <gtest/gtest.h>

namespace haustra::render {
namespace {

using enum RaycasterKind;

struct FakeRaycaster {
    std::vector<double> ms;  // of its pictures, the last one for ever; empty: it cannot draw
};

struct Trials {
    std::optional<RaycasterKind> chosen;
    std::vector<RaycasterTrial> trials;
    double spentMs = 0.0, longestMs = 0.0;
    std::vector<RaycasterKind> order;
};

Trials tryAll(const std::vector<RaycasterKind>& candidates,
              const std::map<RaycasterKind, FakeRaycaster>& fakes, ChoiceLimits limits = {}) {
    RaycasterChoice choice(candidates, limits);
    std::map<RaycasterKind, std::size_t> drawn;
    Trials result;
    while (const auto next = choice.next()) {
        result.order.push_back(next->kind);
        EXPECT_LT(result.order.size(), 1000u) << "it never ends";
        if (result.order.size() >= 1000) break;
        const FakeRaycaster& fake = fakes.at(next->kind);
        const std::size_t n = drawn[next->kind]++;
        EXPECT_EQ(next->timed, n > 0);
        if (fake.ms.empty()) {
            choice.failed("broken");
            continue;
        }
        const double ms = fake.ms[std::min(n, fake.ms.size() - 1)];
        result.spentMs += ms;
        result.longestMs = std::max(result.longestMs, ms);
        choice.took(ms);
    }
    result.chosen = choice.fastest();
    result.trials = choice.trials();
    return result;
}

TEST(RaycasterChoice, TheLeastMedianWins) {
    EXPECT_EQ(tryAll({native, singlePass, hybrid},
                     {{native, {{20.0}}}, {singlePass, {{15.0}}}, {hybrid, {{18.0}}}})
                  .chosen,
              singlePass);
}

TEST(RaycasterChoice, TheFirstPictureDoesNotCountNorDoesOneSlowOne) {
    // Programs are compiled with the first picture; the third was disturbed.
    const Trials made = tryAll({native, singlePass}, {{native, {{1.0, 12.0, 12.0}}},
                                                      {singlePass, {{90.0, 9.0, 60.0, 9.0}}}});
    EXPECT_EQ(made.chosen, singlePass);
    EXPECT_EQ(made.trials[1].ms, (std::vector<double>{9.0, 60.0, 9.0, 9.0}));
}

TEST(RaycasterChoice, TiesGoToThePreferred) {
    EXPECT_EQ(tryAll({hybrid, native}, {{hybrid, {{7.0}}}, {native, {{7.0}}}}).chosen, hybrid);
    EXPECT_EQ(tryAll({native, hybrid}, {{hybrid, {{7.0}}}, {native, {{7.0}}}}).chosen, native);
}

TEST(RaycasterChoice, WhoFailsIsOutWithItsReason) {
    const Trials made = tryAll({native, singlePass}, {{native, {}}, {singlePass, {{500.0}}}});
    EXPECT_EQ(made.chosen, singlePass);
    EXPECT_EQ(made.trials[0].failure, "broken");
    EXPECT_EQ(describe(made.trials), "native: broken, single-pass 500.0 ms (1 picture)");
    EXPECT_FALSE(tryAll({native, singlePass}, {{native, {}}, {singlePass, {}}}).chosen);
}

TEST(RaycasterChoice, WhoFailsLaterIsOutToo) {
    RaycasterChoice choice({native, singlePass}, {});
    bool once = false;
    while (const auto next = choice.next()) {
        if (next->kind == native && next->round == 2 && !std::exchange(once, true))
            choice.failed("lost the device");
        else
            choice.took(next->kind == native ? 1.0 : 2.0);
    }
    EXPECT_TRUE(once);
    EXPECT_EQ(choice.fastest(), singlePass);
}

TEST(RaycasterChoice, CandidatesTakeTurns) {
    const Trials made = tryAll({native, singlePass}, {{native, {{5.0}}}, {singlePass, {{6.0}}}});
    for (std::size_t n = 4; n < made.order.size(); ++n)
        EXPECT_NE(made.order[n], made.order[n - 1]) << n;
    EXPECT_EQ(made.trials[0].ms.size(), made.trials[1].ms.size());
}

TEST(RaycasterChoice, TheHopelessAreTriedOnce) {
    const Trials made = tryAll({native, singlePass}, {{native, {{10.0}}}, {singlePass, {{31.0}}}});
    EXPECT_EQ(made.trials[1].ms.size(), 1u);
    EXPECT_EQ(made.trials[0].ms.size(), std::size_t(ChoiceLimits{}.rounds));
}

TEST(RaycasterChoice, TimeIsBounded) {
    const ChoiceLimits limits{100.0, 70.0, 1000, 1e9};
    const std::map<RaycasterKind, FakeRaycaster> fakes{
        {native, {{9.0}}}, {singlePass, {{30.0}}}, {hybrid, {{45.0}}}, {objectOrder, {{20.0}}}};
    const Trials made = tryAll({native, singlePass, hybrid, objectOrder}, fakes, limits);
    // The picture under way is finished; one that has drawn what does not count is timed, too.
    EXPECT_LE(made.spentMs, limits.timedMs + limits.makingMs + 3 * made.longestMs);
    EXPECT_EQ(made.chosen, native);
    EXPECT_TRUE(made.trials[3].ms.empty());
    EXPECT_NE(describe(made.trials).find("object-order: not tried"), std::string::npos);
}

TEST(RaycasterChoice, MakingOneTakesNoTimeFromTheOthers) {
    const Trials made =
        tryAll({singlePass, native}, {{singlePass, {{1500.0, 12.0}}}, {native, {{10.0}}}});
    EXPECT_EQ(made.trials[1].ms.size(), std::size_t(ChoiceLimits{}.rounds));
    EXPECT_EQ(made.chosen, native);
}

TEST(RaycasterChoice, WhateverTheTimeSomebodyIsChosen) {
    const ChoiceLimits none{0.0, 0.0, 4, 3.0};
    EXPECT_EQ(
        tryAll({native, singlePass}, {{native, {{900.0}}}, {singlePass, {{1.0}}}}, none).chosen,
        native);
    EXPECT_EQ(tryAll({native, singlePass}, {{native, {}}, {singlePass, {{1.0}}}}, none).chosen,
              singlePass);
}

TEST(RaycasterChoice, SoftwareDevicesPreferTheNativeOne) {
    EXPECT_EQ(raycasterCandidates(true).front(), native);
    EXPECT_EQ(raycasterCandidates(false).front(), singlePass);
    for (const bool software : {false, true})
        EXPECT_EQ(raycasterCandidates(software).size(), 5u);
}

}  // namespace
}  // namespace haustra::render
