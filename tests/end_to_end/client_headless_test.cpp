// The client's session and scripts against a server on the loopback: exact stills, latencies,
// pinning, refusals, lost links.
#include "end_to_end/fake_server.h"
#include "end_to_end/fake_wall.h"
#include "picture_files.h"
#include "protocol/limits.h"
#include "reader/overview_map.h"
#include "script/script_player.h"
#include "temporary_folder.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace haustra::reader {
namespace {

using tests::FakeServer;
using tests::Misbehaviour;

class ClientHeadless : public ::testing::Test {
protected:
    link::ConnectionOptions optionsFor(const FakeServer& server) const {
        link::ConnectionOptions options;
        options.address = {"127.0.0.1", server.port()};
        options.pinning.knownServersFile = folder_ / "known_servers";
        return options;
    }
    PlayReport play(const link::ConnectionOptions& connection, const std::string& script,
                    const std::string& caseName = "phantom") {
        std::istringstream in(script);
        const auto actions = parseScript(in, "script");
        EXPECT_TRUE(actions) << describe(actions.error());
        PlayOptions options;
        options.outFolder = folder_;
        options.scriptName = "script";
        options.width = options.height = 200;
        options.patience = std::chrono::milliseconds(3000);
        Session session(connection, caseName);
        return reader::play(session, *actions, options);
    }
    std::vector<std::uint8_t> readPng(const std::string& name, int& width, int& height) const {
        Image image = tests::readPicture(folder_ / name);
        width = image.width;
        height = image.height;
        return std::move(image.rgb);
    }

    const tests::TemporaryFolder temporary_;
    const std::filesystem::path folder_ = temporary_.path();
};

TEST_F(ClientHeadless, StillsAreTheServersPixels) {
    FakeServer server;
    const auto report =
        play(optionsFor(server), R"({"do":"view","view":"endoscopic","size":[300,200]}
{"do":"go","arc_mm":120,"direction":"retrograde"}
{"do":"still","png":"still.png"}
{"do":"view","viewport":1,"view":"axial","size":[150,130]}
{"do":"window","viewport":1,"center_hu":40,"width_hu":400}
{"do":"slice","view":"axial","position_mm":[1,2,3],"png":"slice.png"}
{"do":"slice","view":"axial","position_mm":[1,2,3],"cleansed":true,"png":"cleansed.png"})");
    ASSERT_FALSE(report.failure) << describe(*report.failure);
    int width = 0, height = 0;
    const auto still = readPng("still.png", width, height);
    ASSERT_EQ(width, 300);
    const Centerline path = FakeServer::centerline();
    const auto camera = cameraAtArc(path, rotationMinimizingUps(path, flightPreferredUp), 120.0,
                                    FlightDirection::retrograde);
    EXPECT_EQ(still, tests::syntheticPicture(300, 200, camera.positionMm, 0.0));
    const auto slice = readPng("slice.png", width, height);
    ASSERT_EQ(height, 130);
    EXPECT_EQ(slice, tests::syntheticPicture(150, 130, {1, 2, 3}, 40.0));
    EXPECT_EQ(readPng("cleansed.png", width, height),
              tests::syntheticPicture(150, 130, {1, 2, 3}, 40.0 + tests::cleansedShiftHu));
}

TEST_F(ClientHeadless, ALensLiesOverTheStill) {
    FakeServer server;
    const auto report = play(optionsFor(server), R"({"do":"go","arc_mm":120}
{"do":"still","png":"still.png"}
{"do":"lens","at":[0.2,-0.1],"radius":0.25,"png":"lens.png"})");
    ASSERT_FALSE(report.failure) << describe(*report.failure);
    int width = 0, height = 0;
    const auto still = readPng("still.png", width, height),
               lens = readPng("lens.png", width, height);
    ASSERT_EQ(still.size(), lens.size());
    int changed = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t n = 3 * std::size_t(y * width + x);
            const bool same = std::equal(&still[n], &still[n] + 3, &lens[n]);
            changed += !same;
            const double away = glm::distance(glm::dvec2(x, y) + 0.5, glm::dvec2(140.0, 80.0));
            EXPECT_TRUE(same || away < 50.6) << x << ' ' << y;
        }
    EXPECT_GT(changed, 3000);
    const int viewport = int(protocol::lensViewport);
    EXPECT_TRUE(server.askedOf(viewport).pictures == 1);
    const auto failureOf = [&](const Misbehaviour& wrong, const char* script) {
        FakeServer other(wrong);
        auto options = optionsFor(other);
        options.pinning.knownServersFile = folder_ / ("known-" + std::to_string(other.port()));
        const auto played = play(options, script);
        EXPECT_EQ(other.askedOf(viewport).pictures, 0);
        return played.failure ? describe(*played.failure) : std::string();
    };
    Misbehaviour old;
    old.old = true;
    EXPECT_NE(failureOf(old, R"({"do":"lens"})").find("this server cannot show a lens"),
              std::string::npos);
    EXPECT_NE(failureOf({}, R"({"do":"lens","at":[0.9,0]})").find("does not show this place"),
              std::string::npos);
}

