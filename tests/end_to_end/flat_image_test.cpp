// haustra render and export of the flattened wall, on a tube whose map is known.
#include "core/findings.h"
#include "core/wall_camera.h"
#include "end_to_end/flat_store.h"
#include "end_to_end/run_program.h"
#include "picture_files.h"
#include "render/strip_picture.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using namespace render;

/// Rows and columns from `corner` on.
std::vector<std::uint8_t> part(const Image& image, glm::ivec2 corner, glm::ivec2 size) {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < size.y; ++y) {
        const auto row =
            image.rgb.begin() + 3 * (std::ptrdiff_t(image.width) * (corner.y + y) + corner.x);
        pixels.insert(pixels.end(), row, row + 3 * size.x);
    }
    return pixels;
}

class FlatImage : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        makeFlatStore(folder_->path() / "store", tube_);
        context_ = std::move(*gpu::Context::create());
        auto prepared = prepareCase(tube_.scan(), {});
        prepared->flatMap = std::make_shared<const FlatMap>(tube_.map());
        renderer_ = std::move(*CaseRenderer::upload(*context_, std::move(*prepared)));
    }
    static void TearDownTestSuite() {
        renderer_.reset();
        context_.reset();
        folder_.reset();
    }

    static Outcome run(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--store", folder_->path() / "store"});
        return runProgram("haustra", arguments);
    }
    static Outcome render(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", smallCaseName, "--size",
                                           "90x70",  "--out",       picture()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    static Image rendered(const std::vector<std::string>& more) {
        const Outcome outcome = render(more);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return readPicture(picture());
    }
    static Image exported(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"export", smallCaseName, "flat-image", picture()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return readPicture(picture());
    }
    static std::string picture() { return folder_->path() / "picture.png"; }
    static FlatView view(glm::dvec2 center, double pixels, const char* preset = "mucosa") {
        return {{center, pixels}, *opticsPreset(preset), {}};
    }

    static inline const FlatTube tube_{};
    static inline std::unique_ptr<TemporaryFolder> folder_;
    static inline std::unique_ptr<gpu::Context> context_;
    static inline std::unique_ptr<CaseRenderer> renderer_;
};

TEST_F(FlatImage, RenderDrawsWhatTheServerDoes) {
    const FlatOverview overview{*opticsPreset("mucosa"), {}};
    EXPECT_EQ(rendered({"--view", "flattened"}).rgb, renderer_->render(overview, 90, 70)->rgb);
    EXPECT_EQ(rendered({"--view", "flattened-zoom", "--flat", "0.2,0.7",
                        "--pixels-per-circumference", "300", "--transfer-function", "translucent"})
                  .rgb,
              renderer_->render(view({0.2, 0.7}, 300.0, "translucent"), 90, 70)->rgb);
    // The wall nearest to a point; a place may be named in three ways.
    const FlatLookup lookup(std::make_shared<const FlatMap>(tube_.map()));
    const glm::dvec3 point(3.0, 4.0, 30.0);
    EXPECT_EQ(rendered({"--view", "flattened-zoom", "--position", "3,4,30"}).rgb,
              renderer_->render(view(lookup.nearest(point).flat, 512.0), 90, 70)->rgb);
    const glm::dvec3 onPath = poseAtArc(tube_.centerline(), 22.5).point.positionMm;
    EXPECT_EQ(rendered({"--view", "flattened-zoom", "--arc-mm", "22.5"}).rgb,
              renderer_->render(view(lookup.nearest(onPath).flat, 512.0), 90, 70)->rgb);
}

// The place that flattened-zoom has in its middle, from the colon's path.
TEST_F(FlatImage, TheEndoscopicViewFacesAPlaceOfTheWall) {
    const auto map = std::make_shared<const FlatMap>(tube_.map());
    const FlatLookup lookup(map);
    const auto towards = [&](const WallPlace& place, glm::dvec3 point) {
        const CenterlineCamera from = cameraTowards(*map, place, point);
        CameraView view;
        view.camera = {from.positionMm, from.forward, from.up, view.camera.fovDegrees};
        view.optics = *opticsPreset("mucosa");
        return renderer_->render(view, 90, 70)->rgb;
    };
    const WallPlace place = *lookup.at({0.2, 0.7});
    const auto facing = rendered({"--view", "endoscopic", "--flat", "0.2,0.7"}).rgb;
    EXPECT_EQ(facing, towards(place, place.positionMm));
    EXPECT_NE(facing, rendered({"--view", "endoscopic", "--flat", "0.7,0.4"}).rgb);
    const glm::dvec3 point(3.0, 4.0, 30.0);
    EXPECT_EQ(rendered({"--view", "endoscopic", "--position", "3,4,30"}).rgb,
              towards(lookup.nearest(point), point));
}

