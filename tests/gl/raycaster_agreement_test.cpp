// The native raycaster against a plain one in double precision, and the others against it.
#include "reference_marcher.h"
#include "render/native/native_raycaster.h"
#include "render_scene.h"

#include <algorithm>
#include <random>

#include <hwy/targets.h>

namespace haustra::tests {
namespace {

using namespace render;

std::shared_ptr<const Scene> sceneOf(const Volume<std::int16_t>& volume) {
    return std::make_shared<const Scene>(
        Scene{volume.share(), blockRanges(volume, blockSide, 1), nullptr, nullptr, nullptr});
}

Image drawn(Raycaster& raycaster, const CameraView& view, int width, int height) {
    Image image{width, height, std::vector<std::uint8_t>(3u * unsigned(width) * unsigned(height))};
    const auto made = raycaster.render(view, Band::whole(width, height), image);
    if (!made) ADD_FAILURE() << describe(made.error());
    return image;
}

Grid oblique() {
    return obliqueGrid({61, 58, 47}, {0.7, 0.7, 1.0});
}

Volume<std::int16_t> noisyTube(const Grid& grid) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-60.0, 60.0);
    return sampled(grid, [&](glm::dvec3 p) { return foldedTube(p) + noise(random); });
}

std::vector<Camera> cameras() {
    Camera inside{{1.0, -2.0, -14.0}, {0.1, 0.05, 1.0}, {0, -1, 0}, 90.0};
    Camera turned{{-3.0, 2.0, 8.0}, {-0.8, 0.3, -0.4}, {0, 0, 1}, 120.0};
    Camera outside{{60.0, -55.0, -70.0}, {-0.6, 0.55, 0.7}, {0, 0, 1}, 40.0};
    Camera around = inside;
    around.lens = Lens::fisheye;
    around.fovDegrees = 300.0;
    Camera parallel = outside;
    parallel.lens = Lens::orthographic;
    parallel.heightMm = 70.0;
    return {inside, turned, outside, around, parallel};
}

/// Every way in which the optical model can be asked for.
std::vector<std::pair<std::string, Optics>> optics() {
    std::vector<std::pair<std::string, Optics>> all;
    for (const char* preset : {"mucosa", "translucent"}) {
        Optics made = *opticsPreset(preset);
        all.emplace_back(preset, made);
        made.shading = false;
        all.emplace_back(std::string(preset) + ", unlit", made);
        made.shading = true;
        made.preIntegrated = true;
        all.emplace_back(std::string(preset) + ", pre-integrated", made);
        made.preIntegrated = false;
        made.composition = Composition::firstHit;
        all.emplace_back(std::string(preset) + ", first hit", made);
        made.composition = Composition::maximumIntensity;
        all.emplace_back(std::string(preset) + ", maximum", made);
    }
    Optics steep = *opticsPreset("translucent");
    GradientRow row{60.0, steep.transferFunction.points};
    for (TransferFunctionPoint& point : row.points)
        point.opacity = std::min(1.0, 3.0 * point.opacity), point.color = glm::dvec3(0.3, 0.8, 0.4);
    steep.transferFunction.rows = {row, {400.0, steep.transferFunction.points}};
    all.emplace_back("by gradient", steep);
    return all;
}

TEST(NativeRaycaster, AgreesWithAPlainOne) {
    const Volume<std::int16_t> volume = sampled(oblique(), foldedTube);
    const auto native = NativeRaycaster::create(sceneOf(volume));
    for (const char* preset : {"mucosa", "translucent"}) {
        for (const Camera& camera : cameras()) {
            if (camera.lens != Lens::perspective) continue;
            const CameraView view{camera, *opticsPreset(preset), {}};
            EXPECT_GE(psnr(drawn(*native, view, 96, 64), referenceEndoscopic(volume, view, 96, 64)),
                      50.0)
                << preset;
        }
    }
}

TEST(NativeRaycaster, LeapingChangesNoPixel) {
    for (const Grid& grid :
         {oblique(), axisAlignedGrid({50, 43, 64}, {1.0, 1.1, 0.6}, {-25, -24, -19})}) {
        const auto native = NativeRaycaster::create(sceneOf(noisyTube(grid)));
        for (const auto& [name, model] : optics()) {
            for (const Camera& camera : cameras()) {
                CameraView view{camera, model, {}};
                const Image leaping = drawn(*native, view, 75, 53);
                view.march.emptySpaceLeaping = false;
                const Image plain = drawn(*native, view, 75, 53);
                EXPECT_EQ(leaping.rgb, plain.rgb) << name << ", lens " << int(camera.lens);
            }
        }
    }
}

TEST(NativeRaycaster, LeapingChangesNoPixelBesideWhatShows) {
    // Air lies between two ranges that show, up to an entry of a wide table away from one of them:
    // a segment of nearly one value counts as an entry long.
    const auto native = NativeRaycaster::create(sceneOf(sampled(oblique(), foldedTube)));
    for (double away = 0.0; away < 8.0; away += 1.0) {
        Optics model = *opticsPreset("translucent");
        model.preIntegrated = true;
        const glm::dvec3 white(1.0);
        model.transferFunction.points = {{-1200.0, white, 0.2},       {-1150.0, white, 0.0},
                                         {away - 1000.0, white, 0.0}, {away - 980.0, white, 0.5},
                                         {away - 960.0, white, 0.0},  {30000.0, white, 0.0}};
        for (const Camera& camera : cameras()) {
            CameraView view{camera, model, {}};
            const Image leaping = drawn(*native, view, 75, 53);
            view.march.emptySpaceLeaping = false;
            EXPECT_EQ(leaping.rgb, drawn(*native, view, 75, 53).rgb)
                << away << ", lens " << int(camera.lens);
        }
    }
}

