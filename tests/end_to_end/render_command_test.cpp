// haustra render on a small store: which scan a picture shows, and the comparison.
#include "core/raycasters.h"
#include "end_to_end/run_program.h"
#include "end_to_end/server_process.h"
#include "picture_files.h"
#include "pictures/drawing.h"
#include "render/comparison.h"
#include "store/case_store.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

namespace fs = std::filesystem;

/// The columns from `left` on.
Image columns(const Image& image, int left, int width) {
    Image part{width, image.height, {}};
    for (int y = 0; y < image.height; ++y) {
        const auto row = image.rgb.begin() + 3 * (std::ptrdiff_t(image.width) * y + left);
        part.rgb.insert(part.rgb.end(), row, row + 3 * width);
    }
    return part;
}

class RenderCommand : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        makeSmallStore(folder_->path() / "store");
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static Outcome run(const std::string& name, std::vector<std::string> more) {
        const std::string store = folder_->path() / "store", place = "--position=-1.2,9.8,112.0";
        std::vector<std::string> arguments{"render", name,      "--store", store,
                                           "--out",  picture(), place};
        if (std::find(more.begin(), more.end(), "--size") == more.end())
            more.insert(more.end(), {"--size", "80x60"});
        if (std::any_of(more.begin(), more.end(), [](const std::string& text) {
                return text == "--arc-mm" || text.starts_with("--position");
            }))
            arguments.pop_back();
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram("haustra", arguments);
    }
    static Image drawn(const std::string& name, const std::vector<std::string>& more) {
        const Outcome outcome = run(name, more);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return readPicture(picture());
    }
    static std::string picture() { return folder_->path() / "picture.png"; }

    static std::unique_ptr<TemporaryFolder> folder_;
};
std::unique_ptr<TemporaryFolder> RenderCommand::folder_;

TEST_F(RenderCommand, AComparisonIsItsThreePicturesSideBySide) {
    for (const char* plane : {"axial", "coronal", "sagittal"}) {
        const Image all = drawn(smallCaseName, {"--view", plane, "--compare", "--zoom", "1.5"});
        ASSERT_EQ(all.width, 3 * 80 + 2 * pictures::separatorPixels) << plane;
        ASSERT_EQ(all.height, 60);
        const int step = 80 + pictures::separatorPixels;
        const Image before = drawn(smallCaseName, {"--view", plane, "--zoom", "1.5"}),
                    after = drawn(smallCaseName,
                                  {"--view", plane, "--zoom", "1.5", "--product", "cleansed"});
        EXPECT_EQ(columns(all, 0, 80).rgb, before.rgb) << plane;
        EXPECT_EQ(columns(all, 2 * step, 80).rgb, after.rgb) << plane;
        const SliceView view{*viewFromString(plane), {-1.2, 9.8, 112.0}, 1.5, WindowLevel{}};
        const Image tissues = *render::tissuePicture(makeSmallCase().mixture, view, 80, 60);
        EXPECT_EQ(columns(all, step, 80).rgb, tissues.rgb) << plane;
        EXPECT_NE(before.rgb, after.rgb) << plane;
    }
}

TEST_F(RenderCommand, TheEndoscopicViewShowsTheCleansedScanUnlessToldOtherwise) {
    const std::vector<std::string> at{"--arc-mm", "20"};
    const auto with = [&](const char* product) {
        return drawn(smallCaseName, {"--arc-mm", "20", "--product", product}).rgb;
    };
    const Image byItself = drawn(smallCaseName, at);
    EXPECT_EQ(byItself.rgb, with("cleansed"));
    EXPECT_NE(byItself.rgb, with("ct"));
}

