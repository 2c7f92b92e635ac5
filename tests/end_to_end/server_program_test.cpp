// haustra-server as a program: limits, stopping, exit codes.
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"

#include <vector>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace haustra::tests {
namespace {

using protocol::ErrorReport;

// Of a server that starts; 0 where it does not.
std::uint16_t portIn(const std::string& file) {
    std::uint16_t number = 0;
    for (int n = 0; n < 6000 && number == 0; ++n) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        std::ifstream(file) >> number;
    }
    return number;
}

std::size_t socketsOf(pid_t process) {
    std::size_t count = 0;
    std::error_code gone;
    for (const auto& descriptor :
         std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/fd", gone))
        count += std::filesystem::read_symlink(descriptor, gone).string().starts_with("socket:");
    return count;
}

TEST(Server, FullIsSaidAndStoppingIsClean) {
    const TemporaryFolder folder;
    makeSmallStore(folder.path());
    ServerProcess server(folder.path(), {"--max-sessions", "1"});
    const auto key = folder.path() / "tls" / "key.pem";
    EXPECT_EQ(std::filesystem::status(key).permissions(), std::filesystem::perms(0600));
    const std::string certificate = fileContent(folder.path() / "tls" / "certificate.pem");

    TestClient first(server.port());
    ASSERT_TRUE(first.hello());
    // It is printed after the port is told, and before anybody is answered.
    EXPECT_NE(server.output().find("certificate SHA-256 "), std::string::npos);
    {
        TestClient second(server.port());
        const auto refused = second.hello();
        ASSERT_TRUE(refused && refused->has_error());
        EXPECT_EQ(refused->error().code(), ErrorReport::BUSY);
        EXPECT_FALSE(second.next());
    }
    EXPECT_EQ(server.terminate(), 0) << server.log();
    const auto farewell = first.answer();
    ASSERT_TRUE(farewell && farewell->has_error());
    EXPECT_TRUE(farewell->error().fatal());

    ServerProcess again(folder.path());
    EXPECT_EQ(fileContent(folder.path() / "tls" / "certificate.pem"), certificate);
    EXPECT_EQ(again.log().find(smallCaseName), std::string::npos);
}

// Connections that say nothing are waited for, and lock nobody out meanwhile.
TEST(Server, WhoSaysNothingMakesRoomForWhoDoes) {
    const TemporaryFolder folder;
    makeSmallStore(folder.path());
    ServerProcess server(folder.path(), {"--max-sessions", "2"});
    asio::io_context io;
    std::vector<asio::ip::tcp::socket> silent;
    for (int n = 0; n < 100; ++n)
        silent.emplace_back(io).connect({asio::ip::address_v4::loopback(), server.port()});
    const TestClient mute[] = {TestClient(server.port()), TestClient(server.port())};
    TestClient first(server.port()), second(server.port());
    for (TestClient* const client : {&first, &second}) {
        const auto welcome = client->hello();
        EXPECT_TRUE(welcome && welcome->has_welcome());
    }
    // The others are still waited for.
    silent.back().non_blocking(true);
    char byte = 0;
    asio::error_code error;
    silent.back().read_some(asio::buffer(&byte, 1), error);
    EXPECT_EQ(error, asio::error::would_block);
}

// The law: a server that starts has room for all that it says it serves, and one that has not says
// how many fit, which is true to the last.
TEST(Server, AsManySessionsAsItPromisesHaveRoom) {
    const TemporaryFolder folder;
    makeSmallStore(folder.path());
    const std::string port = folder.path() / "port";
    const auto serve = [&](int sessions, const std::function<void(pid_t)>& meanwhile) {
        return runProgram(
            "/bin/sh",
            {"-c",
             // One that starts where it is not to, or does not stop, is ended by timeout.
             R"(ulimit -Sn 100 && ulimit -Hn 256 && exec timeout -k 10 240 "$0" --store "$1")"
             R"( --listen 127.0.0.1:0 --port-file "$2" --max-sessions "$3")",
             programPath("haustra-server"), folder.path(), port, std::to_string(sessions)},
            meanwhile);
    };
    const Outcome refused = serve(1000, [](pid_t) {});
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_EQ(lineCount(refused.err), 1u) << refused.err;
    EXPECT_NE(refused.err.find("LimitNOFILE"), std::string::npos) << refused.err;
    int most = 0;
    const std::size_t told = refused.err.find("in which ");
    ASSERT_NE(told, std::string::npos) << refused.err;
    ASSERT_EQ(std::sscanf(refused.err.c_str() + told, "in which %d sessions fit", &most), 1);
    ASSERT_GT(most, 50);
    EXPECT_EQ(serve(most + 1, [](pid_t) {}).exitCode, 1);

    const Outcome served = serve(most, [&](pid_t server) {
        std::vector<std::unique_ptr<TestClient>> clients;
        asio::io_context io;
        std::vector<asio::ip::tcp::socket> strangers;
        struct Stop {  // while they are connected, and whatever fails
            pid_t server;
            ~Stop() { ::kill(server, SIGTERM); }
        } const stop{server};
        const std::uint16_t number = portIn(port);
        ASSERT_NE(number, 0);
        for (int n = 0; n < most; ++n) {
            clients.push_back(std::make_unique<TestClient>(number));
            const auto welcome = clients.back()->hello();
            ASSERT_TRUE(welcome && welcome->has_welcome()) << n;
        }
        for (int n = 0; n < 64; ++n)
            strangers.emplace_back(io).connect({asio::ip::address_v4::loopback(), number});
        for (const char* name : {smallCaseName, "scan"}) {  // a case's files have room, too
            const auto opened = clients.back()->openCase(name);
            EXPECT_TRUE(opened && opened->has_case_opened());
        }
    });
    EXPECT_EQ(served.exitCode, 0);
    EXPECT_EQ(served.err.find("cannot accept"), std::string::npos) << served.err;
}

// The law: whatever strangers say, the server has no more sockets than its sessions and 64 of
// theirs, and a client who says hello rightly is served at once.
TEST(Server, WhoSaysHelloWronglyIsBoundedAndKeepsNobodyOut) {
    const TemporaryFolder folder;
    makeSmallStore(folder.path());
    constexpr std::size_t sessions = 2, strangers = 64;
    ServerProcess server(folder.path(), {"--max-sessions", std::to_string(sessions)});
    TestClient first(server.port());
    ASSERT_TRUE(first.hello());
    protocol::ClientMessage otherVersion, early;
    otherVersion.mutable_hello()->set_protocol_version(2);
    early.mutable_list_cases();
    const TestClient::Bytes wrong[] = {
        TestClient::frameOf(otherVersion), TestClient::frameOf(early),
        TestClient::Bytes{0xff, 0xff, 0xff, 0xff, 0x01}, TestClient::Bytes(4096, 0x77)};
    std::vector<std::unique_ptr<TestClient>> bad;  // who read no answer, and stay
    std::size_t most = 0;
    for (std::size_t n = 0; n < 2 * strangers; ++n) {
        try {
            bad.push_back(std::make_unique<TestClient>(server.port()));
            bad.back()->sendBytes(wrong[n % std::size(wrong)]);
        } catch (const std::system_error&) {  // made room meanwhile
        }
        most = std::max(most, socketsOf(server.pid()));
    }
    // And that which listens, and one that has just been accepted.
    EXPECT_LE(most, sessions + strangers + 2);
    EXPECT_GE(most, strangers) << "they leave too soon to tell anything";
    const auto before = std::chrono::steady_clock::now();
    TestClient second(server.port());
    const auto welcome = second.hello();
    EXPECT_TRUE(welcome && welcome->has_welcome());
    EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(2));
    // None of them was taken for a session, nor has one that has gone left anything.
    TestClient third(server.port());
    const auto refused = third.hello();
    ASSERT_TRUE(refused && refused->has_error());
    EXPECT_EQ(refused->error().code(), ErrorReport::BUSY);
    bad.clear();
    for (int n = 0; n < 1000 && socketsOf(server.pid()) > sessions + 2; ++n)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_LE(socketsOf(server.pid()), sessions + 2);
}

