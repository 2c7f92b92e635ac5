// haustra-client as a program: exit codes, what it prints and writes, and its window.
#include "end_to_end/fake_server.h"
#include "picture_files.h"
#include "temporary_folder.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace haustra {
namespace {

using tests::FakeServer;

struct Outcome {
    int exitCode = -1;
    std::string text;  // standard output and error together
};

Outcome run(const std::string& command) {
    Outcome outcome;
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return outcome;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
        outcome.text.append(buffer, n);
    const int status = ::pclose(pipe);
    if (WIFEXITED(status)) outcome.exitCode = WEXITSTATUS(status);
    return outcome;
}

class ClientProgram : public ::testing::Test {
protected:
    void SetUp() override {
        const char* bin = std::getenv("HAUSTRA_BIN");
        program_ = std::string(bin ? bin : "bin") + "/haustra-client";
    }

    std::string at(const FakeServer& server) const {
        return program_ + " 127.0.0.1:" + std::to_string(server.port()) + " --known-servers " +
               (folder_ / "known").string();
    }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    std::string playing(const std::string& script) const {
        return " --headless --script " + script + " --out " + (folder_ / "out").string();
    }

    const tests::TemporaryFolder temporary_;
    const std::filesystem::path folder_ = temporary_.path();
    std::string program_;
};

TEST_F(ClientProgram, HelpSaysWhatItIsAndWrongUsageExitsWithTwo) {
    const Outcome help = run(program_ + " --help");
    EXPECT_EQ(help.exitCode, 0);
    for (const char* part : {"--headless", "--script", "--fingerprint", "--known-servers", "--list",
                             "--screenshot", "Exit codes", "not a certified medical device"})
        EXPECT_NE(help.text.find(part), std::string::npos) << part;
    for (const char* wrong :
         {"", " a:99999", " a --size 3by4", " a --fingerprint xyz", " a --nonsense",
          " a --headless", " a --script x", " a --headless --script x --out y --size 9000x9",
          " a --list --timeout nan", " a --scale nan"}) {
        const Outcome outcome = run(program_ + wrong);
        EXPECT_EQ(outcome.exitCode, 2) << wrong << ": " << outcome.text;
        EXPECT_FALSE(outcome.text.empty());
    }
}

TEST_F(ClientProgram, ListsCasesAndTellsOfTheFirstMeetingOnce) {
    FakeServer server;
    const Outcome first = run(at(server) + " --list");
    EXPECT_EQ(first.exitCode, 0) << first.text;
    EXPECT_NE(first.text.find("pinned: " + server.fingerprint()), std::string::npos) << first.text;
    EXPECT_EQ(run(at(server) + " --list").text, "phantom\n");
}

TEST_F(ClientProgram, PlaysAScriptAndWritesItsPicturesAndLatencies) {
    FakeServer server;
    const std::string script = write("tour.jsonl", R"({"do":"still","png":"a.png"}
{"do":"fly","positions":10}
)");
    const Outcome outcome = run(at(server) + " --size 200x120" + playing(script));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.text;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "a.png"));
    std::ifstream in(folder_ / "out" / "latencies.json");
    const auto report = nlohmann::json::parse(in);
    EXPECT_TRUE(report["error"].is_null());
    EXPECT_EQ(report["actions"][1]["pictures"], 10);
}

TEST_F(ClientProgram, FailuresAreOneLineAndExitWithOne) {
    FakeServer server;
    const std::string good = write("good.jsonl", "{\"do\":\"still\"}\n");
    const std::string bad = write("bad.jsonl", "\n{\"do\":\"stil\"}\n");
    ASSERT_EQ(run(at(server) + " --list").exitCode, 0);
    const struct {
        std::string command, says;
    } cases[] = {
        {at(server) + playing(bad), bad + ":2: no such action"},
        {at(server) + playing(folder_ / "none.jsonl"), "cannot read the script"},
        {at(server) + " --case nobody" + playing(good), "no such case"},
        {at(server) + " --fingerprint " + std::string(64, 'a') + playing(good), "refused"},
        {program_ + " 127.0.0.1:1 --known-servers " + (folder_ / "k").string() + playing(good),
         "127.0.0.1:1: cannot connect"},
    };
    for (const auto& one : cases) {
        const Outcome outcome = run(one.command);
        EXPECT_EQ(outcome.exitCode, 1) << outcome.text;
        EXPECT_NE(outcome.text.find(one.says), std::string::npos) << outcome.text;
        EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    }
    // A report that cannot be written is told, too, whether or not the script was played.
    std::filesystem::remove_all(folder_ / "out");
    std::filesystem::create_directories(folder_ / "out" / "latencies.json");
    for (const std::string name : {"phantom", "nobody"}) {
        const Outcome outcome = run(at(server) + " --case " + name + playing(good));
        EXPECT_EQ(outcome.exitCode, 1) << outcome.text;
        EXPECT_NE(outcome.text.find("latencies.json: cannot"), std::string::npos) << outcome.text;
        EXPECT_EQ(outcome.text.find("no such case") != std::string::npos, name == "nobody");
    }
}

// The whole window, drawn by software: its picture must show the four views.
TEST_F(ClientProgram, TheWindowShowsTheServersPictures) {
    if (run("command -v xvfb-run").exitCode != 0) GTEST_SKIP() << "xvfb-run is not installed";
    FakeServer server;
    const std::string png = (folder_ / "window.png").string();
    const Outcome outcome = run(
        "xvfb-run -a -s '-screen 0 1400x900x24' " + at(server) +
        " --case phantom --size 1200x800 --scale 1 --screenshot-after-ms 3000 --screenshot " + png);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.text;
    const auto [width, height, rgb] = tests::readPicture(png);
    ASSERT_EQ(width, 1200);
    // The controls are nearly grey, the synthetic pictures are not.
    std::size_t colourful = 0;
    for (std::size_t n = 0; n < rgb.size(); n += 3) {
        const auto [low, high] = std::minmax({rgb[n], rgb[n + 1], rgb[n + 2]});
        colourful += high - low > 60;
    }
    const double share = double(colourful) / (1200.0 * 800.0);
    EXPECT_GT(share, 0.45);
    EXPECT_LT(share, 0.85);
}

}  // namespace
}  // namespace haustra