TEST_F(ClientHeadless, AFlightMeasuresEachPosition) {
    FakeServer server;
    for (const char* pipelined : {"false", "true"}) {
        const auto report =
            play(optionsFor(server),
                 std::string(R"({"do":"fly","positions":40,"pipelined":)") + pipelined + "}");
        ASSERT_FALSE(report.failure) << describe(*report.failure);
        const ActionReport& fly = report.actions.at(0);
        EXPECT_EQ(fly.latencyMs.size(), 40u);
        EXPECT_EQ(fly.positions, 40);
        EXPECT_GT(fly.bytes, 40u * 500u);
        EXPECT_EQ(fly.renderMicroseconds.at(7), 1000u);
        for (const double ms : fly.latencyMs)
            EXPECT_GT(ms, 0.0);
        double sum = 0.0;
        for (const double ms : fly.latencyMs)
            sum += ms;
        if (*pipelined == 'f') {
            EXPECT_LE(sum, fly.seconds * 1000.0);
        }
        const auto json = nlohmann::json::parse(toJson(report));
        EXPECT_EQ(json["actions"][0]["latency_ms"]["count"], 40);
        EXPECT_EQ(json["server"], "fake-server 1");
    }
}

TEST_F(ClientHeadless, TheFlattenedWallIsSeenLocatedAndMeasured) {
    FakeServer server;
    const auto report = play(optionsFor(server), R"({"do":"flat","center":[0.25,3],"png":"flat.png"}
{"do":"go","fraction":0.5}
{"do":"flat","pixels_per_circumference":400,"size":[150,130],"png":"here.png"}
{"do":"strip","size":[120,300],"png":"strip.png"}
{"do":"locate","flat":[0.75,1.5],"json":"place.json"}
{"do":"locate","position_mm":[60,0,0]}
{"do":"measure","flat":[[0.9,2],[1.1,2]]}
{"do":"measure","flat":[[0.1,2],[0.2,2],[0.2,2.1],[0.1,2.1]],"closed":true,"json":"measure.json"})");
    ASSERT_FALSE(report.failure) << describe(*report.failure);
    int width = 0, height = 0;
    EXPECT_EQ(
        readPng("flat.png", width, height),
        tests::syntheticPicture(200, 200, tests::syntheticPosition({0.25, 3.0}, 200 / 1.16), 0.0));
    EXPECT_EQ(readPng("here.png", width, height),
              tests::syntheticPicture(150, 130, tests::syntheticPosition({0.5, 3.0}, 400.0), 0.0));
    readPng("strip.png", width, height);
    EXPECT_EQ(width, 120);
    EXPECT_EQ(height, 300);
    std::ifstream in(folder_ / "place.json");
    const auto place = nlohmann::json::parse(in);
    const auto truth = tests::fakePlace({0.75, 1.5});
    EXPECT_NEAR(place["arc_mm"], truth.arc_mm(), 1e-9);
    EXPECT_NEAR(place["position_mm"][1], truth.position_mm().y(), 1e-9);
    EXPECT_EQ(place["triangle"], truth.triangle());
    EXPECT_NEAR(report.actions[5].place->flat->y, 0.0, 1e-9);
    EXPECT_NEAR(report.actions[6].measure->lengthMm, 0.2 * tests::fakeCircumferenceMm, 1e-9);
    EXPECT_NEAR(report.actions[7].measure->areaMm2, 0.01 * 90.0 * 90.0, 1e-9);
    const auto json = nlohmann::json::parse(toJson(report));
    EXPECT_NEAR(json["actions"][6]["measure"]["straight_mm"], 18.0, 1e-9);

    EXPECT_NE(describe(*play(optionsFor(server), R"({"do":"locate","flat":[0.5,7]})").failure)
                  .find("script:1: locate"),
              std::string::npos);
    Misbehaviour bare;
    bare.notFlattened = true;
    FakeServer other(bare);
    auto options = optionsFor(other);
    options.pinning.knownServersFile = folder_ / "known-other";
    for (const char* action :
         {R"({"do":"flat"})", R"({"do":"strip"})", R"({"do":"flyover"})",
          R"({"do":"locate","flat":[0,0]})", R"({"do":"measure","flat":[[0,0],[0.1,0]]})",
          R"({"do":"view","view":"flattened"})"}) {
        const auto refused = play(options, action);
        ASSERT_TRUE(refused.failure) << action;
        EXPECT_NE(refused.failure->message.find("has not been flattened"), std::string::npos);
    }
}

