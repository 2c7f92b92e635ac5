// What a client's session asks and is told beside pictures, against a server on the loopback that
// closes its socket, or is an old one.
#include "end_to_end/fake_server.h"
#include "end_to_end/fake_wall.h"
#include "end_to_end/session_fixture.h"
#include "reader/findings_reading.h"
#include "reader/session.h"
#include "temporary_folder.h"

#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

using tests::FakeServer;
using tests::Misbehaviour;

class ClientSession : public tests::SessionFixture {
protected:
    static bool open(Session& session) {
        return until(session, [&] { return session.phase() == Phase::open; });
    }
    static std::vector<Session::ScanAnswer> scanAnswers(Session& session, std::size_t count) {
        std::vector<Session::ScanAnswer> answers;
        EXPECT_TRUE(until(session, [&] {
            for (auto& answer : session.takeScanAnswers())
                answers.push_back(std::move(answer));
            return answers.size() >= count;
        }));
        return answers;
    }
};

TEST_F(ClientSession, ValuesOfTheScanAreAskedForAndTold) {
    FakeServer server;
    const auto session = sessionWith(server);
    // Before there is a case, too.
    const auto first = session->measureScan({{3, 4, 5}});
    ASSERT_TRUE(open(*session));
    ASSERT_TRUE(session->serverCan("scan-values"));
    const auto second = session->measureScan({{1, 2, 3}, {4, 0, 0}, {0, 5, 0}, Scan::cleansed});
    EXPECT_GT(second, first);
    const auto answers = scanAnswers(*session, 2);
    ASSERT_EQ(answers.size(), 2u);
    EXPECT_EQ(answers[0].request, first);
    ASSERT_TRUE(answers[0].values);
    EXPECT_EQ(answers[0].values->samples, 1u);
    EXPECT_EQ(answers[0].values->meanHu, 2 * 3 + 3 * 4 + 5);
    EXPECT_EQ(answers[1].request, second);
    ASSERT_TRUE(answers[1].values);
    EXPECT_EQ(answers[1].values->meanHu, 2 * 1 + 3 * 2 + 3 + 1000);
    EXPECT_NEAR(answers[1].values->deviationHu, 0.5 * std::hypot(8, 15), 1e-12);
    EXPECT_NEAR(answers[1].values->areaMm2, std::numbers::pi * 20, 1e-12);
    EXPECT_TRUE(session->takeScanAnswers().empty());
    EXPECT_TRUE(session->takeWallAnswers().empty());
}

TEST_F(ClientSession, AWallIsPickedWithAndWithoutAStrip) {
    for (const bool flattened : {true, false}) {
        Misbehaviour bare;
        bare.notFlattened = !flattened;
        FakeServer server(bare);
        const auto session = sessionWith(server);
        const auto hit = session->pick({1, 2, 3}, {0, 0, 7});
        ASSERT_TRUE(open(*session));
        const auto missed = session->pick({1, 2, 3}, {0, 0, -1});
        std::vector<Session::WallAnswer> answers;
        ASSERT_TRUE(until(*session, [&] {
            for (auto& answer : session->takeWallAnswers())
                answers.push_back(std::move(answer));
            return answers.size() >= 2;
        }));
        EXPECT_EQ(answers[0].request, hit);
        ASSERT_TRUE(answers[0].body);
        const auto& place = std::get<WallPlace>(*answers[0].body);
        EXPECT_LT(glm::distance(place.positionMm, glm::dvec3(1, 2, 3 + tests::fakeRadiusMm)), 1e-9);
        EXPECT_EQ(place.flat.has_value(), flattened);
        EXPECT_EQ(answers[1].request, missed);
        EXPECT_FALSE(answers[1].body);
        EXPECT_EQ(session->takeRefusals().size(), 1u);
        EXPECT_EQ(session->phase(), Phase::open);
    }
}

