// kill -9 of the server among a thousand additions: every acknowledged bookmark is there after.
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"

#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

constexpr int additions = 1000, rounds = 3, atATime = 8;

std::unique_ptr<TestClient> openedClient(const ServerProcess& server) {
    auto client = std::make_unique<TestClient>(server.port());
    const auto welcome = client->hello();
    const auto opened = client->openCase(smallCaseName);
    if (!welcome || !opened || !opened->has_case_opened())
        throw std::runtime_error("the case does not open: " + server.log());
    return client;
}

TEST(ServerKill, EveryAcknowledgedBookmarkSurvives) {
    const TemporaryFolder folder;
    makeSmallStore(folder.path());
    std::map<std::string, std::uint64_t> acknowledged;  // client key -> id
    std::mt19937 random(11);
    for (int round = 0; round < rounds; ++round) {
        const std::string prefix = "round" + std::to_string(round) + "-";
        const int killAfter = 100 + int(random() % (additions - 200));
        int sent = 0, answered = 0;
        {
            ServerProcess server(folder.path());
            auto client = openedClient(server);
            try {
                while (answered < additions) {
                    for (; sent < additions && sent < answered + atATime; ++sent)
                        client->send(TestClient::bookmark(std::uint64_t(sent + 1),
                                                          prefix + std::to_string(sent), "a note"));
                    if (answered == killAfter) server.kill();
                    const auto answer = client->answer();
                    if (!answer) break;
                    ASSERT_TRUE(answer->has_bookmark_added()) << answer->error().message();
                    const auto& bookmark = answer->bookmark_added().bookmark();
                    acknowledged[bookmark.client_key()] = bookmark.id();
                    ++answered;
                }
            } catch (const std::system_error&) {
                // Sending to a server that is gone.
            }
            ASSERT_GE(answered, killAfter);
            ASSERT_LT(answered, additions) << "the server was killed too late to tell anything";
        }

        ServerProcess server(folder.path());
        auto client = openedClient(server);
        protocol::ClientMessage list;
        list.mutable_list_bookmarks()->set_request(1);
        client->send(list);
        auto answer = client->answer();
        ASSERT_TRUE(answer && answer->has_bookmark_list());
        std::map<std::string, std::uint64_t> stored;
        std::set<std::uint64_t> ids;
        for (const auto& bookmark : answer->bookmark_list().bookmarks()) {
            EXPECT_TRUE(stored.emplace(bookmark.client_key(), bookmark.id()).second);
            EXPECT_TRUE(ids.insert(bookmark.id()).second);
            EXPECT_EQ(bookmark.note(), "a note");
        }
        for (const auto& [key, id] : acknowledged) {
            ASSERT_TRUE(stored.count(key)) << key << " was acknowledged, and is lost";
            EXPECT_EQ(stored[key], id);
        }
        // At most those whose acknowledgement was under way are stored beyond.
        EXPECT_LE(stored.size(), acknowledged.size() + std::size_t(rounds * atATime));

        // The client asks again for all that it has no answer to: none comes twice.
        for (int n = answered; n < sent; ++n) {
            client->send(
                TestClient::bookmark(std::uint64_t(n + 1), prefix + std::to_string(n), "a note"));
            answer = client->answer();
            ASSERT_TRUE(answer && answer->has_bookmark_added());
            const auto& bookmark = answer->bookmark_added().bookmark();
            if (stored.count(bookmark.client_key()))
                EXPECT_EQ(stored[bookmark.client_key()], bookmark.id());
            else
                EXPECT_FALSE(ids.count(bookmark.id()));
            acknowledged[bookmark.client_key()] = bookmark.id();
        }
    }
}

}  // namespace
}  // namespace haustra::tests
