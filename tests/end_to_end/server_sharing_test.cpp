// What sessions of the real haustra-server learn of each other: who reads which case, and
// bookmarks as they are added.
#include "end_to_end/flat_store.h"
#include "end_to_end/server_test_client.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using protocol::ClientMessage;
using protocol::ServerMessage;

class ServerSharing : public FlatServer {
protected:
    static std::unique_ptr<TestClient> reader(const std::string& name) {
        auto client = std::make_unique<TestClient>(server_->port());
        EXPECT_TRUE(client->hello()->has_welcome());
        if (!name.empty()) {
            const auto opened = client->openCase(name);
            EXPECT_TRUE(opened && opened->has_case_opened());
        }
        return client;
    }
    static protocol::CaseList listed(TestClient& client, std::uint64_t request) {
        ClientMessage message;
        message.mutable_list_cases()->set_request(request);
        client.send(message);
        for (;;) {
            const auto answer = client.answer();
            if (!answer) throw std::runtime_error("no list came");
            if (!answer->has_case_list()) continue;
            EXPECT_EQ(answer->case_list().request(), request);
            return answer->case_list();
        }
    }
    static protocol::CaseEntry entry(const protocol::CaseList& list, const std::string& name) {
        for (const auto& one : list.entries())
            if (one.name() == name) return one;
        ADD_FAILURE() << "no entry " << name;
        return {};
    }
    /// A reader that has gone is noticed when its socket is.
    static bool readersBecome(TestClient& client, const std::string& name, std::uint32_t count) {
        for (int n = 0; n < 500; ++n) {
            if (entry(listed(client, std::uint64_t(n + 1)), name).readers() == count) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
};

/// A bookmark that stands at (0, 0, 10) and looks at a place.
ClientMessage lookingAt(std::uint64_t request, const std::string& key, glm::dvec3 place) {
    ClientMessage message = TestClient::bookmark(request, key, "a finding");
    auto* body = message.mutable_add_bookmark();
    TestClient::set(body->mutable_position_mm(), {0, 0, 10.0});
    TestClient::set(body->mutable_forward(), {place.x, place.y, place.z - 10.0});
    TestClient::set(body->mutable_up(), {place.y, -place.x, 0.0});
    return message;
}

class ServerBookmarks : public ServerSharing {
protected:
    /// Takes others' bookmarks unless told not to.
    static std::unique_ptr<TestClient> taker(const std::string& name, bool takes = true) {
        auto client = std::make_unique<TestClient>(server_->port());
        std::vector<std::string> capabilities{"jpeg", "lossless"};
        if (takes) capabilities.push_back("bookmark-push");
        const auto welcome = client->hello(1, capabilities);
        EXPECT_TRUE(welcome && welcome->has_welcome());
        const auto opened = client->openCase(name);
        EXPECT_TRUE(opened && opened->has_case_opened());
        return client;
    }
    static protocol::BookmarkAdded added(TestClient& client) {
        for (;;) {
            const auto answer = client.answer();
            if (!answer || answer->has_error()) throw std::runtime_error("no bookmark came");
            if (answer->has_bookmark_added()) return answer->bookmark_added();
        }
    }
    static std::vector<protocol::Bookmark> list(TestClient& client) {
        ClientMessage message;
        message.mutable_list_bookmarks()->set_request(77);
        client.send(message);
        for (;;) {
            const auto answer = client.answer();
            if (!answer) throw std::runtime_error("no list came");
            if (answer->has_bookmark_list())
                return {answer->bookmark_list().bookmarks().begin(),
                        answer->bookmark_list().bookmarks().end()};
        }
    }
    /// What comes before the answer to a ping.
    static int addedBeforePong(TestClient& client) {
        ClientMessage ping;
        ping.mutable_ping()->set_request(5);
        client.send(ping);
        int count = 0;
        for (;;) {
            const auto answer = client.answer();
            if (!answer) throw std::runtime_error("no answer came");
            if (answer->has_pong()) return count;
            count += answer->has_bookmark_added();
        }
    }
    static glm::dvec3 vector(const protocol::Vec3& v) { return {v.x(), v.y(), v.z()}; }
};

TEST_F(ServerBookmarks, AppearInAllSessionsOfTheScanThatTakeThem) {
    const auto adder = taker(smallCaseName), other = taker(smallCaseName),
               deaf = taker(smallCaseName, false), elsewhere = taker("scan");
    const std::size_t before = list(*other).size();
    for (int n = 0; n < 5; ++n) {
        const std::string key = "push-" + std::to_string(n);
        adder->send(lookingAt(std::uint64_t(n + 1), key, tube().positionMm({0.1 * n, 0.4})));
        const auto pushed = added(*other);
        EXPECT_EQ(pushed.request(), 0u);
        EXPECT_EQ(pushed.bookmark().client_key(), key);
        // It has been committed: whoever asks now finds it, as it was pushed.
        const auto stored = list(*deaf);
        ASSERT_EQ(stored.size(), before + std::size_t(n) + 1);
        EXPECT_EQ(stored.back().SerializeAsString(), pushed.bookmark().SerializeAsString());
        // Who has added it is told once, as ever.
        const auto own = added(*adder);
        EXPECT_EQ(own.request(), std::uint64_t(n + 1));
        EXPECT_EQ(own.bookmark().SerializeAsString(), pushed.bookmark().SerializeAsString());
    }
    // Once more: the same bookmark, which the others know.
    adder->send(lookingAt(9, "push-3", {1, 1, 30}));
    EXPECT_EQ(added(*adder).request(), 9u);
    EXPECT_EQ(addedBeforePong(*other), 0);
    EXPECT_EQ(addedBeforePong(*adder), 0);
    EXPECT_EQ(addedBeforePong(*deaf), 0);
    EXPECT_EQ(addedBeforePong(*elsewhere), 0);
    // Who opens the case later has them by the list alone.
    const auto late = taker(smallCaseName);
    EXPECT_EQ(addedBeforePong(*late), 0);
}

TEST_F(ServerBookmarks, OfOneWhoReadsNothingHoldUpNobody) {
    const auto adder = taker(smallCaseName), other = taker(smallCaseName),
               silent = taker(smallCaseName);
    const auto begin = std::chrono::steady_clock::now();
    constexpr int count = 300;
    TestClient::Bytes all;
    for (int n = 0; n < count; ++n) {
        auto message = lookingAt(std::uint64_t(n + 1), "many-" + std::to_string(n), {0, 9, 30});
        message.mutable_add_bookmark()->set_note(std::string(1500, 'x'));
        const auto bytes = TestClient::frameOf(message);
        all.insert(all.end(), bytes.begin(), bytes.end());
    }
    adder->sendBytes(all);
    std::uint64_t newest = 0;
    for (int n = 0; n < count; ++n) {
        const auto pushed = added(*other);
        EXPECT_GT(pushed.bookmark().id(), newest);
        newest = pushed.bookmark().id();
        EXPECT_EQ(pushed.bookmark().client_key(), "many-" + std::to_string(n));
    }
    for (int n = 0; n < count; ++n)
        EXPECT_EQ(added(*adder).request(), std::uint64_t(n + 1));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST_F(ServerBookmarks, TheMarkIsWhereTheGazeMeetsTheWall) {
    const auto client = taker(smallCaseName);
    // On the axis, across: the wall of the tube is known.
    for (const double angle : {0.5, 3.0, 5.5}) {
        auto message = lookingAt(1, "across-" + std::to_string(angle), {});
        TestClient::set(message.mutable_add_bookmark()->mutable_forward(),
                        {std::cos(angle), std::sin(angle), 0.0});
        TestClient::set(message.mutable_add_bookmark()->mutable_up(), {0, 0, 1});
        client->send(message);
        const auto bookmark = added(*client).bookmark();
        ASSERT_TRUE(bookmark.has_mark());
        const glm::dvec2 flat(bookmark.mark().flat().x(), bookmark.mark().flat().y());
        const glm::dvec3 mark = vector(bookmark.mark().position_mm());
        EXPECT_NEAR(flat.x, angle / (2.0 * std::numbers::pi), 1e-3);
        EXPECT_NEAR(mark.z, 10.0, 1e-3);
        EXPECT_LT(glm::distance(tube().positionMm(flat), mark), 0.3);
    }
    // On the wall itself, whatever it looks at; and past the tube's end, at nothing.
    const glm::dvec3 wall = tube().positionMm({0.3, 0.5});
    auto on = TestClient::bookmark(2, "on-the-wall", "");
    TestClient::set(on.mutable_add_bookmark()->mutable_position_mm(), {wall.x, wall.y, wall.z});
    client->send(on);
    EXPECT_LT(glm::distance(vector(added(*client).bookmark().mark().position_mm()), wall), 0.3);
    auto away = TestClient::bookmark(3, "away", "");
    TestClient::set(away.mutable_add_bookmark()->mutable_position_mm(), {0, 0, -500});
    TestClient::set(away.mutable_add_bookmark()->mutable_forward(), {0, 0, -1});
    client->send(away);
    EXPECT_FALSE(added(*client).bookmark().has_mark());
    // Of a case without a wall there is none.
    const auto bare = taker("scan");
    bare->send(TestClient::bookmark(4, "bare", ""));
    EXPECT_FALSE(added(*bare).bookmark().has_mark());
}

TEST_F(ServerSharing, CasesAreListedInEveryStateWithWhoReadsThem) {
    const auto idle = reader("");
    auto list = listed(*idle, 7);
    ASSERT_EQ(list.names_size(), 2);
    ASSERT_EQ(list.entries_size(), 2);
    for (int n = 0; n < 2; ++n) {
        EXPECT_EQ(list.entries(n).name(), list.names(n));
        EXPECT_EQ(list.entries(n).state(), protocol::CaseEntry::READY) << list.entries(n).reason();
        EXPECT_EQ(list.entries(n).readers(), 0u);
        EXPECT_EQ(list.entries(n).prepared_utc().size(), 20u);
        EXPECT_FALSE(list.entries(n).has_confidence());
    }
    EXPECT_TRUE(entry(list, smallCaseName).flattened());
    EXPECT_FALSE(entry(list, "scan").flattened());
    const Grid truth = tube().scan().grid();
    EXPECT_EQ(int(entry(list, smallCaseName).size_z()), truth.size.z);
    EXPECT_NEAR(entry(list, smallCaseName).spacing_mm().x(), truth.spacingMm().x, 1e-9);

    auto one = reader(smallCaseName);
    const auto two = reader(smallCaseName);
    // With a case open, too, and of itself.
    EXPECT_EQ(entry(listed(*one, 8), smallCaseName).readers(), 2u);
    EXPECT_EQ(entry(listed(*idle, 9), "scan").readers(), 0u);
    // While a case is being opened.
    ClientMessage open;
    open.mutable_open_case()->set_name("scan");
    two->send(open);
    list = listed(*two, 10);
    ASSERT_TRUE(readersBecome(*idle, "scan", 1));
    EXPECT_TRUE(readersBecome(*idle, smallCaseName, 1));
    one->vanish();
    EXPECT_TRUE(readersBecome(*idle, smallCaseName, 0));
}

}  // namespace
}  // namespace haustra::tests