TEST_F(ClientSession, CasesAreToldBesideAnOpenOne) {
    FakeServer server;
    const auto session = sessionWith(server);
    const auto early = session->requestCases();  // before there is a link
    ASSERT_TRUE(open(*session));
    ASSERT_TRUE(until(*session, [&] { return session->answeredCasesRequest() >= early; }));
    const auto info = session->caseInfo();
    session->addBookmark({}, 0.0, "one");
    const auto late = session->requestCases();
    EXPECT_GT(late, early);
    ASSERT_TRUE(until(*session, [&] { return session->answeredCasesRequest() >= late; }));
    EXPECT_EQ(session->phase(), Phase::open);
    EXPECT_EQ(session->caseInfo(), info);
    ASSERT_EQ(session->cases().size(), 1u);
    const CaseEntry& entry = session->cases().front();
    EXPECT_EQ(entry.name, "phantom");
    EXPECT_EQ(entry.state, CaseEntry::State::ready);
    EXPECT_EQ(entry.preparedUtc, "2020-02-20T20:20:20Z");
    EXPECT_EQ(entry.size, glm::ivec3(256, 256, 200));
    EXPECT_TRUE(entry.cleansed && entry.flattened);
    EXPECT_EQ(entry.confidence, 0.75);
    EXPECT_EQ(entry.warnings, 2);
    EXPECT_EQ(entry.bookmarks, 1);
    EXPECT_EQ(entry.readers, 1);
}

TEST_F(ClientSession, AListThatALostLinkLeftIsAskedForAgain) {
    Misbehaviour wrong;
    wrong.dropAtQuestions = 1;
    FakeServer server(wrong);
    const auto session = sessionWith(server);
    ASSERT_TRUE(open(*session));
    session->measureScan({});  // closes the socket
    ASSERT_TRUE(until(*session, [&] { return session->phase() == Phase::lost; }));
    const auto request = session->requestCases();
    ASSERT_TRUE(until(*session, [&] { return session->answeredCasesRequest() >= request; }));
    EXPECT_EQ(session->caseNames(), std::vector<std::string>{"phantom"});
    ASSERT_TRUE(open(*session));
}

TEST_F(ClientSession, WithoutACaseTheListIsWhatThereIsToChooseFrom) {
    for (const bool old : {false, true}) {
        Misbehaviour wrong;
        wrong.old = old;
        FakeServer server(wrong);
        const auto session = sessionWith(server, "");
        ASSERT_TRUE(until(*session, [&] { return session->phase() == Phase::choosing; }));
        EXPECT_EQ(session->caseNames(), std::vector<std::string>{"phantom"});
        EXPECT_EQ(session->cases().front().state,
                  old ? CaseEntry::State::unknown : CaseEntry::State::ready);
        const auto again = session->requestCases();
        ASSERT_TRUE(until(*session, [&] { return session->answeredCasesRequest() >= again; }));
        EXPECT_EQ(session->phase(), Phase::choosing);
        session->openCase("phantom");
        ASSERT_TRUE(open(*session));
    }
}

TEST_F(ClientSession, OthersBookmarksAppearByThemselvesWithTheirMarks) {
    Misbehaviour sharing;
    sharing.othersMarkToo = true;
    FakeServer server(sharing);
    const auto session = sessionWith(server);
    ASSERT_TRUE(open(*session));
    const std::string key = session->addBookmark({}, 120.0, "mine");
    ASSERT_TRUE(until(*session, [&] {
        return session->acknowledgedBookmark(key) && session->acknowledgedBookmark("another's");
    }));
    EXPECT_EQ(session->bookmarks().size(), 2u);
    EXPECT_EQ(session->takeBookmarkOutcomes().size(), 1u);
    EXPECT_EQ(session->owedBookmarks(), 0u);
    for (const Bookmark& bookmark : session->bookmarks()) {
        ASSERT_TRUE(bookmark.mark && bookmark.mark->flat);
        EXPECT_NEAR(bookmark.mark->flat->x, 0.75, 1e-9);
        EXPECT_NEAR(bookmark.mark->arcMm, 120.0, 1e-9);
    }
}

