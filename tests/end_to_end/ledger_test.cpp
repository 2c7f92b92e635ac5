// What readers have seen: a scripted reading through the real server, against the client's own log
// of it and rays of this file's own; and that nothing that is kept is lost.
#include "core/missed_patches.h"
#include "core/triangle_tree.h"
#include "end_to_end/flat_store.h"
#include "end_to_end/server_test_client.h"
#include "protocol/limits.h"
#include "records/seen_walls.h"
#include "script/script_player.h"

#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>

namespace haustra::tests {
namespace {

using nlohmann::json;
using Flags = std::vector<std::uint8_t>;

/// A headless client's session with a server.
class Reading {
public:
    Reading(std::uint16_t port, const std::string& reader, const std::string& caseName = "tube") {
        link::ConnectionOptions options;
        options.address = {"127.0.0.1", port};
        options.pinning.knownServersFile = folder_.path() / "known";
        options.reader = reader;
        session_ = std::make_unique<reader::Session>(options, caseName);
    }
    reader::Session& session() { return *session_; }

    reader::PlayReport playToItsEnd(const std::string& script) {
        std::istringstream in(script);
        const auto actions = reader::parseScript(in, "script");
        if (!actions) throw std::runtime_error(describe(actions.error()));
        reader::PlayOptions options;
        options.outFolder = folder_.path();
        options.scriptName = "script";
        options.width = options.height = 96;
        return reader::play(*session_, *actions, options);
    }
    /// Plays a script, which must go well.
    reader::PlayReport play(const std::string& script) {
        auto report = playToItsEnd(script);
        if (report.failure) throw std::runtime_error(describe(*report.failure));
        return report;
    }
    json written(const std::string& file) {
        return json::parse(fileContent(folder_.path() / file));
    }
    /// What the server has now, all of it on its disk.
    json ledger() {
        play(R"({"do":"ledger","json":"ledger.json"})");
        return written("ledger.json");
    }

private:
    TemporaryFolder folder_;
    std::unique_ptr<reader::Session> session_;
};

Flags flagsOf(const json& runs, std::size_t count) {
    Flags flags(count, 0);
    for (const auto& run : runs)
        std::fill_n(flags.begin() + run[0].get<std::ptrdiff_t>(), run[1].get<std::size_t>(), 1);
    return flags;
}
Flags shownBy(const json& ledger) {
    return flagsOf(ledger["shown"], ledger["triangles"].get<std::size_t>());
}
std::size_t countOf(const Flags& flags) {
    return std::size_t(std::count(flags.begin(), flags.end(), 1));
}
glm::dvec3 vector(const json& list) {
    return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

/// PROTOCOL.md's rule of what pictures show, by rays of its own: in double precision, through a
/// tree of boxes instead of Embree's. What lies within rounding of a bound counts at its most
/// generous where `slack` is over 0, at its strictest where it is under.
class OwnLog {
public:
    explicit OwnLog(const FlatMap& map)
        : map_(map), tree_(map.surface.vertices, map.surface.triangles) {}

    /// µs on screen of each triangle.
    std::vector<std::int64_t> times(const json& pictures, double pixelsPerMm, double slack) const {
        std::vector<std::int64_t> times(map_.surface.triangles.size(), 0);
        for (const json& picture : pictures) {
            if (picture["optics"] == "translucent") continue;
            const std::int64_t width = picture["size"][0], height = picture["size"][1];
            std::int64_t time = 1000 * picture["ms"].get<std::int64_t>();
            if (picture["view"] != "endoscopic")
                time = time * 35'000 / std::max<std::int64_t>(width * height, 35'000);
            for (std::size_t t = 0; t < times.size(); ++t)
                if (picture["view"] == "endoscopic"
                        ? cameraShows(t, picture["camera"], width, height, pixelsPerMm, slack)
                        : windowShows(t, picture, width, height, pixelsPerMm, slack))
                    times[t] += time;
        }
        return times;
    }

private:
    glm::dvec3 corner(std::size_t t, int n) const {
        return map_.surface.vertices[std::size_t(map_.surface.triangles[t][n])];
    }
    glm::dvec2 flat(std::size_t t, int n) const {
        return map_.flat[std::size_t(map_.surface.triangles[t][n])];
    }
    bool cameraShows(std::size_t t, const json& camera, std::int64_t width, std::int64_t height,
                     double pixelsPerMm, double slack) const {
        const glm::dvec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
        const glm::dvec3 middle = (a + b + c) / 3.0,
                         inward = glm::normalize(glm::cross(c - a, b - a));
        const glm::dvec3 eye = vector(camera["position_mm"]),
                         forward = glm::normalize(vector(camera["forward"])),
                         right = glm::normalize(glm::cross(forward, vector(camera["up"]))),
                         down = glm::cross(forward, right);
        const glm::dvec3 way = middle - eye;
        const double distance = glm::length(way), depth = glm::dot(way, forward);
        const double half = std::tan(glm::radians(0.5 * camera["fov_deg"].get<double>()));
        const double wide = half * double(width) / double(height);
        return depth > 0.0 && distance > 3.0 - slack && distance < 100.0 + slack &&
               pixelsPerMm * distance * 2.0 * half / double(height) < 1.0 + slack &&
               -glm::dot(way, inward) / distance > std::cos(glm::radians(75.0)) - slack &&
               std::abs(glm::dot(way, right)) / depth < wide + slack &&
               std::abs(glm::dot(way, down)) / depth < half + slack &&
               !isHidden(eye, middle, distance - 0.3, slack);
    }
    // By triangles that the ray meets before the place, and no nearer to their rims than `slack`.
    bool isHidden(glm::dvec3 eye, glm::dvec3 place, double lengthMm, double slack) const {
        const glm::dvec3 along = glm::normalize(place - eye);
        bool hidden = false;
        tree_.forEach(
            [&](const TriangleTree::Box& box) {
                double near = 0.0, far = lengthMm + 1.0;
                for (int axis = 0; axis < 3; ++axis) {
                    const double low = (box.low[axis] - 1e-3 - eye[axis]) / along[axis],
                                 high = (box.high[axis] + 1e-3 - eye[axis]) / along[axis];
                    near = std::max(near, std::min(low, high));
                    far = std::min(far, std::max(low, high));
                }
                return !hidden && near <= far;
            },
            [&](std::int32_t t) {
                const glm::dvec3 a = corner(std::size_t(t), 0), ab = corner(std::size_t(t), 1) - a,
                                 ac = corner(std::size_t(t), 2) - a;
                const glm::dvec3 p = glm::cross(along, ac);
                const double det = glm::dot(ab, p);
                if (std::abs(det) < 1e-12) return;
                const glm::dvec3 fromA = eye - a, q = glm::cross(fromA, ab);
                const double u = glm::dot(fromA, p) / det, v = glm::dot(along, q) / det,
                             at = glm::dot(ac, q) / det;
                hidden |= u > slack && v > slack && u + v < 1.0 - slack && at > 0.0 &&
                          at < lengthMm - slack;
            });
        return hidden;
    }
    bool windowShows(std::size_t t, const json& picture, std::int64_t width, std::int64_t height,
                     double pixelsPerMm, double slack) const {
        const double pixels = picture["pixels_per_circumference"];
        const glm::dvec2 middle = (flat(t, 0) + flat(t, 1) + flat(t, 2)) / 3.0;
        glm::dvec2 aside =
            middle - glm::dvec2(picture["center"][0].get<double>(), picture["center"][1]);
        aside.x -= std::round(aside.x);
        // How long the shortest image of a millimetre is, by all directions.
        const glm::dvec3 ab = corner(t, 1) - corner(t, 0), ac = corner(t, 2) - corner(t, 0);
        const glm::dvec2 fab = flat(t, 1) - flat(t, 0), fac = flat(t, 2) - flat(t, 0);
        double least = 1e9;
        for (int n = 0; n < 720; ++n) {
            const double turn = n * std::numbers::pi / 720.0, x = std::cos(turn),
                         y = std::sin(turn);
            least = std::min(least, glm::length(x * fab + y * fac) / glm::length(x * ab + y * ac));
        }
        return pixels * std::abs(aside.x) < 0.5 * double(width) + slack &&
               pixels * std::abs(aside.y) < 0.5 * double(height) + slack &&
               pixels * least > pixelsPerMm * (1.0 - 10.0 * slack);
    }

    const FlatMap& map_;
    TriangleTree tree_;
};

class LedgerTest : public FlatServer {};

// The client's own log, triangle for triangle.
TEST_F(LedgerTest, IsWhatTheClientHadOnScreen) {
    Reading reading(server_->port(), "scripted");
    reading.play(R"({"do":"seen-limits","pixels_per_mm":3,"least_ms":150}
        {"do":"go","arc_mm":6}
        {"do":"fly","from_mm":6,"to_mm":30,"positions":5,"hold_ms":90}
        {"do":"go","arc_mm":28,"direction":"retrograde","yaw_deg":40,"pitch_deg":-20}
        {"do":"still","hold_ms":160}
        {"do":"go","lens":"perspective","fov_deg":60,"direction":"antegrade","yaw_deg":0,"pitch_deg":70}
        {"do":"still","hold_ms":200}
        {"do":"flat","center":[0.05,0.55],"pixels_per_circumference":300,"size":[160,120],"hold_ms":170}
        {"do":"flat","center":[0.5,0.3],"pixels_per_circumference":400,"size":[500,280],"hold_ms":400}
        {"do":"transfer","preset":"translucent"}
        {"do":"go","arc_mm":50,"pitch_deg":0}
        {"do":"still","hold_ms":300}
        {"do":"ledger","json":"scripted.json"})");
    const json ledger = reading.written("scripted.json");
    EXPECT_GE(ledger["pictures"].size(), 10u);
    EXPECT_TRUE(ledger["recorded"].get<bool>());
    const FlatMap map = tube().map();
    ASSERT_EQ(ledger["triangles"], map.surface.triangles.size());
    const Flags shown = shownBy(ledger);
    const OwnLog own(map);
    const auto strict = own.times(ledger["pictures"], 3.0, -1e-4),
               generous = own.times(ledger["pictures"], 3.0, 1e-4);
    std::size_t seen = 0, unseen = 0, within = 0;
    for (std::size_t t = 0; t < shown.size(); ++t) {
        const bool surely = strict[t] >= 150'000, perhaps = generous[t] >= 150'000;
        if (surely != perhaps)
            ++within;
        else
            ASSERT_EQ(bool(shown[t]), surely) << "triangle " << t << ", " << strict[t] << " us";
        ++(shown[t] ? seen : unseen);
    }
    EXPECT_GT(seen, shown.size() / 10);
    EXPECT_GT(unseen, shown.size() / 10);
    EXPECT_LT(within, shown.size() / 200) << "within rounding of a bound";
    std::cout << seen << " triangles seen, " << unseen << " not, " << within
              << " within rounding of a bound\n";
    // Singles, and the share of the area.
    const auto counted = withoutSingles(neighboursOf(map.surface), shown);
    EXPECT_EQ(flagsOf(ledger["seen"], shown.size()), counted);
    double all = 0.0, area = 0.0;
    for (std::size_t t = 0; t < shown.size(); ++t) {
        const auto vertex = [&](int n) {
            return map.surface.vertices[std::size_t(map.surface.triangles[t][n])];
        };
        const double mm2 =
            0.5 * glm::length(glm::cross(vertex(1) - vertex(0), vertex(2) - vertex(0)));
        all += mm2;
        area += counted[t] ? mm2 : 0.0;
    }
    EXPECT_NEAR(ledger["seen_share"].get<double>(), area / all, 1e-5);
}

TEST_F(LedgerTest, GoesOnInTheReadersNextSession) {
    Flags before;
    {
        Reading reading(server_->port(), "twice");
        reading.play(R"({"do":"go","arc_mm":10}
            {"do":"still","hold_ms":400})");
        before = shownBy(reading.ledger());
        EXPECT_GT(countOf(before), 100u);
    }
    {
        Reading another(server_->port(), "another");
        EXPECT_EQ(countOf(shownBy(another.ledger())), 0u) << "each reader has another";
        Reading nobody(server_->port(), "");
        const json ledger = nobody.ledger();
        EXPECT_EQ(countOf(shownBy(ledger)), 0u);
        EXPECT_FALSE(ledger["recorded"].get<bool>());
    }
    Reading reading(server_->port(), "twice");
    EXPECT_EQ(shownBy(reading.ledger()), before);
    // Another choice is another ledger; the first is there again.
    reading.play(R"({"do":"seen-limits","pixels_per_mm":2,"least_ms":0})");
    EXPECT_EQ(countOf(shownBy(reading.ledger())), 0u);
    reading.play(R"({"do":"seen-limits"})");
    EXPECT_EQ(shownBy(reading.ledger()), before);
    reading.play(R"({"do":"go","arc_mm":40}
        {"do":"still","hold_ms":400})");
    const Flags after = shownBy(reading.ledger());
    EXPECT_GT(countOf(after), countOf(before));
    for (std::size_t t = 0; t < before.size(); ++t)
        EXPECT_LE(before[t], after[t]);
    // But for what is on screen still.
    reading.play(R"({"do":"seen","forget":true})");
    const Flags forgotten = shownBy(reading.ledger());
    Reading again(server_->port(), "twice");
    EXPECT_EQ(shownBy(again.ledger()), forgotten);
    EXPECT_LT(countOf(forgotten), countOf(after));
    std::size_t ofBefore = 0;
    for (std::size_t t = 0; t < before.size(); ++t)
        ofBefore += before[t] && forgotten[t];
    EXPECT_LT(ofBefore, countOf(before));
}

TEST_F(LedgerTest, TwoWindowsOfOneReaderHaveOne) {
    Reading one(server_->port(), "both"), two(server_->port(), "both");
    one.play(R"({"do":"go","arc_mm":10}
        {"do":"still","hold_ms":400})");
    two.play(R"({"do":"go","arc_mm":40}
        {"do":"still","hold_ms":400})");
    const Flags both = shownBy(two.ledger());
    EXPECT_EQ(shownBy(one.ledger()), both);
    EXPECT_GT(countOf(both), 200u);
}

TEST_F(LedgerTest, MissedPatchesAreVisitedUntilNoneIsLeft) {
    Reading reading(server_->port(), "reviewer");
    const auto first = reading
                           .play(R"({"do":"seen-limits","pixels_per_mm":0.5,"least_ms":0}
        {"do":"fly","positions":12}
        {"do":"missed","least_mm2":100})")
                           .actions.back()
                           .missed.value();
    double sum = 0.0, before = 1e9;
    ASSERT_FALSE(first.patches.empty());
    for (const reader::MissedPlace& patch : first.patches) {
        EXPECT_LE(patch.areaMm2, before);
        before = patch.areaMm2;
        sum += patch.areaMm2;
        EXPECT_TRUE(patch.view);
    }
    EXPECT_NEAR(sum, first.areaMm2, 1e-6);
    ASSERT_GT(first.patches.front().areaMm2, leastMissedMm2);
    // Each visit shows something of its patch, until there is none.
    std::string visits;
    for (int n = 0; n < 60; ++n)
        visits += R"({"do":"next-missed"}
            {"do":"still"}
            {"do":"wait","ms":20}
            {"do":"seen"})"
                  "\n";
    const auto visited = reading.playToItsEnd(visits);
    ASSERT_TRUE(visited.failure);
    EXPECT_EQ(visited.failure->message, "no patch of 300 mm2 or more is left there");
    double share = first.share;
    for (const reader::ActionReport& action : visited.actions) {
        if (!action.seenShare) continue;
        EXPECT_GT(*action.seenShare, share);
        share = *action.seenShare;
    }
    EXPECT_GT(share, first.share + 0.02);
    EXPECT_EQ(reading.play(R"({"do":"missed"})").actions.back().missed->count, 0);
    // The report has each reader with limits, share and patches.
    const auto report =
        reading.play(R"({"do":"seen-report","least_mm2":10})").actions.back().seenReport.value();
    const auto own = std::find_if(report.readers.begin(), report.readers.end(),
                                  [](const reader::ReaderSeen& one) {
                                      return one.reader == "reviewer" && one.limits.leastMs == 0;
                                  });
    ASSERT_NE(own, report.readers.end());
    EXPECT_NEAR(own->share, share, 1e-9);
    EXPECT_EQ(own->limits.pixelsPerMm, 0.5);
    EXPECT_EQ(own->missed.leastMm2, 10.0);
    EXPECT_EQ(report.wall.size(), 64u);
    Reading nobody(server_->port(), "");
    const auto others = nobody.play(R"({"do":"seen-report"})").actions.back().seenReport.value();
    EXPECT_EQ(others.readers.front().reader, "");
    EXPECT_EQ(others.readers.front().share, 0.0);
    // Whoever knows a name may go on under it.
    ASSERT_GE(others.readers.size(), 2u);
    for (std::size_t n = 1; n < others.readers.size(); ++n) {
        EXPECT_EQ(others.readers[n].reader.substr(0, 7), "sha256:");
        EXPECT_EQ(others.readers[n].reader.size(), 7u + 16u);
    }
}

TEST_F(LedgerTest, ACaseThatIsMadeAnewInheritsNothingThatIsNotItsOwn) {
    const TemporaryFolder folder;
    makeFlatStore(folder.path(), tube());
    const ServerProcess server(folder.path());
    const auto publish = [&](const FlatMap& map, const char* key) {
        auto store = store::CaseStore::open(folder.path(), false);
        auto opened = store->createCase(smallCaseName);
        ASSERT_TRUE(opened->publishFlatMap("flatmap", store::makeKey(key, 1, "", {}), map));
    };
    const auto ledgerNow = [&] { return Reading(server.port(), "ada").ledger(); };
    {
        Reading reading(server.port(), "ada");
        reading.play(R"({"do":"go","arc_mm":10}
            {"do":"still","hold_ms":400})");
    }
    const json first = ledgerNow();
    EXPECT_GT(countOf(shownBy(first)), 100u);
    // As many triangles, elsewhere.
    publish(FlatTube({.foldMm = 2.5}).map(), "another wall");
    const json second = ledgerNow();
    EXPECT_NE(second["wall"], first["wall"]);
    EXPECT_EQ(countOf(shownBy(second)), 0u);
    publish(tube().map(), "the first wall, by another key");
    EXPECT_EQ(shownBy(ledgerNow()), shownBy(first));
}

// Whatever the server has told to be kept is there after a kill -9.
TEST(LedgerKill, WhatWasToldToBeKeptSurvives) {
    const TemporaryFolder folder;
    makeFlatStore(folder.path(), FlatTube());
    Flags before;
    double shareBefore = 0.0;
    for (const int round : {0, 1, 2}) {
        auto server = std::make_unique<ServerProcess>(folder.path());
        Reading reading(server->port(), "ada");
        const Flags now = shownBy(reading.ledger());
        if (round > 0) {
            for (std::size_t t = 0; t < before.size(); ++t)
                ASSERT_LE(before[t], now[t]) << "triangle " << t << " was kept, and is lost";
            EXPECT_GE(*reading.session().seenShare(), shareBefore - 1e-9);
        }
        // Kept, by the server's word; then more, which is not, when it dies.
        const std::string from = std::to_string(5 + 15 * round),
                          to = std::to_string(20 + 15 * round);
        reading.play(R"({"do":"fly","from_mm":)" + from + R"(,"to_mm":)" + to +
                     R"(,"positions":6,"hold_ms":330})");
        before = shownBy(reading.ledger());
        shareBefore = *reading.session().seenShare();
        EXPECT_GT(countOf(before), countOf(now));
        reader::Session& session = reading.session();
        session.look(0, Camera{{0.0, 0.0, 10.0}, {0.0, 1.0, 0.1}, {1.0, 0.0, 0.0}}, false);
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(700);
        while (std::chrono::steady_clock::now() < end) {
            session.poll(std::chrono::milliseconds(20));
            for (const link::PictureDone& arrival : session.takePictures())
                session.onScreen(arrival.picture);
            if (session.seenShare()) shareBefore = std::max(shareBefore, *session.seenShare());
        }
        server->kill();
    }
    ServerProcess server(folder.path());
    Reading reading(server.port(), "ada");
    const Flags now = shownBy(reading.ledger());
    for (std::size_t t = 0; t < before.size(); ++t)
        ASSERT_LE(before[t], now[t]);
    EXPECT_GE(*reading.session().seenShare(), shareBefore - 1e-9);
}

// ---- what a client may not say ------------------------------------------------------------------

class LedgerWords : public FlatServer {
protected:
    static std::unique_ptr<TestClient> opened(const std::string& reader = "words",
                                              std::uint16_t port = server_->port()) {
        auto client = std::make_unique<TestClient>(port);
        protocol::ClientMessage hello;
        hello.mutable_hello()->set_protocol_version(protocol::protocolVersion);
        for (const char* name : {"jpeg", "lossless", "ledger"})
            hello.mutable_hello()->add_capabilities(name);
        hello.mutable_hello()->set_reader(reader);
        client->send(hello);
        const auto welcome = client->answer();
        if (!welcome || !welcome->has_welcome()) return nullptr;
        const auto& can = welcome->welcome().capabilities();
        EXPECT_NE(std::find(can.begin(), can.end(), "ledger"), can.end());
        EXPECT_TRUE(client->openCase(smallCaseName)->has_case_opened());
        return client;
    }
    static protocol::ClientMessage shown(std::uint64_t number, std::uint32_t picture,
                                         std::uint32_t ms) {
        protocol::ClientMessage message;
        message.mutable_tell_shown()->set_number(number);
        auto* one = message.mutable_tell_shown()->add_pictures();
        one->set_picture(picture);
        one->set_ms(ms);
        return message;
    }
    /// The first answer that is such a one, passing over others.
    template <class Is>
    static protocol::ServerMessage awaited(TestClient& client, const Is& is) {
        for (auto answer = client.answer(); answer; answer = client.answer())
            if (is(*answer)) return *answer;
        throw std::runtime_error("the server did not answer");
    }
    static protocol::WallSeen seen(TestClient& client) {
        protocol::ClientMessage ask;
        ask.mutable_ask_seen()->set_request(77);
        client.send(ask);
        return awaited(client,
                       [](const auto& answer) {
                           return answer.has_wall_seen() && answer.wall_seen().request() == 77;
                       })
            .wall_seen();
    }
    static double share(TestClient& client) { return seen(client).share(); }
    /// The number of an endoscopic picture at so many mm along the tube, which has been sent.
    static std::uint32_t pictureAt(TestClient& client, double mm) {
        client.viewport(std::uint64_t(2.0 * mm), 0, protocol::ENDOSCOPIC, 96, 96);
        client.camera(std::uint64_t(2.0 * mm) + 1, 0, {0, 0, mm}, false);
        for (auto picture = client.picture(); picture; picture = client.picture())
            if (picture->header.sequence == std::uint64_t(2.0 * mm) + 1)
                return picture->header.picture;
        throw std::runtime_error("there is no picture");
    }
    static std::string wallOf(TestClient& client) {
        protocol::ClientMessage ask;
        ask.mutable_ask_ledger()->set_request(78);
        client.send(ask);
        return awaited(client, [](const auto& answer) { return answer.has_ledger(); })
            .ledger()
            .wall();
    }
};

TEST_F(LedgerWords, OnlyWhatHasBeenSentCanHaveBeenOnScreen) {
    auto client = opened();
    ASSERT_TRUE(client);
    client->viewport(1, 0, protocol::ENDOSCOPIC, 96, 96);
    client->camera(2, 0, {0, 0, 10}, false);
    const auto picture = client->picture();
    ASSERT_TRUE(picture);
    EXPECT_EQ(share(*client), 0.0) << "what was sent has not been on screen yet";
    const std::uint32_t number = picture->header.picture;
    const auto refused = [&](const protocol::ClientMessage& message) {
        client->send(message);
        auto answer = client->answer();
        while (answer && answer->has_wall_seen() && answer->wall_seen().request() == 0)
            answer = client->answer();
        return answer && answer->has_error() && !answer->error().fatal() &&
               answer->error().code() == protocol::ErrorReport::BAD_VALUE;
    };
    EXPECT_TRUE(refused(shown(1, number + 1, 100)));
    EXPECT_TRUE(refused(shown(1, 0, 100)));
    EXPECT_TRUE(refused(shown(1, number, 0)));
    EXPECT_TRUE(refused(shown(1, number, 60'001)));
    EXPECT_TRUE(refused(shown(0, number, 100)));
    auto many = shown(1, number, 1);
    for (int n = 0; n < 256; ++n)
        *many.mutable_tell_shown()->add_pictures() = many.tell_shown().pictures(0);
    EXPECT_TRUE(refused(many));
    EXPECT_EQ(share(*client), 0.0) << "what is refused changes nothing";
    client->send(shown(1, number, 299));
    EXPECT_EQ(share(*client), 0.0);
    EXPECT_TRUE(refused(shown(1, number, 1))) << "the number does not grow";
    client->send(shown(2, number, 1));
    const double after = share(*client);
    EXPECT_GT(after, 0.01);
    protocol::ClientMessage limits;
    limits.mutable_set_seen_limits()->set_request(5);
    for (const auto& [pixels, ms] : {std::pair{0.001, 300u},
                                     {1e9, 300u},
                                     {-1.0, 300u},
                                     {std::nan(""), 300u},
                                     {1.0, 60'001u}}) {
        limits.mutable_set_seen_limits()->mutable_limits()->set_pixels_per_mm(pixels);
        limits.mutable_set_seen_limits()->mutable_limits()->set_least_ms(ms);
        EXPECT_TRUE(refused(limits)) << pixels << " " << ms;
    }
    protocol::ClientMessage list;
    for (const double least : {0.5, 1e7, -3.0, std::nan("")}) {
        list.mutable_list_missed()->set_least_mm2(least);
        EXPECT_TRUE(refused(list)) << least;
    }
    EXPECT_EQ(share(*client), after);
}

TEST_F(LedgerWords, WhatHasNoRoomIsNeverToldAsKept) {
    const TemporaryFolder folder;
    makeFlatStore(folder.path(), tube());
    const ServerProcess server(folder.path());
    auto client = opened("latecomer", server.port());
    ASSERT_TRUE(client);
    const std::string wall = wallOf(*client);
    std::vector<records::Ledger> others;
    for (int n = 0; n < protocol::maxWallLedgers; ++n)
        others.push_back({{"reader " + std::to_string(n), wall, {}}, "a case", "a scan", {1}});
    ASSERT_TRUE(records::SeenStore::open(folder.path() / "records.sqlite3")->keep(others));

    const std::uint32_t picture = pictureAt(*client, 10.0);
    client->send(shown(1, picture, 1000));
    const auto refused = awaited(*client, [](const auto& answer) { return answer.has_error(); });
    EXPECT_EQ(refused.error().code(), protocol::ErrorReport::BAD_VALUE);
    client->send(shown(2, picture, 1000));
    const auto taken = awaited(*client, [](const auto& answer) {
        return answer.has_wall_seen() && answer.wall_seen().request() == 0;
    });
    EXPECT_FALSE(taken.wall_seen().recorded());
    EXPECT_EQ(taken.wall_seen().kept(), 0u);
    // By other limits nothing has been seen yet that would have to be kept.
    protocol::ClientMessage limits;
    limits.mutable_set_seen_limits()->set_request(5);
    limits.mutable_set_seen_limits()->mutable_limits()->set_pixels_per_mm(50.0);
    client->send(limits);
    const auto byOthers = awaited(*client, [](const auto& answer) {
        return answer.has_wall_seen() && answer.wall_seen().request() == 5;
    });
    EXPECT_TRUE(byOthers.wall_seen().recorded());
    EXPECT_EQ(byOthers.wall_seen().kept(), 0u);
    client->send(shown(3, picture, 1));
    const auto told = awaited(*client, [](const auto& answer) {
        return answer.has_wall_seen() && answer.wall_seen().request() == 0 &&
               answer.wall_seen().limits().pixels_per_mm() == 50.0;
    });
    EXPECT_TRUE(told.wall_seen().recorded());
    EXPECT_EQ(told.wall_seen().kept(), 3u) << "what was lost was told, and holds nothing up";
}

// The last writing of a case that is left fails: later numbers wait for it, until another case has
// been left as well.
TEST_F(LedgerWords, WhatALeftCaseWasToldIsWaitedFor) {
    for (const bool leavesAnother : {false, true}) {
        const TemporaryFolder folder;
        makeFlatStore(folder.path(), tube());
        const ServerProcess server(folder.path());
        const auto records = folder.path() / "records.sqlite3";
        auto client = opened("leaver", server.port());
        ASSERT_TRUE(client);
        const std::string wall = wallOf(*client);
        sqlite3* database = nullptr;
        ASSERT_EQ(sqlite3_open(records.c_str(), &database), SQLITE_OK);
        const std::unique_ptr<sqlite3, int (*)(sqlite3*)> closed(database, sqlite3_close);
        const auto run = [&](const char* sql) {
            ASSERT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
        };
        run("BEGIN IMMEDIATE");
        client->send(shown(1, pictureAt(*client, 10.0), 60'000));
        EXPECT_GT(share(*client), 0.0);
        // The lock may outlast SQLite's patience before the case is open, or after.
        bool isOpen = false, hasFailed = false;
        const auto first = client->openCase(leavesAnother ? "scan" : smallCaseName);
        const auto take = [&](const protocol::ServerMessage& answer) {
            isOpen |= answer.has_case_opened();
            hasFailed |= answer.has_error();
            if (answer.has_error()) {
                EXPECT_EQ(answer.error().code(), protocol::ErrorReport::INTERNAL);
            }
            return isOpen && hasFailed;
        };
        ASSERT_TRUE(first);
        if (!take(*first)) awaited(*client, take);
        ASSERT_TRUE(isOpen && hasFailed);
        if (leavesAnother) {
            ASSERT_TRUE(client->openCase(smallCaseName)->has_case_opened());
        }
        client->send(shown(2, pictureAt(*client, 40.0), 60'000));
        EXPECT_EQ(seen(*client).kept(), 0u);
        run("ROLLBACK");
        const auto told = awaited(*client, [](const auto& answer) {
            return answer.has_wall_seen() && answer.wall_seen().kept() == 2;
        });
        EXPECT_TRUE(told.wall_seen().recorded());
        // What it says has been seen is on the disk.
        const auto kept = records::SeenStore::open(records)->find({"leaver", wall, {}}).value();
        ASSERT_TRUE(kept);
        const auto shownLong = std::count_if(kept->times.begin(), kept->times.end(),
                                             [](auto time) { return time >= 300'000; });
        EXPECT_NEAR(double(shownLong) / double(kept->times.size()), told.wall_seen().share(), 0.05);
    }
}

TEST_F(LedgerWords, AReadersNameHasItsBounds) {
    for (const std::string& name : {std::string(65, 'a'), std::string("a b"), std::string("\x01")})
        EXPECT_FALSE(opened(name)) << name;
    EXPECT_TRUE(opened(std::string(64, 'a')));
}

}  // namespace
}  // namespace haustra::tests
