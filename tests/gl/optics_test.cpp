// The optical model, every composition through every lens, against closed forms and a plain one.
#include "reference_marcher.h"
#include "render_scene.h"

#include <numbers>
#include <random>
#include <string>
#include <utility>

namespace haustra::tests {
namespace {

using namespace render;

/// Every way in which the model can be asked for.
std::vector<std::pair<std::string, Optics>> everyOptics() {
    std::vector<std::pair<std::string, Optics>> all;
    for (const char* preset : {"mucosa", "translucent"}) {
        Optics made = *opticsPreset(preset);
        for (const bool preIntegrated : {false, true}) {
            made.preIntegrated = preIntegrated;
            all.emplace_back(preset + std::string(preIntegrated ? ", pre-integrated" : ""), made);
        }
        made.composition = Composition::firstHit;
        all.emplace_back(std::string(preset) + ", first hit", made);
        made.composition = Composition::maximumIntensity;
        all.emplace_back(std::string(preset) + ", greatest value", made);
    }
    Optics unlit = *opticsPreset("translucent");
    unlit.shading = false;
    all.emplace_back("translucent, unlit", unlit);
    Optics rows = *opticsPreset("translucent");
    GradientRow steep{150.0, rows.transferFunction.points};
    for (TransferFunctionPoint& point : steep.points) {
        point.opacity = std::min(1.0, 3.0 * point.opacity);
        point.color = glm::dvec3(0.3, 0.8, 0.4);
    }
    rows.transferFunction.rows = {steep, {600.0, rows.transferFunction.points}};
    all.emplace_back("by gradient", rows);
    return all;
}

std::vector<Camera> everyLens() {
    const Camera inside{{1.0, -2.0, -14.0}, {0.1, 0.05, 1.0}, {0, -1, 0}, 90.0};
    const Camera outside{{60.0, -55.0, -70.0}, {-0.6, 0.55, 0.7}, {0, 0, 1}, 40.0};
    Camera around = inside, parallel = outside, within = inside;
    around.lens = Lens::fisheye;
    around.fovDegrees = 330.0;
    parallel.lens = within.lens = Lens::orthographic;
    parallel.heightMm = 70.0;
    within.heightMm = 18.0;
    return {inside, outside, around, parallel, within};
}

Volume<std::int16_t> noisyTube(const Grid& grid) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-60.0, 60.0);
    return sampled(grid, [&](glm::dvec3 p) { return foldedTube(p) + noise(random); });
}

Grid oblique() {
    return obliqueGrid({61, 58, 47}, {0.7, 0.7, 1.0});
}

using OpticalModel = Drawing;

TEST_F(OpticalModel, AgreesWithAPlainOne) {
    const Volume<std::int16_t> volume = sampled(oblique(), foldedTube);
    const auto tube = renderer(volume);
    for (const auto& [name, optics] : everyOptics()) {
        for (const Camera& camera : everyLens()) {
            const CameraView view{camera, optics, {}};
            EXPECT_GE(psnr(draw(*tube, view, 48, 32), referenceEndoscopic(volume, view, 48, 32)),
                      near(45.0, 40.0))
                << name << ", lens " << int(camera.lens);
        }
    }
}

TEST_F(OpticalModel, LeapingAndBandsChangeNoPixel) {
    const auto tube = renderer(noisyTube(oblique()));
    for (const auto& [name, optics] : everyOptics()) {
        for (const Camera& camera : everyLens()) {
            CameraView view{camera, optics, {}};
            const Image whole = draw(*tube, view, 75, 53);
            Image banded{75, 53, std::vector<std::uint8_t>(whole.rgb.size())};
            for (const auto& [first, rows] : {std::pair(30, 23), {0, 3}, {3, 27}})
                ASSERT_TRUE(tube->render(view, {{75, 53}, first, rows}, banded));
            EXPECT_EQ(whole.rgb, banded.rgb) << name << ", lens " << int(camera.lens);
            view.march.emptySpaceLeaping = false;
            EXPECT_EQ(whole.rgb, draw(*tube, view, 75, 53).rgb)
                << name << ", lens " << int(camera.lens);
        }
    }
}

