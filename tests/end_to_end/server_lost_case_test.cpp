// A product that is cut short while readers look at it ends its case, not the server.
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"
#include "store/case_store.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::tests {
namespace {

using protocol::ErrorReport;

std::filesystem::path fileOf(const std::filesystem::path& store, const std::string& product) {
    const auto opened =
        store::CaseStore::open(store, false).value().openCase(smallCaseName).value();
    return opened.folder() / opened.find(product).value().file;
}

std::vector<std::uint8_t> sliceAt(TestClient& client, std::uint64_t sequence, double z) {
    client.slice(sequence, 0, {-1.2, 2.2, z}, 1.0, false);
    const auto picture = client.picture();
    if (!picture || picture->header.sequence != sequence)
        throw std::runtime_error("there is no picture of the slice");
    return picture->rgb;
}

// These two read the volumes where they are, in the mapped files.
class LostCase : public ::testing::TestWithParam<const char*> {};

TEST_P(LostCase, EndsForItsReadersAndCanBeOpenedAnew) {
    TemporaryFolder folder;
    makeSmallStore(folder.path());
    ServerProcess server(folder.path(), {"--raycaster", GetParam()});
    const auto reader = [&](const char* name) {
        auto client = std::make_unique<TestClient>(server.port());
        EXPECT_TRUE(client->hello()->has_welcome());
        EXPECT_TRUE(client->openCase(name)->has_case_opened());
        client->viewport(1, 0, protocol::AXIAL, 64, 64);
        return client;
    };
    auto other = reader("scan"), first = reader(smallCaseName), second = reader(smallCaseName);
    const auto elsewhere = sliceAt(*other, 2, 120.0);
    const auto before = sliceAt(*first, 2, 120.0);
    ASSERT_EQ(sliceAt(*second, 2, 120.0), before);

    const auto ct = fileOf(folder.path(), "ct"), kept = folder.path() / "kept";
    std::filesystem::copy_file(ct, kept);
    ASSERT_EQ(::truncate(ct.c_str(), 8192), 0);
    first->slice(3, 0, {-1.2, 2.2, 140.0}, 1.0, false);
    for (TestClient* client : {first.get(), second.get()}) {  // also the one that asks for nothing
        const auto told = client->answer();
        ASSERT_TRUE(told && told->has_error());
        EXPECT_EQ(told->error().code(), ErrorReport::CASE_LOST);
        EXPECT_FALSE(told->error().fatal());
    }
    // The state is ready: no input, but another case, or the same one when its file is whole again.
    first->slice(4, 0, {-1.2, 2.2, 130.0}, 1.0, false);
    EXPECT_EQ(first->answer()->error().code(), ErrorReport::BAD_STATE);
    EXPECT_EQ(first->openCase(smallCaseName)->error().code(), ErrorReport::INTERNAL);
    EXPECT_TRUE(second->openCase("scan")->has_case_opened());
    EXPECT_EQ(sliceAt(*other, 3, 120.0), elsewhere);

    std::filesystem::rename(kept, ct);
    ASSERT_TRUE(first->openCase(smallCaseName)->has_case_opened());
    first->viewport(5, 0, protocol::AXIAL, 64, 64);
    EXPECT_EQ(sliceAt(*first, 6, 120.0), before);
    EXPECT_EQ(server.terminate(), 0);
}

INSTANTIATE_TEST_SUITE_P(Raycasters, LostCase, ::testing::Values("native", "object-order"));

}  // namespace
}  // namespace haustra::tests
