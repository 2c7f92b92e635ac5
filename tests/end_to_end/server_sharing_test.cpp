// What sessions of the real haustra-server learn of each other: who reads which case, and
// bookmarks as they are added.
#include "end_to_end/flat_store.h"
#include "end_to_end/server_test_client.h"

#include <algorithm>

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
