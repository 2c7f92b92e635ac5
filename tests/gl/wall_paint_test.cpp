// The wall's places in a picture, and its paint.
#include "cli/wall_paint.h"

#include "core/findings.h"
#include "flat_tube.h"
#include "pictures/picture_file.h"
#include "render/wall/finding_paint.h"
#include "store/case_store.h"
#include "temporary_folder.h"
#include "wall_scene.h"

#include <filesystem>
#include <optional>

namespace haustra::tests {
namespace {

using namespace render;

class WallOfTube : public Drawing {
protected:
    std::unique_ptr<CaseRenderer> tubeRenderer(RaycasterKind kind = RaycasterKind::singlePass) {
        auto prepared = prepareCase(sampled(grid, closedTube), {}, 0);
        if (!prepared) return nullptr;
        prepared->flatMap = std::make_shared<const FlatMap>(tube.map);
        prepared->wall = std::make_shared<const TriMesh>(tube.wall);
        auto made = CaseRenderer::upload(*context, std::move(*prepared), {.raycaster = kind});
        if (!made) ADD_FAILURE() << describe(made.error());
        return std::move(*made);
    }
    static std::vector<Camera> cameras() {
        std::vector<Camera> cameras = {{{1, -2, -13}, {0.1, 0.05, 1.0}, {0, -1, 0}, 90.0},
                                       {{-3, 2, 4}, {-0.8, 0.3, -0.4}, {0, 0, 1}, 120.0},
                                       {{60, -50, -20}, {-6, 5, 2}, {0, 0, 1}, 40.0}};
        Camera fisheye = cameras[0];
        fisheye.lens = Lens::fisheye;
        fisheye.fovDegrees = 170.0;
        cameras.push_back(fisheye);
        fisheye.fovDegrees = 360.0;
        cameras.push_back(fisheye);
        Camera parallel = cameras[2];
        parallel.lens = Lens::orthographic;
        parallel.heightMm = 45.0;
        cameras.push_back(parallel);
        return cameras;
    }

    /// The ray of a pixel, as picture.h words it: where it begins, and its unit direction.
    static std::optional<std::pair<glm::dvec3, glm::dvec3>> ray(const Camera& camera,
                                                                glm::ivec2 pixel, glm::ivec2 size) {
        const glm::dvec3 forward = glm::normalize(camera.forward);
        const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
        const glm::dvec3 down = glm::cross(forward, right);
        const double x = (2.0 * (pixel.x + 0.5) - size.x) / size.y,
                     y = (2.0 * (pixel.y + 0.5) - size.y) / size.y, radius = std::hypot(x, y);
        const glm::dvec3 aside = x * right + y * down;
        if (camera.lens == Lens::orthographic)
            return std::pair(camera.positionMm + 0.5 * camera.heightMm * aside, forward);
        const double half = glm::radians(camera.fovDegrees) / 2.0;
        if (camera.lens == Lens::perspective)
            return std::pair(camera.positionMm, glm::normalize(forward + std::tan(half) * aside));
        const double angle = radius * half;
        if (angle > std::numbers::pi) return {};
        return std::pair(camera.positionMm,
                         std::cos(angle) * forward + std::sin(angle) / radius * aside);
    }

    /// Brute force: the nearest triangle that the ray meets, by its flat coordinate and distance.
    std::optional<WallPixel> met(const glm::dvec3& from, const glm::dvec3& towards) const {
        std::optional<WallPixel> nearest;
        for (const glm::ivec3& t : tube.map.surface.triangles) {
            const auto at = [&](int corner) {
                return tube.map.surface.vertices[std::size_t(t[corner])];
            };
            const glm::dmat3 plane(at(1) - at(0), at(2) - at(0), -towards);
            if (std::abs(glm::determinant(plane)) < 1e-12) continue;
            const glm::dvec3 solved = glm::inverse(plane) * (from - at(0));
            if (solved.x < 0.0 || solved.y < 0.0 || solved.x + solved.y > 1.0 || solved.z < 0.0 ||
                (nearest && nearest->depthMm <= solved.z))
                continue;
            const auto flat = [&](int corner) { return tube.map.flat[std::size_t(t[corner])]; };
            nearest = {glm::vec2(flat(0) + solved.x * (flat(1) - flat(0)) +
                                 solved.y * (flat(2) - flat(0))),
                       float(solved.z)};
        }
        return nearest;
    }