TEST_F(ClientHeadless, TheViewsFromOutsideAndAcrossTheGazeAreTheServers) {
    FakeServer server;
    const auto report = play(optionsFor(server), R"({"do":"go","arc_mm":80}
{"do":"oblique","ahead_mm":12,"size":[90,70],"png":"ahead.png"}
{"do":"oblique","position_mm":[1,2,3],"forward":[0,2,0],"up":[0,0,1],"cleansed":true,"png":"placed.png"}
{"do":"overview","azimuth_deg":90,"size":[120,100],"png":"left.png"}
{"do":"overview","reader":false,"bookmarks":false,"body":false,"png":"alone.png"}
{"do":"transfer","points":[[-700,1,0,0,0],[-500,1,0,0,0.9]]})");
    ASSERT_FALSE(report.failure) << describe(*report.failure);
    const Centerline path = FakeServer::centerline();
    const auto camera = cameraAtArc(path, rotationMinimizingUps(path, flightPreferredUp), 80.0,
                                    FlightDirection::antegrade);
    int width = 0, height = 0;
    EXPECT_EQ(readPng("ahead.png", width, height),
              tests::syntheticPicture(90, 70, camera.positionMm + 12.0 * camera.forward, 0.0));
    EXPECT_EQ(readPng("placed.png", width, height),
              tests::syntheticPicture(90, 70, {1, 2, 3}, tests::cleansedShiftHu));
    Orbit orbit = orbitOf(path, 1.2);
    EXPECT_EQ(readPng("alone.png", width, height),
              tests::syntheticPicture(120, 100, cameraOf(orbit).positionMm, 0.0));
    orbit.azimuthDegrees = 90.0;
    EXPECT_EQ(readPng("left.png", width, height),
              tests::syntheticPicture(120, 100, cameraOf(orbit).positionMm, camera.positionMm.z));
}

TEST_F(ClientHeadless, AFlyOverMeasuresEachPosition) {
    FakeServer server;
    for (const char* options :
         {R"("pipelined":false)", R"("pipelined":true)", R"("pipelined":false,"endoscopic":true)",
          R"("pipelined":true,"endoscopic":true)"}) {
        const auto report = play(optionsFor(server),
                                 std::string(R"({"do":"flyover","positions":30,)") + options + "}");
        ASSERT_FALSE(report.failure) << describe(*report.failure);
        const ActionReport& over = report.actions.at(0);
        EXPECT_EQ(over.latencyMs.size(), 30u);
        const bool follows = std::string(options).find("endoscopic") != std::string::npos;
        EXPECT_EQ(over.following.has_value(), follows);
        if (follows) {
            EXPECT_GE(*over.following, 28);
        }
    }
}