TEST_F(OpticalModel, GradientsFromATextureShowTheSame) {
    const Volume<std::int16_t> volume = noisyTube(oblique());
    const std::size_t bytes = 8 * volume.grid().voxelCount();
    const auto make = [&](std::size_t budget) {
        return std::move(
            *CaseRenderer::create(*context, volume, {}, {.gradientBudgetBytes = budget}));
    };
    const auto computed = make(bytes - 1), read = make(bytes);
    for (const auto& [name, optics] : everyOptics()) {
        for (const Camera& camera : everyLens()) {
            const CameraView view{camera, optics, {}};
            EXPECT_GE(psnr(draw(*read, view, 96, 64), draw(*computed, view, 96, 64)), 48.0)
                << name << ", lens " << int(camera.lens);
        }
    }
    EXPECT_EQ(read->gpuBytes() - computed->gpuBytes(), bytes);
}

/// Values rise by 40 HU/mm along z, from −1000 at z = 0.
Volume<std::int16_t> ramp() {
    return sampled(axisAlignedGrid({9, 9, 60}, glm::dvec3(1.0), {-4, -4, 0}),
                   [](glm::dvec3 p) { return -1000.0 + 40.0 * p.z; });
}

TEST_F(OpticalModel, PreIntegrationSeesAPeakThinnerThanAStep) {
    const auto volume = renderer(ramp());
    // Optical depth of a tent of height h and foot 2w in HU, on a slope of 40 HU/mm: with the
    // extinction −ln(1 − a) of each opacity a on the way up.
    const double half = 4.0, peak = 0.9;
    double depth = 0.0;
    for (int i = 0; i < 10000; ++i)
        depth -= std::log(1.0 - peak * (i + 0.5) / 10000) * (2.0 * half / 40.0) / 10000;
    const double expected = 255.0 * displayedOf(1.0 - std::exp(-depth));
    CameraView view;
    view.optics.transferFunction.points = {{-1000.0, glm::dvec3(1.0), 0.0},
                                           {300.0 - half, glm::dvec3(1.0), 0.0},
                                           {300.0, glm::dvec3(1.0), peak},
                                           {300.0 + half, glm::dvec3(1.0), 0.0},
                                           {1400.0, glm::dvec3(1.0), 0.0}};
    view.optics.shading = false;
    double worstWithout = 0.0;
    for (const double stepVoxels : {0.2, 0.5, 1.0}) {
        for (const double phase : {0.05, 0.3, 0.55, 0.8}) {
            view.march.stepVoxels = stepVoxels;
            view.camera = {{0.0, 0.0, -5.0 + phase}, {0, 0, 1}, {0, -1, 0}, 2.0};
            view.optics.preIntegrated = true;
            EXPECT_NEAR(pixel(draw(*volume, view, 5, 5), 2, 2), expected, 3.0)
                << "step " << stepVoxels << " phase " << phase;
            view.optics.preIntegrated = false;
            worstWithout =
                std::max(worstWithout, std::abs(pixel(draw(*volume, view, 5, 5), 2, 2) - expected));
        }
    }
    EXPECT_GT(worstWithout, 30.0);
    view.optics.preIntegrated = true;
    view.march.stepVoxels = 1.5;
    EXPECT_FALSE(volume->render(view, 5, 5));
}

/// Half width of what is not black in the picture's middle row.
double litHalfWidth(const Image& image) {
    int lit = 0;
    for (int x = 0; x < image.width; ++x)
        lit += pixel(image, x, image.height / 2) > 8;
    return 0.5 * lit;
}

