// haustra calibrate as scripts meet it.
#include "board_scenes.h"
#include "coverage/lens_file.h"
#include "end_to_end/run_program.h"
#include "picture_files.h"
#include "pictures/picture_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace haustra {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

tests::Outcome calibrate(Arguments arguments) {
    arguments.insert(arguments.begin(), "calibrate");
    return tests::runProgram("haustra", arguments);
}

class Calibrate : public testing::Test {
protected:
    // Three boards, and a picture without one.
    static void SetUpTestSuite() {
        folder_ = std::make_unique<tests::TemporaryFolder>();
        coverage::Colonoscope scope = coverage::olympusCfQ160l();
        scope.lens.mu *= 0.6, scope.lens.mv *= 0.6, scope.lens.u0 *= 0.6, scope.lens.v0 *= 0.6;
        scope.pictureSize = {315, 264};
        scope.openCenter *= 0.6, scope.openRadii *= 0.6;
        const tests::BoardPainter painter(scope);
        const coverage::Board board{coverage::BoardPattern::dots, {7, 6}, 5.0};
        for (int n = 0; n < 3; ++n) {
            const auto pose = tests::facing(board, 30.0, 12.0 * n, 120.0 * n,
                                            {25.0 * (n - 1), 20.0 - 30.0 * n, 50.0 * n});
            write(painter.paint(board, pose, 1.6, 2.0, unsigned(n)), "board" + std::to_string(n));
        }
        write(painter.paint(board, tests::facing(board, 4.0, 0.0, 0.0, {}), 1.6, 2.0, 9), "near");
        write(blankImage({100, 100}), "small");
    }
    static void TearDownTestSuite() { folder_.reset(); }
    static void write(const Image& image, const std::string& name) {
        ASSERT_TRUE(pictures::writePicture(at(name + ".png"), image, {"test", {}}));
    }
    static std::string at(const std::string& name) { return fs::path(folder_->path()) / name; }
    static Arguments boards(Arguments more) {
        Arguments all{at("board0.png"),
                      at("board1.png"),
                      at("board2.png"),
                      "--board",
                      "dots:7x6",
                      "--spacing",
                      "5"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// A single line that names what is wrong; nothing of the results is there.
    static void refused(const Arguments& arguments, int exitCode, const std::string& why) {
        const auto outcome = calibrate(arguments);
        EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
        const std::size_t last = outcome.err.rfind("haustra: ");
        ASSERT_NE(last, std::string::npos) << outcome.err;
        EXPECT_EQ(tests::lineCount(outcome.err.substr(last)), 1u) << outcome.err;
        EXPECT_NE(outcome.err.find(why, last), std::string::npos) << outcome.err;
        EXPECT_FALSE(fs::exists(at("new.json")));
        EXPECT_FALSE(fs::exists(at("new.png")));
    }
    static std::unique_ptr<tests::TemporaryFolder> folder_;
};
std::unique_ptr<tests::TemporaryFolder> Calibrate::folder_;

TEST_F(Calibrate, TellsTheLensAndWritesItsFiles) {
    Arguments arguments = boards({"--pixels-per-mm", "15.35418", "--out", at("lens.json"),
                                  "--opencv", at("lens.yml"), "--residuals", at("left.png"),
                                  "--undistorted", at("straight.png"), "--name", "drawn"});
    arguments.insert(arguments.begin() + 1, at("near.png"));
    const auto outcome = calibrate(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    for (const char* told : {"k1 ", "k2 ", " ± ", "m_u", "held", "RMS", "3 of 4 pictures",
                             "near.png: left out: no dots:7x6", "board0.png: 42 of 42 points"})
        EXPECT_NE(outcome.out.find(told), std::string::npos) << told << "\n" << outcome.out;

    const auto scope = coverage::readColonoscope(at("lens.json"));
    ASSERT_TRUE(scope) << describe(scope.error());
    EXPECT_EQ(scope->name, "drawn");
    EXPECT_EQ(scope->pictureSize, glm::ivec2(315, 264));
    const auto file = nlohmann::json::parse(tests::fileContent(at("lens.json")));
    const auto& errors = file["calibration"]["standard_errors"];
    EXPECT_FALSE(errors.contains("m_u"));
    const auto truth = coverage::olympusCfQ160l().lens;
    // Standard errors are of the points' scatter; drawing rounds brightness, which adds to it.
    EXPECT_NEAR(scope->lens.k[0], truth.k[0], 6.0 * errors["k1"].get<double>());
    EXPECT_NEAR(scope->lens.k[1], truth.k[1], 6.0 * errors["k2"].get<double>());
    EXPECT_NEAR(scope->lens.u0, 0.6 * truth.u0, 6.0 * errors["u0"].get<double>());
    EXPECT_NEAR(scope->openRadii.x, 0.6 * 309.08, 1.5);
    EXPECT_LT(file["calibration"]["rms_pixels"].get<double>(), 0.1);

    const auto opencv = coverage::readColonoscope(at("lens.yml"));
    ASSERT_TRUE(opencv) << describe(opencv.error());
    EXPECT_NEAR(opencv->lens.mu, scope->lens.mu * scope->lens.k[0], 1e-9);
    EXPECT_GT(tests::readPicture(at("left.png")).width, 900);
    EXPECT_EQ(tests::readPicture(at("straight.png")).width, 315);

    // The lens is a beginning, is shown and applied, and all of it the same each time.
    const auto again = calibrate(boards({"--lens", at("lens.json")}));
    EXPECT_EQ(again.exitCode, 0) << again.err;
    const auto shown = calibrate({at("board0.png"), "--lens", at("lens.json"), "--out",
                                  at("same.json"), "--undistorted", at("straight2.png")});
    ASSERT_EQ(shown.exitCode, 0) << shown.err;
    EXPECT_EQ(coverage::readColonoscope(at("same.json")).value(), *scope);
    EXPECT_EQ(tests::differingBytes(tests::readPicture(at("straight.png")),
                                    tests::readPicture(at("straight2.png"))),
              0u);
    const std::string before = tests::fileContent(at("lens.json"));
    ASSERT_EQ(calibrate(arguments).exitCode, 0);
    EXPECT_EQ(tests::fileContent(at("lens.json")), before);
}

// Table 2.1's endoscope needs no picture.
TEST_F(Calibrate, TheSourcesEndoscopeIsAPreset) {
    const auto outcome = calibrate({"--lens", "olympus-cf-q160l", "--out", at("olympus.json")});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("field 140.0°, depth 3 to 100 mm, tip radius 6.4 mm"),
              std::string::npos)
        << outcome.out;
    EXPECT_EQ(coverage::readColonoscope(at("olympus.json")).value(), coverage::olympusCfQ160l());
}

TEST_F(Calibrate, WhatFailsIsOneLineAndLeavesNothing) {
    const Arguments files{"--out", at("new.json"), "--residuals", at("new.png")};
    const auto with = [&](Arguments arguments) {
        arguments.insert(arguments.end(), files.begin(), files.end());
        return arguments;
    };
    const std::string board = "--board", dots = "dots:7x6";
    refused(with({at("near.png"), board, dots, "--spacing", "5"}), 1, "no picture shows");
    refused(with({at("none.png"), board, dots, "--spacing", "5"}), 1, at("none.png"));
    refused(with(boards({at("small.png")})), 1, at("small.png"));
    refused(with(boards({"--lens", at("board0.png")})), 1, at("board0.png"));
    refused(with(boards({"--lens", at("none.json")})), 1, at("none.json"));
    refused(with(boards({"--model", "equisolid", "--opencv", at("new.yml")})), 1, "OpenCV");
    refused(boards({"--out", at("no/new.json")}), 1, at("no/new.json"));

    const Arguments other{"--lens", "olympus-cf-q160l", "--undistorted", at("new.png"),
                          "--out",  at("new.json")};
    Arguments misfit{at("board0.png")};
    misfit.insert(misfit.end(), other.begin(), other.end());
    refused(misfit, 1, at("board0.png") + ": the picture is of 315x264 pixels");
    refused(misfit, 1, "525x440");

    refused(with({board, dots, "--spacing", "5"}), 2, "IMAGES");
    refused(with({at("board0.png"), "--spacing", "5"}), 2, "--board");
    refused(with({at("board0.png"), board, dots}), 2, "--spacing");
    refused(with({at("board0.png"), board, "dots:7", "--spacing", "5"}), 2, "dots:7");
    refused(with(boards({"--model", "zoom"})), 2, "--model");
    refused(with(boards({"--focal", "-2"})), 2, "--focal");
    refused(with(boards({"--depth-mm", "100", "3"})), 2, "--depth-mm");
    refused(with(boards({"--model", "brown", "--focal", "2"})), 2, "--focal");
    refused(with(boards({"--pixels-per-mm", "15", "--focal", "2"})), 2, "--focal");
    refused(with(boards({"--model", "equisolid", "--nominal", "orthogonal"})), 2, "--nominal");
    refused(with(boards({"--undistorted", at("new.txt")})), 2, "new.txt");
    refused(with(boards({"--undistorted", at("new.gif")})), 2, "--undistorted");
    refused(boards({"--residuals", at("new.gif")}), 2, "--residuals");
    refused(with(boards({"--field", "500"})), 2, "--field");
    refused(with(boards({"--model", "brown", "--field", "179.5"})), 2, "--field");
    refused(boards({"--out", at("board1.png")}), 2, "board1.png");
    refused(boards({"--out", at("new.json"), "--opencv", at("new.json")}), 2, "new.json");
    refused({"--lens", "olympus-cf-q160l", "--model", "brown", "--out", at("new.json")}, 2,
            "--model");
}

}  // namespace
}  // namespace haustra