TEST_F(ClientHeadless, AQuestionThatTheLostLinkSwallowedIsAskedAgain) {
    Misbehaviour wrong;
    wrong.silentAboutTheWall = true;
    FakeServer silent(wrong);
    const auto report = play(optionsFor(silent), R"({"do":"locate","flat":[0.5,1]})");
    ASSERT_TRUE(report.failure);
    EXPECT_NE(report.failure->message.find("the answer about the wall did not come"),
              std::string::npos);

    wrong = {};
    wrong.dropAfterBookmarks = 1;
    FakeServer dropping(wrong);
    auto options = optionsFor(dropping);
    options.pinning.knownServersFile = folder_ / "known-dropping";
    options.reconnect = true;
    Session session(options, "phantom");
    const auto until = [&](const auto& done) {
        const auto deadline = Clock::now() + std::chrono::seconds(20);
        while (!done() && Clock::now() < deadline)
            session.poll(std::chrono::milliseconds(10));
        return done();
    };
    ASSERT_TRUE(until([&] { return session.phase() == Phase::open; }));
    session.addBookmark({}, 0.0, "stored, and then the link breaks");
    const auto request = session.locate(glm::dvec2(0.5, 1.0));
    std::vector<Session::WallAnswer> answers;
    ASSERT_TRUE(until([&] {
        for (auto& answer : session.takeWallAnswers())
            answers.push_back(std::move(answer));
        return !answers.empty();
    }));
    EXPECT_EQ(answers.front().request, request);
    ASSERT_TRUE(answers.front().body);
    EXPECT_EQ(std::get<WallPlace>(*answers.front().body).flat->y, 1.0);
    EXPECT_EQ(dropping.connections(), 2);
}

TEST_F(ClientHeadless, BookmarksAreAcknowledgedAndListed) {
    FakeServer server;
    const auto report = play(optionsFor(server), R"({"do":"go","fraction":0.5}
{"do":"bookmark","note":"flat, 6 mm","count":20}
{"do":"bookmarks","json":"bookmarks.json"})");
    ASSERT_FALSE(report.failure) << describe(*report.failure);
    ASSERT_EQ(report.actions[1].acknowledged.size(), 20u);
    const auto stored = server.storedBookmarkKeys();
    for (std::size_t n = 0; n < stored.size(); ++n)
        EXPECT_EQ(report.actions[1].acknowledged[n].clientKey, stored[n]);
    std::ifstream in(folder_ / "bookmarks.json");
    const auto list = nlohmann::json::parse(in)["bookmarks"];
    ASSERT_EQ(list.size(), 20u);
    EXPECT_EQ(list[3]["note"], "flat, 6 mm");
    EXPECT_NEAR(list[3]["arc_mm"], FakeServer::centerline().lengthMm() / 2, 1e-9);
}

TEST_F(ClientHeadless, ALostAcknowledgementIsAskedForAgainAndNothingIsStoredTwice) {
    Misbehaviour wrong;
    wrong.dropAfterBookmarks = 7;
    FakeServer server(wrong);
    auto options = optionsFor(server);
    options.reconnect = true;
    const auto report = play(options, R"({"do":"bookmark","count":15}
{"do":"still","png":"after.png"})");
    ASSERT_FALSE(report.failure) << describe(*report.failure);
    EXPECT_EQ(report.actions[0].acknowledged.size(), 15u);
    EXPECT_EQ(server.storedBookmarkKeys().size(), 15u);
    EXPECT_EQ(server.bookmarkMessages(), 16);
    EXPECT_EQ(server.connections(), 2);
}

TEST_F(ClientHeadless, WithoutReconnectionALostLinkIsAnErrorThatNamesTheLine) {
    Misbehaviour wrong;
    wrong.dropAfterBookmarks = 2;
    FakeServer server(wrong);
    const auto report = play(optionsFor(server), R"({"do":"wait","ms":1}
{"do":"bookmark","count":5})");
    ASSERT_TRUE(report.failure);
    EXPECT_NE(report.failure->place.find("script:2: bookmark"), std::string::npos)
        << describe(*report.failure);
    EXPECT_EQ(report.actions[1].acknowledged.size(), 1u);
}