    const Grid grid = obliqueGrid({71, 68, 57}, {0.7, 0.7, 1.0});
    const Tube tube = makeTube(48);
};

TEST_F(WallOfTube, IsSeenWhereRaysMeetItsTriangles) {
    const glm::ivec2 size(64, 44);
    const auto renderer = tubeRenderer();
    for (const Camera& camera : cameras()) {
        const auto seen = renderer->wallSeen(camera, Band::whole(size.x, size.y));
        ASSERT_TRUE(seen);
        int wrong = 0;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const WallPixel& pixel = (*seen)[std::size_t(y * size.x + x)];
                const auto line = ray(camera, {x, y}, size);
                const auto expected = line ? met(line->first, line->second) : std::nullopt;
                if (!expected) {
                    wrong += pixel.seen();
                    continue;
                }
                const double aside = std::abs(pixel.flat.x - expected->flat.x);
                const bool same = pixel.seen() && std::min(aside, 1.0 - aside) < 1e-3 &&
                                  std::abs(pixel.flat.y - expected->flat.y) < 1e-3 &&
                                  std::abs(pixel.depthMm - expected->depthMm) < 0.05f;
                wrong += !same;
            }
        }
        // Rasterisers snap corners to fractions of a pixel, and a cube's side has pixels of its
        // own: at folds' edges a ray may be given the one or the other side.
        const int allowed = camera.lens == Lens::fisheye ? size.x * size.y / 20 : 4;
        EXPECT_LE(wrong, allowed) << int(camera.lens) << " " << camera.fovDegrees;
    }
}

TEST_F(WallOfTube, BandsSeeWhatTheWholePictureSees) {
    const glm::ivec2 size(64, 44);
    const auto renderer = tubeRenderer();
    for (const Camera& camera : cameras()) {
        const auto whole = renderer->wallSeen(camera, Band::whole(size.x, size.y));
        const auto band = renderer->wallSeen(camera, {size, 13, 20});
        ASSERT_TRUE(whole && band);
        int wrong = 0;
        for (std::size_t i = 0; i < band->size(); ++i)
            wrong += glm::distance((*band)[i].flat, (*whole)[i + 13u * 64u].flat) > 1e-4f;
        EXPECT_LE(wrong, 2);
    }
}

TEST_F(WallOfTube, IsPaintedExactlyWhereItsFlatCoordinateLiesInThePaint) {
    // A rectangle of the strip, across the seam.
    auto paint = std::make_shared<WallPaint>();
    paint->size = {100, 60};
    paint->height = tube.map.height;
    const auto inRectangle = [&](glm::dvec2 flat) {
        const glm::dvec2 pixel =
            glm::dvec2(1.0 - (flat.x - std::floor(flat.x)), 1.0 - flat.y / tube.map.height) *
            glm::dvec2(paint->size);
        return (pixel.x < 20.0 || pixel.x >= 90.0) && pixel.y >= 15.0 && pixel.y < 48.0;
    };
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 100; ++x)
            paint->pixels.push_back((x < 20 || x >= 90) && y >= 15 && y < 48
                                        ? glm::u8vec4(255, 230, 0, 255)
                                        : glm::u8vec4(0));
    const glm::ivec2 size(120, 90);
    for (const RaycasterKind kind :
         {RaycasterKind::singlePass, RaycasterKind::polygonAssisted, RaycasterKind::native}) {
        const auto renderer = tubeRenderer(kind);
        int painted = 0;
        for (const Camera& camera : cameras()) {
            CameraView view{camera, *opticsPreset("mucosa"), {}};
            const Image plain = draw(*renderer, view, size.x, size.y);
            view.paint = paint;
            const Image tinted = draw(*renderer, view, size.x, size.y);
            const auto seen = renderer->wallSeen(camera, Band::whole(size.x, size.y));
            ASSERT_TRUE(seen);
            for (int y = 0; y < size.y; ++y) {
                for (int x = 0; x < size.x; ++x) {
                    const WallPixel& place = (*seen)[std::size_t(y * size.x + x)];
                    const bool covered = place.seen() && inRectangle(place.flat);
                    const bool lit = pixel(plain, x, y) > 20;
                    painted += covered && lit;
                    bool changed = false;
                    for (int c = 0; c < 3; ++c)
                        changed |= pixel(plain, x, y, c) != pixel(tinted, x, y, c);
                    if (lit || !covered) {
                        EXPECT_EQ(changed, covered) << x << ", " << y;
                    }
                    if (covered && lit) {
                        // Yellow, as bright as the wall was.
                        EXPECT_EQ(pixel(tinted, x, y, 2), 0);
                        EXPECT_NEAR(pixel(tinted, x, y, 0), pixel(plain, x, y, 0), 1);
                    }
                }
            }
        }
        EXPECT_GT(painted, 1000);
    }
}