TEST_F(FlatImage, TheStripIsOfOnePieceAndFillsThePicture) {
    // Wider than one picture of the renderer, and longer than one band.
    const int width = 2100, rows = int(std::lround(tube_.height() * width));
    const Image strip = exported({"--width", "2100"});
    ASSERT_EQ(glm::ivec2(strip.width, strip.height), glm::ivec2(width, rows));
    for (std::size_t i = 0; i < strip.rgb.size(); i += 3)
        ASSERT_GT(strip.rgb[i], 0) << "pixel " << i / 3;
    // Across the seams between its parts.
    const glm::ivec2 size(150, 110);
    for (const glm::ivec2 corner : {glm::ivec2(1950, 980), {1940, 0}, {300, 1970}}) {
        const glm::dvec2 center =
            (glm::dvec2(width, rows) - glm::dvec2(corner) - 0.5 * glm::dvec2(size)) / double(width);
        EXPECT_EQ(part(strip, corner, size),
                  renderer_->render(view(center, width), size.x, size.y)->rgb)
            << corner.x << ", " << corner.y;
    }
}

TEST_F(FlatImage, AMarginRepeatsWhatLiesBeyondTheSeam) {
    const Image plain = exported({"--width", "200"});
    const Image wide = exported({"--width", "200", "--seam-margin", "0.1"});
    ASSERT_EQ(wide.width, 240);
    const glm::ivec2 rows(0, plain.height);
    EXPECT_EQ(part(wide, {20, 0}, {200, rows.y}), plain.rgb);
    EXPECT_EQ(part(wide, {0, 0}, {20, rows.y}), part(plain, {180, 0}, {20, rows.y}));
    EXPECT_EQ(part(wide, {220, 0}, {20, rows.y}), part(plain, {0, 0}, {20, rows.y}));
}