// As behind a pipe to a program that ends, or a journal that starts anew.
TEST(Server, GoesOnWhereNobodyTakesItsLogAnyMore) {
    const TemporaryFolder folder;
    makeSmallStore(folder.path());
    const std::string log = folder.path() / "log", port = folder.path() / "port";
    ASSERT_EQ(::mkfifo(log.c_str(), 0600), 0);
    const Outcome outcome =
        runProgram("/bin/sh",
                   {"-c", R"(exec "$0" --store "$1" --listen 127.0.0.1:0 --port-file "$2" 2> "$3")",
                    programPath("haustra-server"), folder.path(), port, log},
                   [&](pid_t server) {
                       const int reader = ::open(log.c_str(), O_RDONLY | O_CLOEXEC);
                       const std::uint16_t number = portIn(port);
                       ::close(reader);
                       for (int n = 0; n < 3 && number != 0; ++n) {
                           TestClient client(number);  // its coming and going is logged
                           const auto welcome = client.hello();
                           EXPECT_TRUE(welcome && welcome->has_welcome());
                           const auto opened = client.openCase(smallCaseName);
                           EXPECT_TRUE(opened && opened->has_case_opened());
                       }
                       EXPECT_NE(number, 0);
                       ::kill(server, SIGTERM);
                   });
    EXPECT_EQ(outcome.signal, 0);
    EXPECT_EQ(outcome.exitCode, 0);
}

TEST(Server, WrongUsageAndFailureHaveTheirExitCodes) {
    const TemporaryFolder folder;
    EXPECT_EQ(runProgram("haustra-server", {}).exitCode, 2);
    EXPECT_EQ(runProgram("haustra-server", {"--store", folder.path(), "--listen", "7117"}).exitCode,
              2);
    EXPECT_EQ(runProgram("haustra-server", {"--store", folder.path(), "--key", "k.pem"}).exitCode,
              2);
    for (const char* budget : {"nan", "-1", "1e9", "much"})
        EXPECT_EQ(runProgram("haustra-server", {"--store", folder.path(), "--gpu-budget", budget})
                      .exitCode,
                  2)
            << budget;
    const Outcome missing = runProgram("haustra-server", {"--store", folder.path() / "none"});
    EXPECT_EQ(missing.exitCode, 1);
    EXPECT_FALSE(missing.err.empty());
    makeSmallStore(folder.path());
    const std::string portFile = folder.path() / "none" / "port";
    const Outcome unwritten =
        runProgram("haustra-server",
                   {"--store", folder.path(), "--listen", "127.0.0.1:0", "--port-file", portFile});
    EXPECT_EQ(unwritten.exitCode, 1);
    EXPECT_TRUE(unwritten.out.empty()) << unwritten.out;
    EXPECT_NE(unwritten.err.find(portFile + ":"), std::string::npos) << unwritten.err;
    const Outcome help = runProgram("haustra-server", {"--help"});
    EXPECT_EQ(help.exitCode, 0);
    for (const char* option :
         {"--store", "--listen", "--certificate", "--key", "--port-file", "--max-sessions"})
        EXPECT_NE(help.out.find(option), std::string::npos) << option;
}

}  // namespace
}  // namespace haustra::tests
