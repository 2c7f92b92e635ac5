// haustra render on scans from files, and on a case from outside and across the path.
#include "end_to_end/run_program.h"
#include "end_to_end/server_process.h"
#include "grey_picture_file.h"
#include "nifti/nifti_file.h"
#include "picture_files.h"
#include "store/case_store.h"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

namespace fs = std::filesystem;

/// A ball at the patient's left of the middle, in 8 bits.
Volume<std::uint8_t> ball() {
    const Grid grid = axisAlignedGrid({40, 30, 36}, {1.0, 1.5, 1.25});
    Volume<std::uint8_t> volume(grid);
    const glm::dvec3 middle = grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size - 1));
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
        const double inside = 7.0 - glm::distance(p, middle + glm::dvec3(9.0, 0.0, 0.0));
        volume.writable()[n] = std::uint8_t(std::clamp(128.0 + 60.0 * inside, 0.0, 255.0));
    }
    return volume;
}

/// Where the picture is bright, from its middle in its heights.
glm::dvec2 brightPlace(const Image& image) {
    glm::dvec2 sum(0.0);
    double weight = 0.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double w = image.rgb[3 * std::size_t(y * image.width + x)];
            sum += w * (glm::dvec2(x, y) + 0.5);
            weight += w;
        }
    EXPECT_GT(weight, 0.0);
    return (sum / std::max(weight, 1.0) - 0.5 * glm::dvec2(image.width, image.height)) /
           double(image.height);
}

