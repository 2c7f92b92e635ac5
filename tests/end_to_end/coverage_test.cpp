// haustra coverage on a prepared case: what it writes, what it keeps, what it refuses.
#include "end_to_end/run_program.h"
#include "store/case_store.h"
#include "temporary_folder.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace haustra::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Json = nlohmann::json;

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class CoverageCommand : public testing::Test {
protected:
    void SetUp() override {
        const char* phantom = std::getenv("HAUSTRA_PHANTOM");
        ASSERT_TRUE(phantom);
        // A copy, which is written to.
        fs::copy(std::string(phantom) + "-store", store, fs::copy_options::recursive);
    }
    Outcome coverage(
        std::vector<std::string> more, const std::function<void(pid_t)>& during = [](pid_t) {}) {
        std::vector<std::string> arguments{"coverage", "p", "--store", store, "--report", report};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram("haustra", arguments, during);
    }
    Json said() const { return Json::parse(bytesOf(report)); }
    std::size_t filesInCase() const {
        return std::size_t(std::distance(fs::directory_iterator(store / "cases" / "p"), {}));
    }

    const TemporaryFolder folder;
    const fs::path store = folder.path() / "store", report = folder.path() / "report.json";
};

TEST_F(CoverageCommand, SaysAndKeepsWhatAFlightBothWaysShows) {
    const fs::path pictures = folder.path() / "pictures";
    fs::create_directory(pictures);
    const auto flown = coverage({"--mode", "vc", "--cameras", "60", "--side", "128", "--visibility",
                                 "rays", "--pictures", pictures});
    ASSERT_EQ(flown.exitCode, 0) << flown.err;
    const Json both = said();
    EXPECT_EQ(both.at("mode"), "vc");
    EXPECT_EQ(both.at("direction"), "both");
    EXPECT_EQ(both.at("cameras"), 60);
    EXPECT_EQ(both.at("pictures"), 120);
    EXPECT_EQ(both.at("visibility"), "rays");
    const double share = both.at("area_percent");
    EXPECT_GT(share, 70.0);
    EXPECT_LE(share, 100.0);
    EXPECT_LE(both.at("fully_area_percent"), share);
    EXPECT_GE(both.at("review").at("area_percent"), share);
    EXPECT_GT(both.at("flattened").at("area_percent"), 99.0);
    double before = 1e9, missedMm2 = both.at("missed_smaller").at("area_mm2");
    for (const Json& patch : both.at("missed")) {
        const double areaMm2 = patch.at("area_mm2");
        EXPECT_LE(areaMm2, before);
        before = areaMm2, missedMm2 += areaMm2;
        EXPECT_EQ(patch.at("center_mm").size(), 3u);
        EXPECT_GE(patch.at("arc_mm"), 0.0);
        EXPECT_LE(patch.at("arc_mm"), both.at("path").at("length_mm"));
    }
    // What is missed and what is seen make up the wall, but for single triangles, which so coarse
    // pictures leave between seen ones.
    const double wallMm2 = both.at("wall").at("area_mm2"),
                 notMissed = 100.0 * (1.0 - missedMm2 / wallMm2);
    EXPECT_GE(notMissed, share - 0.01);
    EXPECT_LE(notMissed, share + 6.0);
    for (const char* name : {"front.png", "back.png", "view-1.png", "view-4.png"})
        EXPECT_GT(fs::file_size(pictures / name), 1000u) << name;

    // The product says the same, and of each triangle what was seen.
    const fs::path json = folder.path() / "coverage.json", ply = folder.path() / "coverage.ply";
    for (const fs::path& file : {json, ply}) {
        const auto done =
            runProgram("haustra", {"export", "p", "coverage", file, "--store", store});
        EXPECT_EQ(done.exitCode, 0) << done.err;
    }
    Json kept = Json::parse(bytesOf(json));
    const std::size_t triangles = kept.at("wall_triangles").at("count");
    kept.erase("wall_triangles");
    EXPECT_EQ(kept, both);
    const std::string mesh = bytesOf(ply);
    EXPECT_NE(mesh.find("element face " + std::to_string(triangles) + "\n"), std::string::npos);
    EXPECT_NE(mesh.find("property uchar visibility\n"), std::string::npos);
    EXPECT_EQ(std::size_t(both.at("wall").at("triangles")), triangles) << "there is no bridge";
    // Each face ends with its number.
    std::size_t seen = 0;
    for (std::size_t n = 0; n < triangles; ++n)
        seen += mesh[mesh.size() - 1 - 14 * n] != 0;
    EXPECT_NEAR(100.0 * double(seen) / double(triangles), both.at("triangle_percent"), 0.001);

    // One way shows less; any number of threads the same, to the byte.
    const std::vector<std::string> oneWay{"--mode",      "vc",         "--cameras",    "60",
                                          "--side",      "128",        "--visibility", "rays",
                                          "--direction", "retrograde", "--threads"};
    std::string first;
    for (const char* threads : {"1", "3"}) {
        auto options = oneWay;
        options.push_back(threads);
        ASSERT_EQ(coverage(options).exitCode, 0);
        EXPECT_LT(said().at("area_percent"), share);
        if (first.empty()) first = bytesOf(report);
        EXPECT_EQ(bytesOf(report), first);
    }
}