TEST_F(WallOfTube, RefusesPaintThatFitsNothing) {
    const auto renderer = tubeRenderer();
    CameraView view{cameras()[0], *opticsPreset("mucosa"), {}};
    const auto refuses = [&](WallPaint paint) {
        view.paint = std::make_shared<const WallPaint>(std::move(paint));
        const auto made = renderer->render(view, 16, 16);
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().kind, ErrorKind::badInput);
    };
    const std::vector<glm::u8vec4> four(4);
    refuses({{0, 0}, {}, 1.0});
    refuses({{2, 3}, four, 1.0});
    refuses({{2, 2}, four, 0.0});
    const auto bare = this->renderer(sampled(grid, closedTube));
    view.paint = std::make_shared<const WallPaint>(WallPaint{{2, 2}, four, 1.0});
    EXPECT_FALSE(bare->render(view, 16, 16));
    EXPECT_TRUE(renderer->render(view, 16, 16));
}

TEST(WallPaint, TintsTheSameByAnyNumberOfThreadsAndItsOwnRowsAlone) {
    const int width = 37, height = 90;
    WallPaint paint{{64, 64}, std::vector<glm::u8vec4>(64 * 64), 2.0, true};
    for (std::size_t n = 0; n < paint.pixels.size(); n += 3)
        paint.pixels[n] = {n % 251, n % 17, 200, 90 + n % 160};
    Image plain{width, height, std::vector<std::uint8_t>(3u * width * height)};
    for (std::size_t n = 0; n < plain.rgb.size(); ++n)
        plain.rgb[n] = std::uint8_t(37 * n % 256);
    const Band band{{width, height}, 21, 53};
    std::vector<WallPixel> seen(std::size_t(width) * 53);
    for (std::size_t n = 0; n < seen.size(); ++n)
        seen[n] = {{float(n) / 900.0f, 2.0f * float(n) / float(seen.size())}, n % 5 ? 1.0f : -1.0f};
    Image one = plain, many = plain;
    tint(seen, paint, band, one, 1);
    tint(seen, paint, band, many, 5);
    EXPECT_EQ(one.rgb, many.rgb);
    for (std::size_t n = 0; n < plain.rgb.size(); ++n) {
        const std::size_t pixel = n / 3;
        const bool inside = pixel >= 21u * width && pixel < (21u + 53u) * width &&
                            seen[pixel - 21u * width].seen() &&
                            paint.at(seen[pixel - 21u * width].flat).a > 0;
        if (!inside) {
            ASSERT_EQ(one.rgb[n], plain.rgb[n]) << n;
        }
    }
    EXPECT_NE(one.rgb, plain.rgb);
}