TEST_F(RenderCommand, ACaseThatIsNotCleansedIsDrawnAsScannedAndSaysSo) {
    const auto store = store::CaseStore::open(folder_->path() / "store", false);
    ASSERT_TRUE(store);
    auto old = store->createCase("old");
    ASSERT_TRUE(old);
    const SmallCase made = makeSmallCase();
    const auto key = [](const char* stage) { return store::makeKey(stage, 1, "", {}); };
    ASSERT_TRUE(old->publishVolume("ct", key("ct"), made.ct));
    ASSERT_TRUE(old->publishCenterline("centerline", key("centerline"), made.centerline));

    const Outcome outcome = run("old", {"--arc-mm", "20"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("no cleansed scan"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
    const Image asScanned = readPicture(picture());
    EXPECT_EQ(asScanned.rgb, drawn(smallCaseName, {"--arc-mm", "20", "--product", "ct"}).rgb);
    drawn("old", {"--view", "axial"});  // a slice shows the scan: nothing to note
}

TEST_F(RenderCommand, WhatACaseLacksIsNamed) {
    const auto fails = [](const std::vector<std::string>& more, const char* product) {
        const Outcome outcome = run("scan", more);
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_NE(outcome.err.find(product), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    };
    fails({"--view", "axial", "--compare"}, "no product cleansed");
    fails({"--view", "coronal", "--product", "cleansed"}, "no product cleansed");
}

/// What OpenImageIO's own program tells of a picture.
std::string told(const std::string& file) {
    std::string text;
    FILE* pipe = ::popen(("oiiotool --info -v '" + file + "'").c_str(), "r");
    for (char buffer[512]; pipe && std::fgets(buffer, sizeof buffer, pipe);)
        text += buffer;
    EXPECT_TRUE(pipe && ::pclose(pipe) == 0);
    return text;
}

TEST_F(RenderCommand, APictureOfAnyFormatSaysWhereItComesFrom) {
    const auto source =
        store::CaseStore::open(folder_->path() / "store", false)->openCase(smallCaseName);
    ASSERT_TRUE(source);
    const auto key = [&](const char* product) {
        return std::string(product) + ".key=" + source->find(product)->key.hex;
    };
    const auto says = [&](const std::string& file, std::vector<std::string> arguments,
                          std::vector<std::string> facts) {
        arguments.insert(arguments.begin(),
                         {"render", smallCaseName, "--store", folder_->path() / "store", "--size",
                          "80x60", "--out", file});
        const Outcome outcome = runProgram("haustra", arguments);
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        const std::string text = told(file);
        facts.insert(facts.end(), {std::string("case=") + smallCaseName, "Software: \"Haustra "});
        for (const std::string& fact : facts)
            EXPECT_NE(text.find(fact), std::string::npos) << fact << " in\n" << text;
        // No path: it may hold a patient's name. (oiiotool begins with the file's.)
        std::string rest = text;
        for (std::size_t at; (at = rest.find(file)) != std::string::npos;)
            rest.erase(at, file.size());
        EXPECT_EQ(rest.find(folder_->path().filename()), std::string::npos) << rest;
    };
    const auto file = [](const std::string& ending) { return folder_->path() / ("said" + ending); };
    for (const char* ending : {".png", ".tif", ".exr", ".jpg"})
        says(file(ending), {"--arc-mm", "20", "--fov", "75", "--raycaster", "native"},
             {"view=endoscopic", "raycaster=native", "transfer_function=mucosa", key("cleansed"),
              key("centerline"), "camera.position_mm=", "camera.forward=", "camera.up=",
              "camera.lens=perspective", "camera.fov_degrees=75"});
    EXPECT_TRUE(samePicture(file(".png"), file(".tif")));
    says(file(".png"), {"--position=-1.2,9.8,112", "--view", "axial", "--compare"},
         {"view=axial", key("ct"), key("mixture"), key("cleansed"),
          "slice.position_mm=-1.2,9.8,112", "slice.zoom=1", "window_hu=0,2000"});
    says(file(".png"), {"--arc-mm", "20", "--view", "oblique"},
         {"view=oblique", key("ct"), "camera.lens=orthographic", "camera.height_mm=60"});
    const Outcome refused = run(smallCaseName, {"--view", "axial", "--out", file(".gif")});
    EXPECT_EQ(refused.exitCode, 2) << refused.err;
}

TEST_F(RenderCommand, ACaptionIsDrawnOnlyWhereItIsAskedFor) {
    for (const std::vector<std::string>& view : {std::vector<std::string>{"--arc-mm", "20"},
                                                 {"--view", "axial", "--compare"},
                                                 {"--view", "oblique", "--arc-mm", "20"}}) {
        std::vector<std::string> captioned = view;
        captioned.push_back("--caption");
        const Image plain = drawn(smallCaseName, view), marked = drawn(smallCaseName, captioned);
        const std::size_t changed = differingBytes(plain, marked);
        EXPECT_GT(changed, 100u);
        EXPECT_LT(changed, plain.rgb.size() / 2);
    }
}

// From face to face, which is 0.4 mm beyond the voxels' centres, and 0.55 mm along the patient.
TEST_F(RenderCommand, ASliceOutsideTheScanIsRefused) {
    for (const char* view : {"axial", "coronal", "sagittal"}) {
        for (const char* place : {"1,2,3000", "-1.2,9.8,99.4", "-20.5,9.8,112", "-1.2,20,112"}) {
            fs::remove(picture());
            const Outcome outcome =
                run(smallCaseName, {"--view", view, std::string("--position=") + place});
            EXPECT_EQ(outcome.exitCode, 1) << view << " " << place;
            EXPECT_EQ(lineCount(outcome.err), 1u) << outcome.err;
            EXPECT_NE(outcome.err.find(std::string("--position ") + place), std::string::npos)
                << outcome.err;
            EXPECT_NE(outcome.err.find("-20.4,-15.4,99.5 to 18.0,19.8,161.0"), std::string::npos)
                << outcome.err;
            EXPECT_FALSE(fs::exists(picture()));
        }
        drawn(smallCaseName, {"--view", view, "--position=-20.3,-15.3,99.5"});
    }
}

TEST_F(RenderCommand, WhatIsWrongWithAnOptionIsSaid) {
    const auto says = [](const std::vector<std::string>& more, const std::string& line) {
        const Outcome outcome = run(smallCaseName, more);
        EXPECT_EQ(outcome.exitCode, 2);
        EXPECT_EQ(outcome.err, "haustra: " + line + " (see haustra render --help)\n");
    };
    const std::string sides = " is not of whole pixels, 1 to 2048 a side";
    says({"--size", "4000x700"}, "--size: \"4000x700\"" + sides);
    says({"--size", "0x7"}, "--size: \"0x7\"" + sides);
    says({"--size", "7.5x7"}, "--size: \"7.5x7\"" + sides);
    says({"--size", "7"}, "--size: \"7\" is not WxH");
    says({"--window", "0,0"}, "--window: \"0,0\" has a width, W, that is not over 0");
    says({"--window", "40"}, "--window: \"40\" is not C,W");
    says({"--spacing", "0,1,1"}, "--spacing: \"0,1,1\" has an X or Y that is not over 0");
    says({"--spacing", "1,1,0"}, "--spacing: \"1,1,0\" has a Z of 0");
    says({"--raycaster", "warp"}, "--raycaster: \"warp\" is none of " + raycasterNames());
    says({"--view", "axial", "--raycaster", "object-order", "--gpu-budget", "500"},
         "--raycaster: a slice casts no rays");
    says({"--view", "axial", "--gpu-budget", "500"}, "--gpu-budget: a slice casts no rays");
}

// It would be drawn as if the option had not been given.
TEST_F(RenderCommand, AnOptionOfAnotherViewIsRefused) {
    const std::map<std::string, std::string> valueOf{{"--pixels-per-circumference", "900"},
                                                     {"--direction", "retrograde"},
                                                     {"--eye", "1,2,3"},
                                                     {"--look", "1,2,3"},
                                                     {"--up", "0,1,0"},
                                                     {"--azimuth", "30"},
                                                     {"--elevation", "30"},
                                                     {"--lens", "fisheye"},
                                                     {"--fov", "50"},
                                                     {"--height-mm", "40"},
                                                     {"--mark", "1,2,3"},
                                                     {"--no-body", ""},
                                                     {"--window", "0,400"},
                                                     {"--zoom", "4"},
                                                     {"--raycaster", "native"},
                                                     {"--step", "0.7"},
                                                     {"--gpu-budget", "500"},
                                                     {"--spacing", "1,1,1"}};
    const auto refuses = [&](std::vector<std::string> arguments,
                             const std::vector<std::string>& options) {
        for (const std::string& option : options) {
            std::vector<std::string> more = arguments;
            more.push_back(option);
            if (!valueOf.at(option).empty()) more.push_back(valueOf.at(option));
            fs::remove(picture());
            const Outcome outcome = run(smallCaseName, more);
            EXPECT_EQ(outcome.exitCode, 2) << arguments[1] << " " << option;
            EXPECT_EQ(outcome.err.find("haustra: " + option + ": "), 0u) << outcome.err;
            EXPECT_EQ(lineCount(outcome.err), 1u) << outcome.err;
            EXPECT_FALSE(fs::exists(picture())) << arguments[1] << " " << option;
        }
    };
    refuses({"--arc-mm", "20"},
            {"--pixels-per-circumference", "--eye", "--look", "--up", "--azimuth", "--elevation",
             "--height-mm", "--mark", "--no-body", "--window", "--zoom", "--spacing"});
    refuses({"--arc-mm", "20", "--lens", "orthographic"}, {"--fov"});
    refuses({"--view", "endoscopic"}, {"--direction"});
    refuses({"--view", "axial"},
            {"--pixels-per-circumference", "--direction", "--eye", "--look", "--up", "--azimuth",
             "--elevation", "--lens", "--fov", "--height-mm", "--mark", "--no-body", "--raycaster",
             "--step", "--gpu-budget", "--spacing"});
    refuses({"--view", "oblique", "--arc-mm", "20"},
            {"--pixels-per-circumference", "--eye", "--look", "--azimuth", "--elevation", "--lens",
             "--fov", "--mark", "--no-body", "--zoom", "--raycaster", "--step", "--gpu-budget"});
    refuses({"--view", "flattened-zoom", "--arc-mm", "20"},
            {"--direction", "--eye", "--look", "--up", "--azimuth", "--elevation", "--lens",
             "--fov", "--height-mm", "--mark", "--no-body", "--window", "--zoom"});
    refuses({"--view", "overview", "--arc-mm", "20"},
            {"--pixels-per-circumference", "--eye", "--look", "--up", "--lens", "--fov", "--window",
             "--zoom", "--spacing"});
}

TEST_F(RenderCommand, ComparisonsAreOfSlices) {
    for (const std::vector<std::string>& wrong :
         {std::vector<std::string>{"--arc-mm", "20", "--compare"},
          {"--view", "axial", "--compare", "--product", "cleansed"},
          {"--view", "axial", "--product", "lumen"}}) {
        const Outcome outcome = run(smallCaseName, wrong);
        EXPECT_EQ(outcome.exitCode, 2) << outcome.err;
    }
}

}  // namespace
}  // namespace haustra::tests
