// What a client's session makes of a server that lies: it ends and says why, soon, or goes on.
#include "end_to_end/fake_server.h"
#include "end_to_end/fake_wall.h"
#include "end_to_end/reader_fixture.h"
#include "end_to_end/session_fixture.h"
#include "protocol/limits.h"
#include "reader/session.h"
#include "temporary_folder.h"

#include <cmath>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

using protocol::ServerMessage;

class ClientOfAHostileServer : public tests::SessionFixture {
protected:
    static tests::Misbehaviour altering(std::function<void(ServerMessage&)> alters) {
        tests::Misbehaviour wrong;
        wrong.alters = std::move(alters);
        return wrong;
    }
    /// Why the session ended, of a server that alters what it says.
    std::string endOf(std::function<void(ServerMessage&)> alters,
                      const std::function<void(Session&)>& asks = {}) const {
        const tests::FakeServer server(altering(std::move(alters)));
        const auto session = sessionWith(server);
        if (asks) asks(*session);
        return until(*session, [&] { return session->phase() == Phase::failed; })
                   ? describe(session->failure())
                   : "it did not end";
    }
    static bool has(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
};

TEST_F(ClientOfAHostileServer, AnotherCaseThanAskedForIsNotShown) {
    const auto end = endOf([](ServerMessage& message) {
        if (message.has_case_opened()) message.mutable_case_opened()->set_name("another");
    });
    EXPECT_TRUE(has(end, "another case than was asked for")) << end;
}

TEST_F(ClientOfAHostileServer, AnOpenCaseDoesNotBecomeAnotherOfItself) {
    ServerMessage opened;
    const auto end = endOf([&](ServerMessage& message) {
        if (message.has_case_opened()) opened = message;
        if (!message.has_bookmark_list()) return;
        message = opened;
        message.mutable_case_opened()->set_scan("of-another-patient");
    });
    EXPECT_TRUE(has(end, "was not asked for")) << end;
}

TEST_F(ClientOfAHostileServer, AnAnswerIsOfTheQuestionsKind) {
    const auto end = endOf(
        [](ServerMessage& message) {
            if (!message.has_wall_place()) return;
            const std::uint64_t request = message.wall_place().request();
            message.mutable_scan_statistics()->set_request(request);
        },
        [](Session& session) { session.locate(glm::dvec2(0.5, 1.0)); });
    EXPECT_TRUE(has(end, "what was not asked")) << end;
}

TEST_F(ClientOfAHostileServer, APlaceFarAwayIsNone) {
    const auto end = endOf(
        [](ServerMessage& message) {
            if (message.has_wall_place()) message.mutable_wall_place()->set_arc_mm(1e200);
        },
        [](Session& session) { session.locate(glm::dvec2(0.5, 1.0)); });
    EXPECT_TRUE(has(end, "nowhere")) << end;
}

TEST_F(ClientOfAHostileServer, FindingsThatAreNoneEndTheSession) {
    using Alters = std::function<void(protocol::FindingList&)>;
    const auto first = [](protocol::FindingList& list) { return list.mutable_findings(0); };
    const std::vector<std::pair<std::string, Alters>> lies = {
        {"nowhere", [&](auto& list) { first(list)->mutable_position_mm()->set_x(2e6); }},
        {"nowhere", [&](auto& list) { first(list)->mutable_diameter_to_mm()->set_y(NAN); }},
        {"nowhere", [&](auto& list) { first(list)->mutable_wall()->set_arc_mm(1e9); }},
        {"figures", [&](auto& list) { first(list)->set_probability(1.5); }},
        {"figures", [&](auto& list) { first(list)->set_diameter_mm(-1.0); }},
        {"figures", [&](auto& list) { first(list)->set_arc_mm(INFINITY); }},
        {"without a number", [&](auto& list) { first(list)->set_number(0); }},
        {"same number", [&](auto& list) { first(list)->set_number(2); }},
        {"order", [&](auto& list) { first(list)->set_arc_mm(9e5); }},
        {"kind", [&](auto& list) { first(list)->set_kind(std::string(100, 'x')); }},
        {"fours", [&](auto& list) { first(list)->add_voxels(1); }},
        {"outside", [&](auto& list) { first(list)->set_voxels(0, 256); }},
        {"outside", [&](auto& list) { first(list)->set_voxels(3, 4'000'000'000u); }},
        {"hidden", [](auto& list) { list.set_state(protocol::FindingList::FIRST_PASS); }},
        {"list that is none", [](auto& list) { list.set_state(protocol::FindingList::State(9)); }},
        {"operating point", [](auto& list) { list.set_operating_point(-0.1); }},
        {"length", [](auto& list) { list.set_trained_on(std::string(5000, 'x')); }},
        {"warning", [](auto& list) { list.add_warnings(std::string(500, 'x')); }},
        {"more than a case",
         [](auto& list) {
             while (list.findings_size() <= haustra::maxFindings)
                 list.add_findings()->set_number(1);
         }},
        {"too many voxels",
         [&](auto& list) {
             for (std::size_t n = 0; n < 4 * protocol::maxListedRuns; ++n)
                 first(list)->add_voxels(1);
         }},
    };
    for (const auto& [reason, lie] : lies) {
        const auto tell = lie;
        const auto end = endOf(
            [tell](ServerMessage& message) {
                if (message.has_finding_list() && message.finding_list().findings_size() > 0)
                    tell(*message.mutable_finding_list());
            },
            [](Session& session) { session.setDetection({DetectionMode::concurrent}); });
        EXPECT_TRUE(has(end, reason)) << reason << ": " << end;
    }
}

TEST_F(ClientOfAHostileServer, WhatHasBeenSeenIsToldWithinBounds) {
    using Alters = std::function<void(ServerMessage&)>;
    const auto limits = [](ServerMessage& m) { return m.mutable_wall_seen()->mutable_limits(); };
    const auto patch = [](ServerMessage& m) { return m.mutable_missed_list()->mutable_patches(0); };
    const auto reader = [](ServerMessage& m) {
        return m.mutable_seen_report()->mutable_readers(0);
    };
    const std::vector<std::pair<std::string, Alters>> lies = {
        {"pixels", [&](auto& m) { limits(m)->set_pixels_per_mm(NAN); }},
        {"limits", [&](auto& m) { limits(m)->set_least_ms(4'000'000'000u); }},
        {"figures", [](auto& m) { m.mutable_missed_list()->set_share(1.1); }},
        {"figures", [](auto& m) { m.mutable_missed_list()->set_area_mm2(-1.0); }},
        {"figures", [](auto& m) { m.mutable_missed_list()->set_count(4'000'000'000u); }},
        {"area is none", [&](auto& m) { patch(m)->set_area_mm2(INFINITY); }},
        {"nowhere", [&](auto& m) { patch(m)->mutable_place()->set_arc_mm(1e9); }},
        {"", [&](auto& m) { patch(m)->mutable_view()->clear_forward(); }},
        {"more patches",
         [](auto& m) {
             while (m.missed_list().patches_size() <= protocol::maxMissedPatches)
                 m.mutable_missed_list()->add_patches()->set_area_mm2(1.0);
         }},
        {"figures", [&](auto& m) { reader(m)->set_reader("a b"); }},
        {"figures", [&](auto& m) { reader(m)->set_share(-0.1); }},
        {"no wall", [](auto& m) { m.mutable_seen_report()->set_wall(std::string(65, 'f')); }},
        {"more readers",
         [](auto& m) {
             while (m.seen_report().readers_size() <= protocol::maxReportedLedgers)
                 m.mutable_seen_report()->add_readers();
         }},
        {"as many as triangles",
         [](auto& m) {
             m.mutable_ledger()->set_triangles(17);
             m.mutable_ledger()->set_seen(std::string(2, 'x'));
             m.mutable_ledger()->set_shown(std::string(3, 'x'));
         }},
        {"no wall", [](auto& m) { m.mutable_ledger()->set_triangles(4'000'000'000u); }},
    };
    int asked = 0;
    for (const auto& [reason, lie] : lies) {
        const auto tell = lie;
        const int which = asked++;
        const auto body = which < 2    ? ServerMessage::kWallSeen
                          : which < 9  ? ServerMessage::kMissedList
                          : which < 13 ? ServerMessage::kSeenReport
                                       : ServerMessage::kLedger;
        const auto end = endOf(
            [tell, body](ServerMessage& message) {
                if (message.body_case() == body) tell(message);
            },
            [body](Session& session) {
                if (body == ServerMessage::kMissedList) session.requestMissed();
                if (body == ServerMessage::kSeenReport) session.requestSeenReport();
                if (body == ServerMessage::kLedger) session.requestLedger();
            });
        EXPECT_TRUE(!end.empty() && has(end, reason)) << reason << ": " << end;
    }
}

// It may have crossed a change of the mode on its way: it is not an end, but nothing is shown.
TEST_F(ClientOfAHostileServer, FindingsThatAreNotToBeSeenYetAreNotKept) {
    const tests::FakeServer server(altering([](ServerMessage& message) {
        if (!message.has_finding_list()) return;
        protocol::SetDetection concurrent;
        concurrent.set_mode(protocol::SetDetection::CONCURRENT);
        const auto request = message.finding_list().request();
        *message.mutable_finding_list() = tests::fakeFindings(concurrent);
        message.mutable_finding_list()->set_request(request);
    }));
    const auto session = sessionWith(server);
    session->setDetection({DetectionMode::secondReader});
    const auto request = session->requestFindings();
    ASSERT_TRUE(until(*session, [&] { return session->answeredFindingsRequest() >= request; }));
    ASSERT_TRUE(session->findings());
    EXPECT_TRUE(session->findings()->findings.empty());
}

void fillBookmarks(protocol::BookmarkList& list, std::uint64_t count) {
    for (std::uint64_t n = 1; n <= count; ++n) {
        auto* bookmark = list.add_bookmarks();
        bookmark->set_id(n);
        bookmark->set_client_key(std::to_string(n));
        bookmark->mutable_forward()->set_z(1.0);
        bookmark->mutable_up()->set_y(-1.0);
    }
}

TEST_F(ClientOfAHostileServer, MoreBookmarksThanAScanCanHaveAreRefused) {
    const auto end = endOf([](ServerMessage& message) {
        if (message.has_bookmark_list()) fillBookmarks(*message.mutable_bookmark_list(), 60'000);
    });
    EXPECT_TRUE(has(end, "more bookmarks")) << end;
}

TEST_F(ClientOfAHostileServer, TheMostBookmarksThatCanBeAreTakenSoon) {
    const tests::FakeServer server(altering([](ServerMessage& message) {
        if (message.has_bookmark_list()) fillBookmarks(*message.mutable_bookmark_list(), 15'000);
    }));
    const auto session = sessionWith(server);
    ASSERT_TRUE(until(*session, [&] { return session->phase() == Phase::open; }));
    const auto revision = session->bookmarksRevision();
    const auto start = Clock::now();
    ASSERT_TRUE(until(*session, [&] { return session->answeredBookmarkRequest() > 0; }));
    EXPECT_EQ(session->bookmarks().size(), 15'000u);
    EXPECT_NE(session->bookmarksRevision(), revision);
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(10));
}

TEST_F(ClientOfAHostileServer, ItsReasonsAreShortLines) {
    const tests::FakeServer server(altering([](ServerMessage& message) {
        if (!message.has_bookmark_list()) return;
        message.mutable_error()->set_code(protocol::ErrorReport::BAD_VALUE);
        message.mutable_error()->set_message("no\n" + std::string(3'000'000, 'x'));
    }));
    const auto session = sessionWith(server);
    std::vector<Error> refusals;
    ASSERT_TRUE(until(*session, [&] {
        for (Error& refusal : session->takeRefusals())
            refusals.push_back(std::move(refusal));
        return !refusals.empty();
    }));
    EXPECT_LT(refusals[0].message.size(), 500u);
    EXPECT_EQ(refusals[0].message.find('\n'), std::string::npos);
}

TEST_F(ClientOfAHostileServer, AnEmptyReasonIsNone) {
    const tests::FakeServer server(altering([](ServerMessage& message) {
        if (!message.has_bookmark_list()) return;
        message.mutable_error()->set_code(protocol::ErrorReport::BAD_VALUE);
        message.mutable_error()->set_message("\n\t\x07");
    }));
    const auto session = sessionWith(server);
    std::vector<Error> refusals;
    ASSERT_TRUE(until(*session, [&] {
        for (Error& refusal : session->takeRefusals())
            refusals.push_back(std::move(refusal));
        return !refusals.empty();
    }));
    EXPECT_EQ(refusals[0].message, "the server refused: it gave no reason");
}

TEST_F(ClientOfAHostileServer, WhatItOwesIsKnown) {
    for (const bool owes : {false, true}) {
        tests::Misbehaviour wrong;
        wrong.noStills = owes;
        const tests::FakeServer server(wrong);
        const auto session = sessionWith(server);
        ASSERT_TRUE(until(*session, [&] { return session->phase() == Phase::open; }));
        EXPECT_EQ(session->overdue().count(), 0);
        session->setViewport(0, View::endoscopic, 64, 64);
        session->look(0, Camera{}, false);
        const auto end = Clock::now() + std::chrono::milliseconds(1200);
        EXPECT_TRUE(until(*session, [&] { return Clock::now() > end; }));
        EXPECT_EQ(session->overdue().count(), owes ? 1 : 0);
    }
    tests::Misbehaviour silent;
    silent.silentAboutTheWall = true;
    const tests::FakeServer server(silent);
    const auto session = sessionWith(server);
    ASSERT_TRUE(until(*session, [&] { return session->phase() == Phase::open; }));
    session->locate(glm::dvec2(0.5, 1.0));
    EXPECT_TRUE(until(*session, [&] { return session->overdue().count() >= 1; }));
}

TEST_F(ClientOfAHostileServer, AFloodOfRefusalsIsTakenAFewAtATime) {
    const tests::FakeServer server;
    const auto session = sessionWith(server);
    ASSERT_TRUE(until(*session, [&] { return session->phase() == Phase::open; }));
    for (int n = 0; n < 200; ++n)
        session->pick({0, 0, 0}, {0, 0, -1});  // which the fake wall refuses
    std::size_t answered = 0, told = 0;
    ASSERT_TRUE(until(*session, [&] {
        answered += session->takeWallAnswers().size();
        return answered == 200;
    }));
    told = session->takeRefusals().size();
    EXPECT_GT(told, 0u);
    EXPECT_LE(told, 16u);
}

}  // namespace
}  // namespace haustra::reader