TEST_F(FlatImage, IsOfTheSamePixelsInEveryFormatThatKeepsThem) {
    const std::string tiff = folder_->path() / "picture.tif";
    exported({"--width", "200"});
    const Outcome outcome = run({"export", smallCaseName, "flat-image", tiff, "--width", "200"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(samePicture(picture(), tiff));
}

TEST_F(FlatImage, ACaptionIsDrawnOntoTheSamePicture) {
    const Image plain = exported({"--width", "400"}),
                marked = exported({"--width", "400", "--caption"});
    const std::size_t changed = differingBytes(plain, marked);
    EXPECT_GT(changed, 300u);
    EXPECT_LT(changed, plain.rgb.size() / 10);
}

// In the whole strip, as an export and as a view.
TEST_F(FlatImage, ACaptionRingsAFindingWhereItIsPainted) {
    const auto store = store::CaseStore::open(folder_->path() / "store", false).value();
    const auto plain = store.openCase(smallCaseName).value();
    const auto ct = plain.readVolume<std::int16_t>("ct").value();
    Findings findings;
    findings.model.software = "haustra 0";
    findings.grid = ct.grid();
    Finding finding;
    finding.positionMm = finding.wallMm = tube_.positionMm({0.2, 0.3 * tube_.height()});
    finding.diameterMm = 8.0;
    for (std::size_t n = 0; n < ct.grid().voxelCount(); ++n) {
        const glm::ivec3 voxel = ct.grid().voxelAt(n);
        if (glm::distance(ct.grid().patientFromVoxelPoint(voxel), finding.positionMm) < 4.0)
            finding.voxels.push_back({voxel, 1});
    }
    findings.findings = {finding};
    auto found = store.createCase("found").value();
    const auto key = [](const char* stage) { return store::makeKey(stage, 1, "", {}); };
    ASSERT_TRUE(found.publishVolume("ct", key("ct"), ct));
    ASSERT_TRUE(found.publishCenterline("centerline", key("centerline"), tube_.centerline()));
    ASSERT_TRUE(found.publishFlatMap("flatmap", key("flatmap"), tube_.map()));
    ASSERT_TRUE(found.publishText("findings", key("findings"), findingsJson(findings)));

    const std::vector<std::vector<std::string>> ways{
        {"export", "found", "flat-image", picture(), "--width", "200", "--seam-margin", "0.1"},
        {"render", "found", "--view", "flattened", "--size", "200x300", "--out", picture()}};
    for (const std::vector<std::string>& way : ways) {
        const auto drawn = [&](std::vector<std::string> more) {
            more.insert(more.begin(), way.begin(), way.end());
            const Outcome outcome = run(more);
            EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
            return readPicture(picture());
        };
        const std::vector<std::string> paint =
            way.front() == "export" ? std::vector<std::string>{"--findings"}
                                    : std::vector<std::string>{"--paint", "findings"};
        std::vector<std::string> both = paint;
        both.push_back("--caption");
        const Image bare = drawn({}), painted = drawn(paint), words = drawn({"--caption"}),
                    marked = drawn(both);
        // The middle of where two pictures differ.
        const auto middle = [&](const auto& differ) {
            glm::dvec2 sum(0.0);
            int pixels = 0;
            for (int y = 0; y < bare.height; ++y)
                for (int x = 0; x < bare.width; ++x)
                    if (differ(part(bare, {x, y}, {1, 1}), part(painted, {x, y}, {1, 1}),
                               part(words, {x, y}, {1, 1}), part(marked, {x, y}, {1, 1})))
                        sum += glm::dvec2(x, y), ++pixels;
            EXPECT_GT(pixels, 20) << way.front();
            return sum / double(std::max(1, pixels));
        };
        const glm::dvec2 where = middle([](const auto&a, const auto&b, const auto&, const auto&) {
            return a != b;
        }),
                         ring = middle([](const auto&, const auto&b, const auto&c, const auto&d) {
                             return d != b && d != c;
                         });
        EXPECT_LT(glm::distance(where, ring), 15.0) << way.front();
    }
}

// JPEG's sides end where no other format's do.
TEST_F(FlatImage, AStripThatItsFormatCannotHoldIsRefusedBeforeItIsDrawn) {
    const std::string jpeg = folder_->path() / "long.jpg";
    const auto outcomeOf = [&](int width) {
        return run({"export", smallCaseName, "flat-image", jpeg, "--width", std::to_string(width)});
    };
    const Outcome outcome = outcomeOf(int(65500.0 / tube_.height()) + 1);
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_EQ(lineCount(outcome.err), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find(jpeg + ": "), std::string::npos) << outcome.err;
    // One pixel more than what it says is refused, too.
    const std::string option = "--width ";
    const std::size_t told = outcome.err.find(option);
    ASSERT_NE(told, std::string::npos) << outcome.err;
    const int widest = std::stoi(outcome.err.substr(told + option.size()));
    EXPECT_NEAR(widest, std::min(65500.0, 65500.0 / tube_.height()), 2.0);
    EXPECT_EQ(outcomeOf(widest + 1).exitCode, 1);
    for (const auto& file : std::filesystem::directory_iterator(folder_->path()))
        EXPECT_NE(file.path().stem(), "long") << file.path();
}

TEST_F(FlatImage, PaintsTheWallUnlessItHasAMargin) {
    const std::string paint = folder_->path() / "paint.png";
    const auto exportPaint = [&](const char* margin) {
        const Outcome outcome = run({"export", smallCaseName, "flat-image", paint, "--width", "77",
                                     "--seam-margin", margin});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    };
    exportPaint("0");
    const Outcome painted = render({"--arc-mm", "20", "--paint", paint});
    EXPECT_EQ(painted.exitCode, 0) << painted.err;
    exportPaint("0.1");
    const Outcome refused = render({"--arc-mm", "20", "--paint", paint});
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_NE(refused.err.find("haustra: " + paint + ": "), std::string::npos) << refused.err;
}

TEST_F(FlatImage, SaysWhatIsWrong) {
    const auto says = [](const Outcome& outcome, int exitCode, const char* words) {
        EXPECT_EQ(outcome.exitCode, exitCode) << words;
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    };
    says(run({"export", "scan", "flat-image", picture()}), 1, "flatmap");
    says(run({"render", "scan", "--view", "flattened", "--out", picture()}), 1, "flatmap");
    says(render({"--view", "flattened-zoom", "--flat", "0.5,99"}), 1, "circumferences");
    says(render({"--view", "flattened-zoom"}), 2, "--flat, --arc-mm or --position");
    says(render({"--view", "flattened-zoom", "--flat", "0.5,0.5", "--arc-mm", "3"}), 2, "two ways");
    says(render({"--view", "flattened", "--arc-mm", "3"}), 2, "takes no place");
    says(render({"--view", "axial", "--flat", "0.5,0.5", "--arc-mm", "3"}), 2, "--flat");
    says(render({"--view", "flattened-zoom", "--flat", "1,2,3"}), 2, "X,Y");
    says(render({"--view", "endoscopic"}), 2, "--flat, --arc-mm or --position");
    says(render({"--position=1,2,3", "--arc-mm", "3"}), 2, "two ways");
    says(render({"--flat", "0.5,99"}), 1, "circumferences");
    // The wall ends at z = 60.
    for (const char* view : {"endoscopic", "flattened-zoom"}) {
        says(render({"--view", view, "--position=0,-12,1060"}), 1,
             " mm away, which is more than 100 mm");
        says(render({"--view", view, "--position=0,-12,1060"}), 1, "--position 0,-12,1060");
        EXPECT_EQ(render({"--view", view, "--position=0,-12,150"}).exitCode, 0) << view;
    }
    says(run({"render", "scan", "--position=1,2,3", "--out", picture()}), 1, "flatmap");
    says(run({"export", smallCaseName, "flat-image", folder_->path() / "picture.gif"}), 2, ".png");
    says(run({"export", smallCaseName, "ct", folder_->path() / "ct.nii", "--width", "9"}), 2,
         "flat-image");
}

}  // namespace
}  // namespace haustra::tests
