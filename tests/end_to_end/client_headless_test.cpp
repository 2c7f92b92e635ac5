// The client's session and scripts against a server on the loopback: exact stills, latencies,
// pinning, refusals, lost links.
#include "end_to_end/fake_server.h"
#include "panels/script_player.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <png.h>
#include <unistd.h>

namespace haustra::panels {
namespace {

using tests::FakeServer;
using tests::Misbehaviour;

class ClientHeadless : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("haustra-client-" + std::string(info->name()) + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

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
        return panels::play(session, *actions, options);
    }
    std::vector<std::uint8_t> readPng(const std::string& name, int& width, int& height) const {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        EXPECT_TRUE(png_image_begin_read_from_file(&image, (folder_ / name).c_str()));
        image.format = PNG_FORMAT_RGB;
        std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
        EXPECT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr));
        width = int(image.width);
        height = int(image.height);
        return rgb;
    }

    std::filesystem::path folder_;
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
}  // namespace haustra::panels
