// How the real haustra-server opens cases: beside the pictures of others, and each but once.
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"
#include "store/case_store.h"

#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace haustra::tests {
namespace {

using protocol::ErrorReport;

/// A pipe in a product's place: who opens the case waits for release(), and then finds it damaged.
class StuckProduct {
public:
    StuckProduct(const std::filesystem::path& store, const std::string& caseName,
                 const std::string& product) {
        const auto opened = store::CaseStore::open(store, false).value().openCase(caseName).value();
        file_ = opened.folder() / opened.find(product).value().file;
        std::filesystem::rename(file_, kept());
        if (::mkfifo(file_.c_str(), 0600) != 0) throw std::runtime_error("no pipe can be made");
    }
    /// True once somebody waits for the product, who is let go.
    bool release() {
        for (int n = 0; n < 3000; ++n) {
            const int descriptor = ::open(file_.c_str(), O_WRONLY | O_NONBLOCK);
            if (descriptor >= 0) return ::close(descriptor) == 0;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
    void repair() { std::filesystem::rename(kept(), file_); }

private:
    std::filesystem::path kept() const { return file_.string() + ".kept"; }
    std::filesystem::path file_;
};

class Opening : public ::testing::Test {
protected:
    Opening() {
        makeSmallStore(folder_.path());
        server_ = std::make_unique<ServerProcess>(folder_.path());
    }
    std::unique_ptr<TestClient> greeted() const {
        auto client = std::make_unique<TestClient>(server_->port());
        EXPECT_TRUE(client->hello()->has_welcome());
        return client;
    }
    static void ask(TestClient& client, const std::string& name) {
        protocol::ClientMessage message;
        message.mutable_open_case()->set_name(name);
        client.send(message);
    }
    static bool hasOpened(TestClient& client) {
        const auto answer = client.answer();
        return answer && answer->has_case_opened();
    }
    /// How often a case was made ready to be drawn.
    int uploads() const {
        const std::string log = server_->log(), line = "a case is ready";
        int count = 0;
        for (auto at = log.find(line); at != std::string::npos; at = log.find(line, at + 1))
            ++count;
        return count;
    }

    TemporaryFolder folder_;
    std::unique_ptr<ServerProcess> server_;
};

TEST_F(Opening, OthersGetPicturesMeanwhileAndADamagedProductIsOneError) {
    auto reader = greeted();
    ask(*reader, "scan");
    ASSERT_TRUE(hasOpened(*reader));
    reader->viewport(1, 0, protocol::AXIAL, 64, 64);
    std::uint64_t sequence = 1;
    const auto expectPictures = [&] {
        for (int n = 0; n < 20; ++n) {
            reader->slice(++sequence, 0, {-1.2, 2.2, 105.0 + n}, 1.0, false);
            const auto picture = reader->picture();
            ASSERT_TRUE(picture);
            EXPECT_EQ(picture->header.sequence, sequence);
        }
    };
    StuckProduct cleansed(folder_.path(), smallCaseName, "cleansed");
    auto waiting = greeted();
    ask(*waiting, smallCaseName);
    expectPictures();  // none of which waits for the case, as nobody has let it go
    ASSERT_TRUE(cleansed.release());
    const auto refused = waiting->answer();
    ASSERT_TRUE(refused && refused->has_error());
    EXPECT_EQ(refused->error().code(), ErrorReport::INTERNAL);
    EXPECT_FALSE(refused->error().fatal());
    expectPictures();
    EXPECT_EQ(uploads(), 1);

    cleansed.repair();
    ask(*waiting, smallCaseName);  // that its next answer is this one says there was one error
    EXPECT_TRUE(hasOpened(*waiting));
    expectPictures();
}

TEST_F(Opening, SessionsThatAskAtOnceShareARenderer) {
    StuckProduct cleansed(folder_.path(), smallCaseName, "cleansed");
    auto first = greeted();
    ask(*first, smallCaseName);
    std::vector<std::unique_ptr<TestClient>> together;
    for (int n = 0; n < 3; ++n) {
        together.push_back(greeted());
        ask(*together.back(), "scan");  // all wait while the first is stuck
    }
    ASSERT_TRUE(cleansed.release());
    EXPECT_TRUE(first->answer()->has_error());
    for (auto& client : together)
        EXPECT_TRUE(hasOpened(*client));
    EXPECT_EQ(uploads(), 1);
    std::vector<std::vector<std::uint8_t>> pictures;
    for (auto& client : together) {
        client->viewport(1, 0, protocol::AXIAL, 64, 64);
        client->slice(2, 0, {-1.2, 2.2, 112.0}, 1.0, false);
        const auto picture = client->picture();
        ASSERT_TRUE(picture);
        pictures.push_back(picture->rgb);
    }
    EXPECT_EQ(pictures[0], pictures[1]);
    EXPECT_EQ(pictures[0], pictures[2]);
}

TEST_F(Opening, ARendererOutlivesItsLastSessionUntilAnotherCaseComes) {
    const auto openAndLeave = [&](const std::string& name) {
        auto client = greeted();
        ask(*client, name);
        ASSERT_TRUE(hasOpened(*client));
        client->viewport(1, 0, protocol::CORONAL, 64, 64);
        client->slice(2, 0, {-1.2, 2.2, 112.0}, 1.0, false);
        EXPECT_TRUE(client->picture());
        ask(*client, "nobody");  // leaves the case, and is answered when that is done
        EXPECT_TRUE(client->answer()->has_error());
    };
    openAndLeave(smallCaseName);
    openAndLeave(smallCaseName);
    EXPECT_EQ(uploads(), 1);
    openAndLeave("scan");
    EXPECT_EQ(uploads(), 2);
    openAndLeave(smallCaseName);
    EXPECT_EQ(uploads(), 3);
}

/// The small case in whole is 4 bytes for each of 48·44·56 voxels: half a MiB.
class Budget : public ::testing::Test {
protected:
    void start(std::vector<std::string> arguments) {
        makeSmallStore(folder_.path());
        server_ = std::make_unique<ServerProcess>(folder_.path(), std::move(arguments));
        client_ = std::make_unique<TestClient>(server_->port());
        EXPECT_TRUE(client_->hello()->has_welcome());
    }
    TemporaryFolder folder_;
    std::unique_ptr<ServerProcess> server_;
    std::unique_ptr<TestClient> client_;
};

TEST_F(Budget, WhatDoesNotFitIsDrawnAllTheSame) {
    start({"--gpu-budget", "0.25"});
    const auto opened = client_->openCase(smallCaseName);
    ASSERT_TRUE(opened && opened->has_case_opened());
    for (const auto& trial : opened->case_opened().trials())
        EXPECT_TRUE(trial.raycaster() == "native" || trial.raycaster() == "object-order")
            << trial.raycaster();
    EXPECT_EQ(opened->case_opened().trials_size(), 2);
    client_->viewport(1, 0, protocol::ENDOSCOPIC, 64, 64);
    client_->camera(2, 0, {-1.2, 2.2, 112.0}, false);
    EXPECT_TRUE(client_->picture());
}

TEST_F(Budget, ANamedRaycasterThatHasNoRoomIsAClearRefusalAndOthersGoOn) {
    // Room for the bare scan, at 2 bytes a voxel.
    start({"--gpu-budget", "0.3", "--raycaster", "single-pass"});
    auto reader = std::make_unique<TestClient>(server_->port());
    EXPECT_TRUE(reader->hello()->has_welcome());
    ASSERT_TRUE(reader->openCase("scan")->has_case_opened());
    const auto refused = client_->openCase(smallCaseName);
    ASSERT_TRUE(refused && refused->has_error());
    EXPECT_EQ(refused->error().code(), ErrorReport::INTERNAL);
    EXPECT_NE(refused->error().message().find("no room"), std::string::npos)
        << refused->error().message();
    reader->viewport(1, 0, protocol::AXIAL, 64, 64);
    reader->slice(2, 0, {-1.2, 2.2, 112.0}, 1.0, false);
    EXPECT_TRUE(reader->picture());
}

TEST_F(Budget, WhatNobodyReadsGoesOnlyWhenItsRoomIsWanted) {
    start({"--gpu-budget", "64", "--raycaster", "single-pass"});
    const auto openAndLeave = [&](const std::string& name) {
        ASSERT_TRUE(client_->openCase(name)->has_case_opened());
        EXPECT_TRUE(client_->openCase("nobody")->has_error());
    };
    const auto readied = [&] {
        const std::string log = server_->log(), line = "a case is ready";
        int count = 0;
        for (auto at = log.find(line); at != std::string::npos; at = log.find(line, at + 1))
            ++count;
        return count;
    };
    openAndLeave("scan");
    openAndLeave(smallCaseName);
    openAndLeave("scan");
    openAndLeave(smallCaseName);
    EXPECT_EQ(readied(), 2) << "both fit";
}

// What waits of a case that is left may be its last user: its end must not wait for itself.
TEST_F(Opening, ACaseCanBeOpenedAgainWhileItsPicturesWait) {
    auto restless = greeted();
    std::uint64_t sequence = 0;
    for (int n = 0; n < 25; ++n) {
        ask(*restless, "scan");
        ASSERT_TRUE(hasOpened(*restless)) << n;
        for (std::uint32_t viewport = 0; viewport < protocol::maxViewports; ++viewport) {
            restless->viewport(++sequence, viewport, protocol::AXIAL, 512, 512);
            restless->slice(++sequence, viewport, {1, 2, 3}, 1.0, false);
        }
    }
    EXPECT_TRUE(greeted());  // and the server still takes others
}

}  // namespace
}  // namespace haustra::tests