TEST(NativeRaycaster, BandsAndThreadsAndWhatWasDrawnBeforeChangeNoPixel) {
    const auto scene = sceneOf(noisyTube(oblique()));
    const auto one = NativeRaycaster::create(scene, 1), other = NativeRaycaster::create(scene, 5);
    for (const auto& [name, model] : optics()) {
        for (const Camera& camera : cameras()) {
            const CameraView view{camera, model, {}};
            const Image whole = drawn(*one, view, 101, 67);
            Image banded{101, 67, std::vector<std::uint8_t>(whole.rgb.size())};
            for (const auto& [first, rows] : {std::pair(40, 27), {0, 3}, {3, 37}})
                ASSERT_TRUE(other->render(view, {{101, 67}, first, rows}, banded));
            EXPECT_EQ(whole.rgb, banded.rgb) << name;
        }
    }
}

/// Lets Highway choose one target, or (0) the machine's best again.
void chooseTarget(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
}

TEST(NativeRaycaster, EveryVectorUnitDrawsTheSame) {
    const auto scene = sceneOf(noisyTube(oblique()));
    const auto best = NativeRaycaster::create(scene);
    int units = 0;
    for (const std::int64_t target : {HWY_SCALAR, HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
        chooseTarget(0);
        if ((hwy::SupportedTargets() & target) == 0) continue;
        chooseTarget(target);
        const auto native = NativeRaycaster::create(scene);
        ++units;
        for (const auto& [name, model] : optics()) {
            for (const Camera& camera : cameras()) {
                const CameraView view{camera, model, {}};
                EXPECT_GE(psnr(drawn(*native, view, 61, 43), drawn(*best, view, 61, 43)), 55.0)
                    << name << ", " << hwy::TargetName(target);
            }
        }
    }
    chooseTarget(0);
    EXPECT_GE(units, 2);
}

TEST(NativeRaycaster, ThinVolumesAreReadWithinTheirBounds) {
    for (const glm::ivec3 size : {glm::ivec3(1, 1, 1),
                                  {1, 40, 30},
                                  {40, 1, 30},
                                  {40, 30, 1},
                                  {2, 2, 2},
                                  {3, 3, 3},
                                  {1, 1, 50}}) {
        const Grid grid = axisAlignedGrid(size, glm::dvec3(1.0), -0.5 * glm::dvec3(size - 1));
        const Volume<std::int16_t> volume =
            sampled(grid, [](glm::dvec3 p) { return -600.0 + 9.0 * p.x + 5.0 * p.y - 7.0 * p.z; });
        const auto native = NativeRaycaster::create(sceneOf(volume));
        for (const glm::dvec3 towards : {glm::dvec3(1, 0, 0), {0, 1, 0}, {0.2, 0.3, 1}}) {
            CameraView view{
                {-1.27 * glm::length(glm::dvec3(size)) * towards, towards, {0.1, 0.2, -0.3}, 60.0},
                *opticsPreset("mucosa"),
                {}};
            EXPECT_GE(psnr(drawn(*native, view, 40, 40), referenceEndoscopic(volume, view, 40, 40)),
                      50.0)
                << size.x << "x" << size.y << "x" << size.z;
        }
    }
}

using Raycasters = Drawing;

TEST_F(Raycasters, GlAgreesWithNative) {
    const Volume<std::int16_t> volume = noisyTube(oblique());
    const auto tube = renderer(volume);
    for (const auto& [name, model] : optics()) {
        for (const Camera& camera : cameras()) {
            const CameraView view{camera, model, {}};
            ASSERT_TRUE(tube->use(RaycasterKind::native));
            const Image native = draw(*tube, view, 96, 64);
            ASSERT_TRUE(tube->use(RaycasterKind::singlePass));
            EXPECT_GE(psnr(draw(*tube, view, 96, 64), native), near(45.0, 40.0))
                << name << ", lens " << int(camera.lens);
        }
    }
}

TEST_F(Raycasters, RaysEndAtTheBackdrop) {
    const Volume<std::int16_t> volume = noisyTube(oblique());
    const auto tube = renderer(volume);
    for (const Camera& camera : cameras()) {
        CameraView view{camera, *opticsPreset("translucent"), {}};
        auto backdrop = std::make_shared<Backdrop>(Backdrop{{96, 64}, {}});
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 96; ++x)
                backdrop->pixels.emplace_back(0.01 * x, 0.5, 0.01 * y, 1.5 * x);
        view.backdrop = backdrop;
        ASSERT_TRUE(tube->use(RaycasterKind::native));
        const Image native = draw(*tube, view, 96, 64);
        ASSERT_TRUE(tube->use(RaycasterKind::singlePass));
        EXPECT_GE(psnr(draw(*tube, view, 96, 64), native), 45.0);
        // Where rays end before they begin, the backdrop alone is seen.
        EXPECT_NEAR(pixel(native, 0, 32, 1), 255.0 * displayedOf(0.5), 1.0);
    }
}

}  // namespace
}  // namespace haustra::tests