TEST_F(OpticalModel, GradientRowsShowTheSteepShellAlone) {
    // Going inwards, 30 HU/mm from radius 20 to 14, then 250 HU/mm from 10 to 8.
    const auto ball = renderer(sampled(
        axisAlignedGrid({65, 65, 65}, glm::dvec3(0.7), glm::dvec3(-22.4)), [](glm::dvec3 p) {
            const double r = glm::length(p);
            return -600.0 + 30.0 * std::clamp(20.0 - r, 0.0, 6.0) +
                   250.0 * std::clamp(10.0 - r, 0.0, 2.0);
        }));
    CameraView view;
    view.camera = {{0, 0, -60.0}, {0, 0, 1}, {0, -1, 0}, 90.0, Lens::orthographic, 50.0};
    view.optics.shading = false;
    const std::vector<TransferFunctionPoint> clear{{-590.0, glm::dvec3(1.0), 0.0},
                                                   {500.0, glm::dvec3(1.0), 0.0}},
        opaque{{-595.0, glm::dvec3(1.0), 0.0},
               {-590.0, glm::dvec3(1.0), 1.0},
               {500.0, glm::dvec3(1.0), 1.0}};
    view.optics.transferFunction = {clear, {{99.0, clear}, {101.0, opaque}, {400.0, opaque}}};
    // A central difference over a voxel to either side sees the shell a voxel before it.
    EXPECT_NEAR(litHalfWidth(draw(*ball, view, 200, 200)) / 4.0, 10.0, 0.7);
    view.optics.transferFunction = {opaque, {}};
    EXPECT_NEAR(litHalfWidth(draw(*ball, view, 200, 200)) / 4.0, 19.8, 0.3);
}

/// HU fall by 60 a mm from the centre out, and are 0 on the ball of 14 mm.
Volume<std::int16_t> ball() {
    return sampled(axisAlignedGrid({56, 56, 56}, glm::dvec3(0.7), glm::dvec3(-19.25)),
                   [](glm::dvec3 p) { return 60.0 * (14.0 - glm::length(p)); });
}

TEST_F(OpticalModel, FirstHitLiesOnTheSurfaceWhateverTheStep) {
    const auto drawn = renderer(ball());
    CameraView view;
    view.camera = {{3.0, -2.0, -40.0}, {0, 0, 1}, {0, -1, 0}, 30.0};
    view.optics.composition = Composition::firstHit;
    view.optics.shading = false;
    // Red tells the HU at the hit: 8 HU from black to full.
    view.optics.transferFunction.points = {{-40.0, {0, 0, 0}, 0.3},
                                           {-4.0, {0, 0, 0}, 0.48},
                                           {4.0, {1, 0, 0}, 0.52},
                                           {40.0, {1, 0, 0}, 0.7}};
    for (const double stepVoxels : {0.2, 0.5, 1.0}) {
        view.march.stepVoxels = stepVoxels;
        const Image image = draw(*drawn, view, 21, 21);
        for (const glm::ivec2 at : {glm::ivec2(10, 10), {6, 9}, {13, 14}, {10, 5}}) {
            // 16 levels are half an HU, 1/120 mm; 40 are 1/48 mm.
            EXPECT_NEAR(pixel(image, at.x, at.y), 255.0 * displayedOf(linearOf(0.5)),
                        near(16.0, 40.0))
                << "step " << stepVoxels << " at " << at.x << ", " << at.y;
        }
    }
}

TEST_F(OpticalModel, GreatestValueIsTheOneOnTheRay) {
    const Grid grid = axisAlignedGrid({21, 21, 21}, glm::dvec3(1.0), glm::dvec3(-10.0));
    Volume<std::int16_t> volume(grid, -1000);
    std::mt19937 random(3);
    std::uniform_int_distribution<int> any(-900, 1000);
    for (auto& value : volume.writable())
        value = std::int16_t(any(random));
    const auto drawn = renderer(volume);
    CameraView view;
    view.optics.composition = Composition::maximumIntensity;
    view.optics.transferFunction.points = {
        {-1000.0, glm::dvec3(0.0), 1.0}, {1000.0, glm::dvec3(1.0), 1.0}, {1001.0, {1, 0, 0}, 1.0}};
    // Parallel rays through voxels' centres; every second sample lies on one.
    view.camera = {{0, 0, -20.0}, {0, 0, 1}, {0, -1, 0}, 90.0, Lens::orthographic, 21.0};
    const Image image = draw(*drawn, view, 21, 21);
    for (int y = 0; y < 21; ++y) {
        for (int x = 0; x < 21; ++x) {
            int most = -1000;
            for (int z = 0; z < 21; ++z)
                most = std::max<int>(most, volume.at(x, y, z));
            EXPECT_NEAR(pixel(image, x, y), 255.0 * (most + 1000.0) / 2000.0, 1.0);
        }
    }
}