TEST_F(CoverageCommand, SimulatesAColonoscopeAndPlansAPath) {
    const auto optical = coverage({"--mode", "oc", "--cameras", "40"});
    ASSERT_EQ(optical.exitCode, 0) << optical.err;
    Json json = said();
    EXPECT_EQ(json.at("direction"), "antegrade");
    EXPECT_EQ(json.at("lens"), "Olympus CF-Q160L");
    EXPECT_EQ(json.at("path").at("clearance_mm"), 6.4);
    EXPECT_FALSE(json.contains("fully_area_percent"));
    EXPECT_GT(json.at("area_percent"), 40.0);

    const auto planned =
        coverage({"--mode", "planned", "--cameras", "24", "--side", "96", "--visibility", "rays"});
    ASSERT_EQ(planned.exitCode, 0) << planned.err;
    json = said();
    EXPECT_LE(json.at("pictures"), 24);
    EXPECT_FALSE(json.contains("direction"));
    EXPECT_GT(json.at("area_percent"), json.at("centerline").at("area_percent"));
}

TEST_F(CoverageCommand, RefusesWhatItCannotDo) {
    const auto refused = [&](std::vector<std::string> options, int code, const char* what) {
        const auto outcome = coverage(std::move(options));
        EXPECT_EQ(outcome.exitCode, code) << outcome.err;
        EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
        EXPECT_FALSE(fs::exists(report));
    };
    refused({}, 2, "--mode");
    refused({"--mode", "vc", "--cameras", "0"}, 2, "--cameras");
    refused({"--mode", "oc", "--visibility", "gpu"}, 2, "bends");
    refused({"--mode", "vc", "--lens", "x.json"}, 2, "--lens");
    refused({"--mode", "planned", "--direction", "both"}, 2, "--direction");
    refused({"--mode", "oc", "--lens", "nothing.json"}, 1, "nothing.json");
    refused({"--mode", "vc", "--pictures", "/nowhere/seen"}, 1, "/nowhere/seen");
    // A case that has not been prepared so far, and none.
    fs::remove_all(store / "cases" / "p");
    refused({"--mode", "vc"}, 1, "p");
    EXPECT_FALSE(fs::exists(store / "cases" / "p"));
}

TEST_F(CoverageCommand, LeavesNothingWhenItIsInterrupted) {
    const std::size_t before = filesInCase();
    for (const int signal : {SIGINT, SIGTERM}) {
        const auto outcome = coverage(
            {"--mode", "vc", "--cameras", "20000", "--visibility", "rays"}, [&](pid_t child) {
                std::this_thread::sleep_for(2s);
                ::kill(child, signal);
            });
        EXPECT_EQ(outcome.signal, signal) << outcome.err;
        EXPECT_FALSE(fs::exists(report));
        EXPECT_EQ(filesInCase(), before);
    }
}

}  // namespace
}  // namespace haustra::tests