TEST_F(ClientSession, TheSeenShareIsTheServersAndNotKnownBefore) {
    Misbehaviour wrong;
    wrong.seenAtFirst = 0.375;
    wrong.dropAtQuestions = 1;
    FakeServer server(wrong);
    const auto session = sessionWith(server);
    EXPECT_FALSE(session->seenShare());
    ASSERT_TRUE(until(*session, [&] { return session->seenShare().has_value(); }));
    EXPECT_EQ(session->seenShare(), 0.375);
    const auto forgot = session->askSeen(true);
    ASSERT_TRUE(until(*session, [&] { return session->answeredSeenRequest() >= forgot; }));
    EXPECT_EQ(session->seenShare(), 0.0);
    session->measureScan({});  // closes the socket; the next connection begins anew
    ASSERT_TRUE(until(*session, [&] { return server.connections() == 2; }));
    ASSERT_TRUE(until(*session, [&] { return session->seenShare() == 0.375; }));
}

TEST_F(ClientSession, WithoutAStripNothingIsAskedAboutIt) {
    Misbehaviour bare;
    bare.notFlattened = true;
    FakeServer server(bare);
    const auto session = sessionWith(server);
    ASSERT_TRUE(open(*session));
    const auto list = session->requestBookmarks();
    ASSERT_TRUE(until(*session, [&] { return session->answeredBookmarkRequest() >= list; }));
    EXPECT_FALSE(session->seenShare());
    EXPECT_TRUE(session->takeRefusals().empty());
}

TEST_F(ClientSession, WhatALostLinkLeftUnansweredIsAskedAgain) {
    Misbehaviour wrong;
    wrong.dropAtQuestions = 1;
    FakeServer server(wrong);
    const auto session = sessionWith(server);
    ASSERT_TRUE(open(*session));
    const auto request = session->measureScan({{1, 1, 1}});
    const auto answers = scanAnswers(*session, 1);
    ASSERT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers[0].request, request);
    EXPECT_TRUE(answers[0].values);
    EXPECT_EQ(server.connections(), 2);
    // Another case forgets what was asked of the one before.
    session->measureScan({{2, 2, 2}});
    session->openCase("phantom");
    ASSERT_TRUE(open(*session));
    const auto last = session->measureScan({{3, 3, 3}});
    for (const auto& answer : scanAnswers(*session, 1))
        EXPECT_EQ(answer.request, last);
}

TEST_F(ClientSession, ACaseThatIsRefusedLeadsBackToTheListWhereThereIsOne) {
    for (const bool offers : {true, false}) {
        Misbehaviour wrong;
        wrong.refuseCaseWith = protocol::ErrorReport::NO_SUCH_CASE;
        FakeServer server(wrong);
        const auto session = sessionWith(server);
        session->setOffersCases(offers);
        const Phase expected = offers ? Phase::choosing : Phase::failed;
        ASSERT_TRUE(until(*session, [&] { return session->phase() == expected; }));
        EXPECT_FALSE(session->takeRefusals().empty());
        if (offers) {
            EXPECT_TRUE(until(*session, [&] { return !session->cases().empty(); }));
        }
    }
}