class RenderScan : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        const Volume<std::uint8_t> volume = ball();
        ASSERT_TRUE(nifti::writeNifti(at("ball.nii.gz"), volume));
        const glm::ivec3 size = volume.grid().size;
        fs::create_directory(at("slices"));
        fs::create_directory(at("tiffs"));
        // Not zero-padded: only numbers in the names tell the order.
        for (int z = 0; z < size.z; ++z)
            for (const char* name : {"slices/slice-", "tiffs/a"})
                writePixels(at(name + std::to_string(z) + (name[0] == 's' ? ".png" : ".tif")),
                            &volume.voxels()[volume.grid().index(0, 0, z)], size);
        std::ofstream(at("white.json"))
            << R"({"name":"white","shading":false,"points":[{"hu":100,"color":[1,1,1],"opacity":0},
                   {"hu":150,"color":[1,1,1],"opacity":1},{"hu":255,"color":[1,1,1],"opacity":1}]})";
        std::ofstream(at("broken.json")) << R"({"name":"broken","points":[{"hu":1}]})";
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string at(const std::string& name) { return folder_->path() / name; }
    static Outcome run(const std::string& input, std::vector<std::string> more) {
        std::vector<std::string> arguments{"render", input,   "--size",
                                           "60x50",  "--out", at("picture.png")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram("haustra", arguments);
    }
    static Image drawn(const std::string& input, std::vector<std::string> more,
                       bool withTransferFunction = true) {
        if (withTransferFunction) more.insert(more.begin(), {"--tf", at("white.json")});
        const Outcome outcome = run(input, more);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return outcome.exitCode == 0 ? readPicture(at("picture.png")) : Image{};
    }
    static void expectFails(const std::string& input, const std::vector<std::string>& more,
                            int exitCode, const std::string& what) {
        const Outcome outcome = run(input, more);
        EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
        EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err << " for " << what;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    static std::unique_ptr<TemporaryFolder> folder_;
};
std::unique_ptr<TemporaryFolder> RenderScan::folder_;

TEST_F(RenderScan, SeesAllOfItFromTheFrontUnlessTurned) {
    const Image front = drawn(at("ball.nii.gz"), {"--lens", "orthographic"});
    const glm::dvec2 place = brightPlace(front);
    EXPECT_GT(place.x, 0.1);  // the patient's left
    EXPECT_NEAR(place.y, 0.0, 0.02);
    const Image left = drawn(at("ball.nii.gz"), {"--lens", "orthographic", "--azimuth", "90"});
    EXPECT_NEAR(glm::length(brightPlace(left)), 0.0, 0.02);
    const Image back = drawn(at("ball.nii.gz"), {"--lens", "orthographic", "--azimuth", "180"});
    EXPECT_NEAR(brightPlace(back).x, -place.x, 0.02);
    const Image perspective = drawn(at("ball.nii.gz"), {});
    EXPECT_GT(brightPlace(perspective).x, 0.05);
}

TEST_F(RenderScan, ACameraStandsAnywhereWithAnyLens) {
    // The ball's middle is at (28.5, 21.75, 21.875).
    const std::vector<std::string> ahead{"--eye", "28.5,0,21.875", "--look", "28.5,21.75,21.875"};
    for (const char* lens : {"perspective", "fisheye"}) {
        std::vector<std::string> more = ahead;
        more.insert(more.end(), {"--lens", lens, "--fov", "100"});
        EXPECT_NEAR(glm::length(brightPlace(drawn(at("ball.nii.gz"), more))), 0.0, 0.02) << lens;
    }
    // A quarter turn about the gaze: the ball beside it goes from the right to the bottom.
    std::vector<std::string> beside{"--eye",         "19.5,-20,21.875", "--look",
                                    "19.5,0,21.875", "--fov",           "60"};
    const glm::dvec2 upright = brightPlace(drawn(at("ball.nii.gz"), beside));
    beside.insert(beside.end(), {"--up=-1,0,0"});
    const glm::dvec2 turned = brightPlace(drawn(at("ball.nii.gz"), beside));
    EXPECT_GT(upright.x, 0.05);
    EXPECT_NEAR(turned.x, 0.0, 0.02);
    EXPECT_NEAR(turned.y, upright.x, 0.03);
}

TEST_F(RenderScan, AFolderOfSlicesIsTheSameScan) {
    const std::vector<std::string> turned{"--azimuth", "25", "--elevation", "10"};
    const Image file = drawn(at("ball.nii.gz"), turned);
    std::vector<std::string> spaced = turned;
    spaced.insert(spaced.end(), {"--spacing", "1,1.5,1.25"});
    EXPECT_EQ(drawn(at("slices"), spaced).rgb, file.rgb);
    EXPECT_EQ(drawn(at("tiffs"), spaced).rgb, file.rgb);
    // With a negative distance the first slice is the uppermost: the third has the others below.
    const auto slice = [&](const std::string& spacing, const std::string& place) {
        return drawn(at("slices"), {"--view", "axial", "--spacing", spacing, "--position", place},
                     false);
    };
    const Image third = slice("1,1.5,1.25", "28.5,21.75,2.5");
    EXPECT_EQ(slice("1,1.5,-1.25", "28.5,21.75,-2.5").rgb, third.rgb);
    const Image middle = slice("1,1.5,-1.25", "28.5,21.75,-21.875");
    EXPECT_NE(middle.rgb, third.rgb);
    EXPECT_EQ(*std::max_element(middle.rgb.begin(), middle.rgb.end()), 255);
}

TEST_F(RenderScan, EachRaycasterDrawsThePicture) {
    const Image usual = drawn(at("ball.nii.gz"), {});
    for (const std::string kind : {"native", "object-order"}) {
        std::vector<std::string> options{"--raycaster", kind};
        if (kind == "object-order") options.insert(options.end(), {"--gpu-budget", "16"});
        const Image image = drawn(at("ball.nii.gz"), options);
        ASSERT_EQ(image.rgb.size(), usual.rgb.size()) << kind;
        int far = 0;
        for (std::size_t i = 0; i < usual.rgb.size(); ++i)
            far += std::abs(int(image.rgb[i]) - int(usual.rgb[i])) > 2;
        EXPECT_LE(far, 9) << kind;
    }
}

TEST_F(RenderScan, SlicesTakeAllValuesForTheirWindow) {
    const Image axial =
        drawn(at("ball.nii.gz"), {"--view", "axial", "--position", "28.5,21.75,21.875"}, false);
    EXPECT_GT(brightPlace(axial).x, 0.1);
    EXPECT_EQ(*std::max_element(axial.rgb.begin(), axial.rgb.end()), 255);
    // The slice across the patient's axis, seen from the feet, is the axial one.
    const Image oblique = drawn(at("ball.nii.gz"),
                                {"--view", "oblique", "--position", "28.5,21.75,21.875", "--look",
                                 "28.5,21.75,40", "--up=0,-1,0", "--height-mm", "30"},
                                false);
    EXPECT_NEAR(glm::length(brightPlace(oblique)), 0.0, 0.02);
}

TEST_F(RenderScan, ColoursAreDrawnLabelByLabel) {
    // A red organ at the patient's right, a green one at the left.
    const Grid grid = axisAlignedGrid({40, 20, 30}, glm::dvec3(1.0));
    Volume<Rgba> color(grid);
    Volume<std::uint8_t> labels(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 at(grid.voxelAt(n));
        const bool red = glm::distance(at, {10, 10, 15}) < 7.0;
        const bool green = glm::distance(at, {29, 10, 15}) < 7.0;
        color.writable()[n] = {std::uint8_t(red ? 220 : 20), std::uint8_t(green ? 220 : 20), 20,
                               std::uint8_t(red || green ? 200 : 0)};
        labels.writable()[n] = red ? 3 : green ? 7 : 0;
    }
    ASSERT_TRUE(nifti::writeColorNifti(at("color.nii.gz"), color));
    ASSERT_TRUE(nifti::writeNifti(at("labels.nii.gz"), labels));
    const auto sum = [](const Image& image, int channel) {
        long total = 0;
        for (std::size_t i = std::size_t(channel); i < image.rgb.size(); i += 3)
            total += image.rgb[i];
        return total;
    };
    const std::vector<std::string> with{"--labels", at("labels.nii.gz")};
    const Image both = drawn(at("color.nii.gz"), with, false);
    std::vector<std::string> green = with;
    green.insert(green.end(), {"--label", "7"});
    const Image one = drawn(at("color.nii.gz"), green, false);
    EXPECT_GT(sum(both, 0), 3 * sum(one, 0));
    EXPECT_GT(sum(one, 1), 3 * sum(one, 0));
    expectFails(at("color.nii.gz"), {"--labels", at("none.nii.gz")}, 1, "none.nii.gz");
    expectFails(at("color.nii.gz"), {"--labels", at("ball.nii.gz")}, 1, "grid");
    green.back() = "9";
    expectFails(at("color.nii.gz"), green, 1, "label");
    expectFails(at("color.nii.gz"), {"--tf", at("white.json"), "--label", "7"}, 2, "--label");
    expectFails(at("color.nii.gz"), {"--labels", at("labels.nii.gz"), "--tf", "bone"}, 2, "--tf");
}

TEST_F(RenderScan, WhatIsWrongIsNamed) {
    const std::string white = at("white.json"), scan = at("ball.nii.gz");
    expectFails(at("none.nii.gz"), {"--tf", white}, 1, "none.nii.gz");
    expectFails(at("nowhere/"), {"--tf", white}, 1, "nowhere/");
    expectFails(scan, {"--tf", at("none.json")}, 1, "none.json");
    expectFails(scan, {"--tf", at("broken.json")}, 1, "broken.json");
    expectFails(at("white.json"), {"--tf", white}, 1, "white.json");
    fs::create_directory(at("mixed"));
    const std::uint8_t pixels[12] = {};
    writePixels(at("mixed/1.png"), pixels, {4, 3});
    writePixels(at("mixed/2.png"), pixels, {3, 4});
    expectFails(at("mixed"), {"--tf", white}, 1, "2.png");

    expectFails(scan, {}, 2, "--tf");
    expectFails(scan, {}, 2, "mucosa");  // the presets are named
    expectFails(scan, {"--tf", "purple"}, 2, "purple");
    expectFails(scan, {"--tf", white, "--gpu-budget", "16"}, 2, "object-order");
    expectFails(scan, {"--tf", white, "--gpu-budget", "16", "--raycaster", "native"}, 2,
                "object-order");
    expectFails(scan, {"--tf", white, "--view", "axial", "--position", "1,2,3"}, 2, "--window");
    expectFails(scan, {"--view", "overview"}, 2, "overview");
    expectFails(scan, {"--tf", white, "--arc-mm", "10"}, 2, "--arc-mm");
    expectFails(scan, {"--tf", white, "--look", "1,2,3"}, 2, "--look");
    expectFails(scan, {"--tf", white, "--lens", "pinhole"}, 2, "--lens");
    expectFails(scan, {"--tf", white, "--fov", "200"}, 2, "--fov");
    expectFails(scan, {"--tf", white, "--raycaster", "magic"}, 2, "--raycaster");
    expectFails(scan, {"--tf", white, "--spacing", "1,0,1"}, 2, "--spacing");
    expectFails("someCase", {}, 2, "--store");

    // What would be passed over.
    expectFails(scan, {"--tf", white, "--spacing", "1,1,1"}, 2, "--spacing");
    expectFails(scan, {"--tf", white, "--zoom", "2"}, 2, "--zoom: is for --view axial");
    expectFails(scan, {"--tf", white, "--paint", white}, 2, "--paint");
    expectFails(scan, {"--tf", white, "--eye", "0,0,0", "--azimuth", "9"}, 2, "--azimuth");
    fs::create_directory(at("none"));
    expectFails(at("none"), {"--tf", white, "--spacing", "1,1,1"}, 1, "--spacing");
}

/// The wall of the small case's colon: a tube around its path, open at the ends.
TriMesh smallWall(const Centerline& path) {
    TriMesh wall;
    constexpr int sides = 24;
    for (const CenterlinePoint& point : path.points)
        for (int side = 0; side < sides; ++side) {
            const double angle = 2.0 * M_PI * side / sides;
            wall.vertices.push_back(point.positionMm +
                                    10.0 * glm::dvec3(std::cos(angle), std::sin(angle), 0.0));
        }
    for (int row = 0; row + 1 < int(path.points.size()); ++row)
        for (int side = 0; side < sides; ++side) {
            const int a = row * sides + side, b = row * sides + (side + 1) % sides;
            wall.triangles.push_back({a, b, a + sides});
            wall.triangles.push_back({b, b + sides, a + sides});
        }
    return wall;
}

TEST_F(RenderScan, ACaseIsSeenFromOutsideAndAcrossItsPath) {
    const std::string store = at("store");
    makeSmallStore(store);
    {
        const auto cases = store::CaseStore::open(store, false);
        ASSERT_TRUE(cases);
        auto tube = cases->createCase(smallCaseName);
        ASSERT_TRUE(tube);
        ASSERT_TRUE(tube->publishMesh("surface", store::makeKey("surface", 1, "", {}),
                                      smallWall(makeSmallCase().centerline)));
    }
    const auto picture = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--store", store});
        return drawn(smallCaseName, more, false);
    };
    const Image bare = picture({"--view", "overview", "--no-body"});
    EXPECT_NE(picture({"--view", "overview"}).rgb, bare.rgb);
    EXPECT_NE(picture({"--view", "overview", "--no-body", "--arc-mm", "20"}).rgb, bare.rgb);
    EXPECT_NE(picture({"--view", "overview", "--no-body", "--mark=-1,2,120"}).rgb, bare.rgb);
    EXPECT_NE(
        picture({"--view", "overview", "--no-body", "--azimuth", "90", "--elevation", "40"}).rgb,
        bare.rgb);
    // Across the path the lumen is a dark disc in the middle.
    const Image across = picture({"--view", "oblique", "--arc-mm", "20"});
    const auto grey = [&](int x, int y) {
        return int(across.rgb[3 * std::size_t(y * across.width + x)]);
    };
    EXPECT_EQ(grey(30, 25), 0);
    EXPECT_GT(grey(30 + 14, 25), 80);
    EXPECT_NE(picture({"--arc-mm", "20", "--lens", "fisheye"}).rgb,
              picture({"--arc-mm", "20"}).rgb);
    expectFails("scan", {"--store", store, "--view", "overview"}, 1, "no product");
    expectFails(smallCaseName, {"--store", store, "--view", "oblique", "--position", "0,0,110"}, 2,
                "--look");
    expectFails(smallCaseName,
                {"--store", store, "--view", "axial", "--arc-mm", "20", "--lens", "fisheye"}, 2,
                "--lens");
}

}  // namespace
}  // namespace haustra::tests
