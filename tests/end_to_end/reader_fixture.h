// A reader behind a window, against a fake server on the loopback.
#pragma once

#include "end_to_end/fake_server.h"
#include "reader/reader.h"
#include "temporary_folder.h"

#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::tests {

class ReaderFixture : public ::testing::Test {
protected:
    explicit ReaderFixture(Misbehaviour misbehaviour = {}) : server_(misbehaviour) {}

    /// The reader opens the server's case; no pane has a size yet.
    void SetUp() override {
        link::ConnectionOptions options;
        options.address = {"127.0.0.1", server_.port()};
        options.pinning.knownServersFile = folder_ / "known_servers";
        options.reconnect = true;
        reader_ = std::make_unique<reader::Reader>(options, "phantom");
    }
    void TearDown() override { reader_.reset(); }

    /// Steps the reader, as a window does, until `done`; false when it takes absurdly long.
    template <class Done>
    bool runUntil(Done done) {
        const auto deadline = link::Clock::now() + std::chrono::seconds(30);
        while (!done()) {
            if (link::Clock::now() > deadline) return false;
            reader_->update(0.01);
            std::this_thread::sleep_for(std::chrono::milliseconds(4));
        }
        return true;
    }

    FakeServer server_;
    const TemporaryFolder temporary_;
    const std::filesystem::path folder_ = temporary_.path();
    std::unique_ptr<reader::Reader> reader_;
};

}  // namespace haustra::tests