TEST_F(ClientSession, FindingsComeWhenTheModeShowsThemAndAgainAfterALostLink) {
    FakeServer server;
    const auto session = sessionWith(server);
    ASSERT_TRUE(open(*session));
    FindingsReading findings(*session);
    ASSERT_TRUE(until(*session, [&] { return session->findings().has_value(); }));
    EXPECT_EQ(session->findings()->state, FindingList::State::off);
    EXPECT_EQ(session->findings()->trainedOn, "nothing: this is a test");
    EXPECT_FALSE(findings.finishFirstPass()) << "nobody waits for it";
    ASSERT_TRUE(findings.choose(DetectionMode::secondReader));
    ASSERT_TRUE(until(*session,
                      [&] { return session->findings()->state == FindingList::State::firstPass; }));
    EXPECT_TRUE(findings.shown().empty());
    ASSERT_TRUE(findings.finishFirstPass());
    ASSERT_TRUE(until(*session, [&] { return findings.shown().size() == 2; }));
    DetectionChoice choice = findings.choice();
    choice.leastProbability = 0.25;
    ASSERT_TRUE(findings.choose(choice));
    ASSERT_TRUE(until(*session, [&] { return findings.shown().size() == 3; }));
    const std::vector<int> order = {findings.shown()[0].number, findings.shown()[1].number,
                                    findings.shown()[2].number};
    EXPECT_EQ(order, (std::vector{1, 3, 2}));
    EXPECT_TRUE(findings.shown()[1].candidate);
    EXPECT_FALSE(findings.shown()[0].view);
    ASSERT_TRUE(findings.shown()[1].view);
    EXPECT_EQ(findings.shown()[1].view->forward, glm::dvec3(0, 0, 1));
    EXPECT_EQ(findings.shown()[1].view->up, glm::dvec3(0, -1, 0));
    EXPECT_EQ(findings.shown()[0].finding.segment, ColonSegment::sigmoid);
    EXPECT_EQ(findings.shown()[0].finding.voxels.size(), 1u);
    // From one to the next, also of those at one arc.
    EXPECT_EQ(findings.next(1, 0.0)->number, 1);
    EXPECT_EQ(findings.next(-1, 0.0), nullptr);
    // Whoever flew there has not been led there.
    const double firstArcMm = findings.shown()[0].wall.arcMm;
    EXPECT_EQ(findings.next(1, firstArcMm)->number, 1);
    EXPECT_EQ(findings.next(-1, firstArcMm)->number, 1);
    findings.setCurrent(*findings.find(3));
    // Who looks around at one is still there, and passes none over.
    for (const double awayMm : {0.0, 3.0, -3.0, 30.0}) {
        EXPECT_EQ(findings.next(1, findings.current()->wall.arcMm + awayMm)->number, 2);
        EXPECT_EQ(findings.next(-1, findings.current()->wall.arcMm + awayMm)->number, 1);
    }
    EXPECT_EQ(findings.next(1, findings.shown().back().wall.arcMm + 41.0), nullptr);
    // Of a search that has another at its number, none is the one that was gone to.
    ListedFinding former = *findings.find(3);
    former.wall.positionMm.x += 1.0;
    findings.setCurrent(former);
    EXPECT_EQ(findings.current(), nullptr);
    // The server hears the mode again before it is asked for the list.
    const int heard = server.detectionMessages();
    server.setDown(true);
    ASSERT_TRUE(until(*session, [&] { return session->phase() == Phase::lost; }));
    server.setDown(false);
    const auto revision = session->findingsRevision();
    ASSERT_TRUE(until(*session, [&] { return session->findingsRevision() != revision; }));
    EXPECT_EQ(server.detectionMessages(), heard + 1);
    EXPECT_EQ(findings.shown().size(), 3u);
}

TEST_F(ClientSession, AnOldServerIsNotAskedWhatItDoesNotKnow) {
    Misbehaviour wrong;
    wrong.old = true;
    FakeServer server(wrong);
    const auto session = sessionWith(server);
    const auto early = session->measureScan({{1, 1, 1}});
    ASSERT_TRUE(open(*session));
    EXPECT_FALSE(session->serverCan("scan-values"));
    const auto late = session->measureScan({{2, 2, 2}});
    const auto answers = scanAnswers(*session, 2);
    ASSERT_EQ(answers.size(), 2u);
    EXPECT_EQ(answers[0].request, early);
    EXPECT_EQ(answers[1].request, late);
    for (const auto& answer : answers) {
        ASSERT_FALSE(answer.values);
        EXPECT_EQ(answer.values.error().kind, ErrorKind::unsupported);
    }
    FindingsReading findings(*session);
    EXPECT_FALSE(findings.has());
    EXPECT_FALSE(findings.choose(DetectionMode::concurrent));
    session->setDetection({DetectionMode::concurrent});
    const auto asked = session->requestFindings();
    EXPECT_TRUE(until(*session, [&] { return session->answeredFindingsRequest() >= asked; }));
    EXPECT_FALSE(session->findings());
    // The session is as it was.
    const auto list = session->requestBookmarks();
    ASSERT_TRUE(until(*session, [&] { return session->answeredBookmarkRequest() >= list; }));
    EXPECT_EQ(server.connections(), 1);
    EXPECT_EQ(session->phase(), Phase::open);
}

}  // namespace
}  // namespace haustra::reader