TEST_F(OpticalModel, LensesGiveTheAnalyticSilhouettes) {
    const auto drawn = renderer(ball());
    const double distance = 50.0, angle = std::asin(14.0 / distance);
    CameraView view;
    view.optics.transferFunction = surfaceAt(0.0);
    view.optics.shading = false;
    view.march.stepVoxels = 0.2;
    const auto lit = [&](const Camera& camera) {
        view.camera = camera;
        const Image image = draw(*drawn, view, 201, 201);
        int count = 0;
        for (int y = 0; y < 201; ++y)
            for (int x = 0; x < 201; ++x)
                count += pixel(image, x, y) > 8;
        return double(count);
    };
    const double pi = std::numbers::pi;
    const auto radius = [&](double pixels) { return std::sqrt(pixels / pi); };
    const Camera towards{{0, 0, -distance}, {0, 0, 1}, {0, -1, 0}, 60.0};
    EXPECT_NEAR(radius(lit(towards)), std::tan(angle) / std::tan(pi / 6.0) * 100.5, 0.5);
    Camera parallel = towards;
    parallel.lens = Lens::orthographic;
    parallel.heightMm = 40.0;
    EXPECT_NEAR(radius(lit(parallel)), 14.0 / 20.0 * 100.5, 0.5);
    Camera fisheye = towards;
    fisheye.lens = Lens::fisheye;
    fisheye.fovDegrees = 120.0;
    EXPECT_NEAR(radius(lit(fisheye)), angle / (pi / 3.0) * 100.5, 0.5);
    // Behind it the ball is a ring around everything, whose outer rim is half a turn from the axis.
    fisheye.forward = {0, 0, -1};
    fisheye.fovDegrees = 360.0;
    const double outer = 100.5, inner = (pi - angle) / pi * 100.5;
    EXPECT_NEAR(lit(fisheye), pi * (outer * outer - inner * inner), 200.0);
}

TEST_F(OpticalModel, RaysEndAtTheBackdrop) {
    // 0.02 a mm from z = 0 on; the eye stands 10 mm before it, in air.
    const auto slab = renderer(
        Volume<std::int16_t>(axisAlignedGrid({33, 33, 80}, glm::dvec3(1.0), {-16, -16, 0.5}), 100));
    for (const bool preIntegrated : {false, true}) {
        CameraView view;
        view.camera = {{0, 0, -10.2}, {0, 0, 1}, {0, -1, 0}, 90.0, Lens::orthographic, 7.0};
        view.optics.transferFunction = everywhere(0.02);
        view.optics.shading = false;
        view.optics.preIntegrated = preIntegrated;
        auto backdrop = std::make_shared<Backdrop>(Backdrop{{40, 9}, {}});
        for (int i = 0; i < 40 * 9; ++i)
            backdrop->pixels.emplace_back(0.0, 0.3, 0.6, 2.0 * (i % 40) + 0.25);
        view.backdrop = backdrop;
        const Image image = draw(*slab, view, 40, 9);
        for (int x = 0; x < 40; ++x) {
            // Samples at 0, 0.5, … mm; those from 10.5 on lie in the slab.
            const double samples = std::max(0.0, std::floor((2.0 * x + 0.25) / 0.5) - 20.0);
            const double passed = std::pow(0.98, 0.5 * samples);
            if (1.0 - passed >= terminationOpacity) continue;
            EXPECT_NEAR(pixel(image, x, 4, 0), 255.0 * displayedOf(1.0 - passed), 1.0) << x;
            EXPECT_NEAR(pixel(image, x, 4, 2),
                        255.0 * displayedOf(1.0 - passed + passed * double(0.6f)), 1.0)
                << x;
        }
    }
}

}  // namespace
}  // namespace haustra::tests