TEST(WallPaintOfACase, ColoursItsFindingsAndTheCandidatesThatAreProbableEnough) {
    const TemporaryFolder folder;
    const FlatTube tube;
    const auto map = std::make_shared<const FlatMap>(tube.map());
    auto store = store::CaseStore::open(folder.path(), true).value();
    auto made = store.createCase("tube").value();
    const auto key = [](const char* stage) { return store::makeKey(stage, 1, "", {}); };
    const auto ct = tube.scan(1.2);
    ASSERT_TRUE(made.publishVolume("ct", key("ct"), ct));
    const auto none = cli::paintFindings(made, map, {});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::noResult);
    Findings findings;
    findings.model.software = "a test";
    findings.operatingPoint = 0.5;
    findings.grid = ct.grid();
    for (const double part : {0.3, 0.6}) {
        Finding finding;
        finding.positionMm = finding.wallMm = tube.positionMm({0.4, part * tube.height()});
        finding.diameterMm = 6.0;
        finding.score = 1.2 - 1.5 * part;
        (part < 0.5 ? findings.findings : findings.candidates).push_back(finding);
    }
    ASSERT_TRUE(made.publishText("findings", key("findings"), findingsJson(findings)));
    const auto few = cli::paintFindings(made, map, {}), still = cli::paintFindings(made, map, 0.31),
               all = cli::paintFindings(made, map, 0.3);
    ASSERT_TRUE(few && still && all);
    EXPECT_EQ(few->paint->pixels, still->paint->pixels);
    const auto painter = StripPainter::of(WallSight::of(map).value()).value();
    std::map<std::int32_t, int> of;
    for (const FindingPixel& pixel : findingPixels(*painter, findings))
        of[pixel.pixel] = pixel.finding;
    int both[2] = {0, 0};
    for (std::int32_t n = 0; n < std::int32_t(all->paint->pixels.size()); ++n) {
        const auto found = of.find(n);
        ASSERT_EQ(few->paint->pixels[std::size_t(n)].a > 0,
                  found != of.end() && found->second == 0);
        ASSERT_EQ(all->paint->pixels[std::size_t(n)].a > 0, found != of.end());
        if (found != of.end()) ++both[found->second];
    }
    EXPECT_GT(both[0], 100);
    EXPECT_GT(both[1], 100);
    // And says where they are, each with its number and the colour of its paint.
    ASSERT_EQ(few->places.size(), 1u);
    ASSERT_EQ(all->places.size(), 2u);
    for (int n = 0; n < 2; ++n) {
        const auto& place = all->places[std::size_t(n)];
        EXPECT_EQ(place.number, n + 1);
        EXPECT_LT(glm::distance(place.flat, glm::dvec2(0.4, (0.3 + 0.3 * n) * tube.height())),
                  0.02);
        EXPECT_EQ(place.color, n == 0 ? findingColor : candidateColor);
    }
    // Of another scan's grid they are not painted.
    findings.grid.patientFromVoxel[3].z += 2.0;
    ASSERT_TRUE(
        made.publishText("findings", store::makeKey("moved", 1, "", {}), findingsJson(findings)));
    EXPECT_FALSE(cli::paintFindings(made, map, {}));
}

// A pixel of rounding, or a hundredth, is no other shape.
TEST(WallPaintFile, IsOfTheStripsShape) {
    const tests::TemporaryFolder folder;
    const auto file = folder / "paint.png";
    for (const auto& [size, fits] : {std::pair(glm::ivec2(100, 1700), true),
                                     {glm::ivec2(100, 1716), true},
                                     {glm::ivec2(100, 1684), true},
                                     {glm::ivec2(100, 1720), false},
                                     {glm::ivec2(100, 1680), false},
                                     {glm::ivec2(120, 1700), false},
                                     {glm::ivec2(1, 17), true},
                                     {glm::ivec2(3, 52), true},
                                     {glm::ivec2(64, 64), false}}) {
        ASSERT_TRUE(pictures::writePicture(file, blankImage(size), {}));
        const auto paint = cli::readWallPaint(file, 17.0);
        EXPECT_EQ(bool(paint), fits) << size.x << "x" << size.y;
        if (paint) continue;
        EXPECT_EQ(paint.error().place, file.string());
        const std::string own = std::to_string(size.x) + "x" + std::to_string(17 * size.x);
        EXPECT_NE(paint.error().message.find(own), std::string::npos) << paint.error().message;
    }
}

TEST(WallPaintFile, IsAPictureOfTheStripWithTheCecumUp) {
    const tests::TemporaryFolder folder;
    const auto file = folder / "paint.png";
    Image picture{4, 2, std::vector<std::uint8_t>(24, 0)};
    picture.rgb[0] = 255;          // the top left pixel is red
    picture.rgb[3 * 7 + 1] = 255;  // the bottom right one green
    ASSERT_TRUE(pictures::writePicture(file, picture, {}));
    const auto paint = cli::readWallPaint(file, 0.5);
    std::filesystem::resize_file(file, 40);
    const auto broken = cli::readWallPaint(file, 0.5);
    ASSERT_TRUE(paint);
    EXPECT_EQ((*paint)->at({0.99, 0.48}), glm::u8vec4(255, 0, 0, 255));
    EXPECT_EQ((*paint)->at({-0.01, 0.27}), glm::u8vec4(255, 0, 0, 255));
    EXPECT_EQ((*paint)->at({0.01, 0.0}), glm::u8vec4(0, 255, 0, 255));
    EXPECT_EQ((*paint)->at({0.5, 0.16}), glm::u8vec4(0, 0, 0, 255));
    EXPECT_EQ((*paint)->at({0.5, 0.52}), glm::u8vec4(0));
    EXPECT_FALSE(broken);
}

}  // namespace
}  // namespace haustra::tests
