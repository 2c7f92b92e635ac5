// A session with a fake server on the loopback.
#pragma once

#include "end_to_end/fake_server.h"
#include "reader/session.h"
#include "temporary_folder.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace haustra::tests {

class SessionFixture : public ::testing::Test {
protected:
    std::unique_ptr<reader::Session> sessionWith(const FakeServer& server,
                                                 const std::string& caseName = "phantom") const {
        link::ConnectionOptions options;
        options.address = {"127.0.0.1", server.port()};
        options.pinning.knownServersFile =
            temporary_.path() / ("known_servers" + std::to_string(server.port()));
        options.reconnect = true;
        return std::make_unique<reader::Session>(options, caseName);
    }
    /// False when it takes absurdly long.
    template <class Done>
    static bool until(reader::Session& session, const Done& done) {
        const auto deadline = reader::Clock::now() + std::chrono::seconds(30);
        while (!done() && reader::Clock::now() < deadline)
            session.poll(std::chrono::milliseconds(10));
        return done();
    }

    const TemporaryFolder temporary_;
};

}  // namespace haustra::tests