TEST_F(ClientHeadless, PinsTheCertificateAndRefusesAnotherOnTheSamePort) {
    std::uint16_t port = 0;
    link::ConnectionOptions options;
    {
        FakeServer server;
        port = server.port();
        options = optionsFor(server);
        const auto first = play(options, "");
        ASSERT_FALSE(first.failure) << describe(*first.failure);
        EXPECT_EQ(first.fingerprint, server.fingerprint());
        EXPECT_FALSE(play(options, "").failure);
    }
    FakeServer impostor({}, port);
    options.reconnect = true;  // must not help
    const auto report = play(options, R"({"do":"still"})");
    ASSERT_TRUE(report.failure);
    EXPECT_NE(report.failure->message.find("CHANGED"), std::string::npos);
    options.pinning.expectedFingerprint = impostor.fingerprint();
    EXPECT_FALSE(play(options, R"({"do":"still"})").failure);
}

TEST_F(ClientHeadless, OpensTheOnlyCaseAndRefusesOneThatIsNotThere) {
    FakeServer server;
    const auto only = play(optionsFor(server), R"({"do":"still"})", "");
    EXPECT_FALSE(only.failure);
    EXPECT_EQ(only.caseName, "phantom");
    const auto missing = play(optionsFor(server), R"({"do":"still"})", "nobody");
    ASSERT_TRUE(missing.failure);
    EXPECT_NE(missing.failure->message.find("no such case"), std::string::npos);
}

TEST_F(ClientHeadless, ServersThatMisbehaveCostOneClearError) {
    const auto failureOf = [&](const Misbehaviour& wrong, const char* script) {
        FakeServer server(wrong);
        auto options = optionsFor(server);
        options.pinning.knownServersFile = folder_ / ("known-" + std::to_string(server.port()));
        const auto report = play(options, script);
        EXPECT_TRUE(report.failure);
        return report.failure ? describe(*report.failure) : std::string();
    };
    Misbehaviour version;
    version.protocolVersion = 9;
    EXPECT_NE(failureOf(version, "").find("protocol version 9"), std::string::npos);
    Misbehaviour welcome;
    welcome.truncateWelcome = true;
    EXPECT_NE(failureOf(welcome, "").find("cannot be read"), std::string::npos);
    Misbehaviour garbage;
    garbage.garbageTiles = true;
    EXPECT_NE(failureOf(garbage, R"({"do":"still"})").find("script:1: still"), std::string::npos);
    EXPECT_NE(failureOf(garbage, R"({"do":"fly","positions":2})").find("script:1: fly"),
              std::string::npos);
    Misbehaviour silent;
    silent.noStills = true;
    EXPECT_NE(failureOf(silent, R"({"do":"still"})").find("did not come within 3 s"),
              std::string::npos);
    const std::string purple = failureOf({}, R"({"do":"transfer","preset":"purple"}
{"do":"still"})");
    EXPECT_NE(purple.find("script:1: transfer"), std::string::npos) << purple;
    EXPECT_NE(purple.find("no such transfer function"), std::string::npos) << purple;
    EXPECT_NE(failureOf({}, R"({"do":"window","viewport":3,"center_hu":1,"width_hu":2})")
                  .find("shows nothing yet"),
              std::string::npos);
}

TEST_F(ClientHeadless, NobodyListeningIsAnErrorAtOnce) {
    std::uint16_t port = 0;
    {
        FakeServer server;
        port = server.port();
    }
    link::ConnectionOptions options;
    options.address = {"127.0.0.1", port};
    options.pinning.knownServersFile = folder_ / "known_servers";
    const auto report = play(options, "");
    ASSERT_TRUE(report.failure);
    EXPECT_NE(
        describe(*report.failure).find("127.0.0.1:" + std::to_string(port) + ": cannot connect"),
        std::string::npos)
        << describe(*report.failure);
}

}  // namespace
}  // namespace haustra::reader
