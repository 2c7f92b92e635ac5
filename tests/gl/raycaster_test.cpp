// The ray caster against closed forms and against a plain one on the CPU.
#include "reference_marcher.h"
#include "render_scene.h"

#include <numbers>
#include <random>

namespace haustra::tests {
namespace {

using namespace render;

using Raycaster = Drawing;

TEST_F(Raycaster, AUniformSlabHasTheClosedFormOpacityForAnyStep) {
    // 40 mm thick along z; the eye lies a quarter voxel off the lattice, so that exactly
    // thickness / step samples fall inside.
    const Grid grid = axisAlignedGrid({33, 33, 80}, glm::dvec3(0.5));
    const auto slab = renderer(Volume<std::int16_t>(grid, 100));
    for (const double opacity : {0.005, 0.02, 0.05}) {
        for (const auto& [stepVoxels, preIntegrated] : {std::pair(0.125, false),
                                                        {0.25, false},
                                                        {0.5, false},
                                                        {1.0, false},
                                                        {2.0, false},
                                                        {0.125, true},
                                                        {0.5, true},
                                                        {1.0, true}}) {
            CameraView view;
            view.optics.preIntegrated = preIntegrated;
            view.camera = {
                {8.0, 8.0, -0.25 - 10.0 + 0.25 * stepVoxels * 0.5}, {0, 0, 1}, {0, -1, 0}, 2.0};
            view.optics.transferFunction = everywhere(opacity);
            view.march.stepVoxels = stepVoxels;
            view.optics.shading = false;
            const Image image = draw(*slab, view, 9, 9);
            const double expected = 255.0 * displayedOf(1.0 - std::pow(1.0 - opacity, 40.0));
            EXPECT_NEAR(pixel(image, 4, 4), expected, 1.0)
                << "opacity " << opacity << " step " << stepVoxels;
        }
    }
}

TEST_F(Raycaster, ALinearRampIsLitByTheAngleBetweenItsGradientAndTheRay) {
    // Oblique axes and unequal spacing: only the inverse transpose gives the right normal.
    const Grid grid = obliqueGrid({60, 50, 40}, {0.7, 0.9, 1.5});
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    const auto ramp =
        renderer(sampled(grid, [&](glm::dvec3 p) { return 40.0 * glm::dot(p, towards); }));
    const glm::dvec3 aside = glm::normalize(glm::cross(towards, glm::dvec3(1, 0, 0)));
    for (const double angle : {0.0, 20.0, 40.0, 60.0, 75.0}) {
        const double a = glm::radians(angle);
        CameraView view;
        const glm::dvec3 ray = std::cos(a) * towards + std::sin(a) * aside;
        const double distanceMm = 10.0;
        view.camera = {-distanceMm * ray, ray, glm::cross(towards, aside), 1.0};
        view.optics.transferFunction = surfaceAt(0.0);
        view.march.stepVoxels = 0.05;
        const Image image = draw(*ramp, view, 5, 5);
        const double depth = distanceMm / headlight.halfDepthMm, facing = std::cos(a);
        const double gloss =
            headlight.specular * std::pow(std::max(std::cos(2.0 * a), 0.0), headlight.shininess);
        const double light =
            (headlight.ambient + headlight.diffuse * facing + gloss) / (1.0 + depth * depth);
        EXPECT_NEAR(pixel(image, 2, 2), 255.0 * displayedOf(std::min(light, 1.0)), 1.5)
            << angle << " degrees";
    }
}

class Sphere : public Drawing {
protected:
    static constexpr double radiusMm = 14.0, distanceMm = 32.0, fovDegrees = 70.0;
    static constexpr int size = 201;

    /// Light linear in the pixel, of a ball whose HU falls linearly with the radius.
    Image picture(const Grid& grid) {
        const auto ball = renderer(
            sampled(grid, [](glm::dvec3 p) { return 60.0 * (radiusMm - glm::length(p)); }));
        CameraView view;
        view.camera = {{0, 0, -distanceMm}, {0, 0, 1}, {0, -1, 0}, fovDegrees};
        view.optics.transferFunction = surfaceAt(0.0);
        view.march.stepVoxels = 0.1;
        return draw(*ball, view, size, size);
    }
    static double slopeOf(double pixelsFromCenter) {
        return std::tan(glm::radians(fovDegrees) / 2.0) * 2.0 * pixelsFromCenter / size;
    }
};

TEST_F(Sphere, SilhouetteHasTheAnalyticRadius) {
    const Image image =
        picture(axisAlignedGrid({56, 56, 40}, {0.7, 0.7, 1.0}, {-19.25, -19.25, -19.5}));
    int lit = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            lit += pixel(image, x, y) > 8;
    const double tangent = radiusMm / std::sqrt(distanceMm * distanceMm - radiusMm * radiusMm);
    const double expected = tangent / slopeOf(1.0);
    EXPECT_NEAR(std::sqrt(lit / std::numbers::pi), expected, 0.5);
}

TEST_F(Sphere, LightFollowsTheAnalyticNormals) {
    for (const Grid& grid :
         {axisAlignedGrid({56, 56, 40}, {0.7, 0.7, 1.0}, {-19.25, -19.25, -19.5}),
          obliqueGrid({60, 52, 40}, {0.7, 0.8, 1.1})}) {
        const Image image = picture(grid);
        for (const glm::ivec2 offset :
             {glm::ivec2(0, 0), {20, 0}, {0, -30}, {-25, 25}, {40, 10}, {-5, 50}}) {
            const glm::dvec3 ray =
                glm::normalize(glm::dvec3(slopeOf(offset.x), slopeOf(offset.y), 1.0));
            const glm::dvec3 eye(0, 0, -distanceMm);
            const double along = -glm::dot(eye, ray);
            const double discriminant =
                along * along - distanceMm * distanceMm + radiusMm * radiusMm;
            ASSERT_GT(discriminant, 0.0);
            const double hitMm = along - std::sqrt(discriminant);
            const double facing = -glm::dot(glm::normalize(eye + hitMm * ray), ray);
            const double depth = hitMm / headlight.halfDepthMm;
            const double gloss =
                headlight.specular *
                std::pow(std::max(2.0 * facing * facing - 1.0, 0.0), headlight.shininess);
            const double light =
                (headlight.ambient + headlight.diffuse * facing + gloss) / (1.0 + depth * depth);
            EXPECT_NEAR(linearOf(pixel(image, size / 2 + offset.x, size / 2 + offset.y) / 255.0),
                        std::min(light, 1.0), 0.03)
                << "at " << offset.x << ", " << offset.y;
        }
    }
}

std::vector<CameraView> tubeViews() {
    std::vector<CameraView> views;
    for (const char* name : {"mucosa", "translucent"}) {
        const Optics function = *opticsPreset(name);
        views.push_back({{{1.0, -2.0, -14.0}, {0.1, 0.05, 1.0}, {0, -1, 0}, 90.0}, function, {}});
        views.push_back({{{-3.0, 2.0, 8.0}, {-0.8, 0.3, -0.4}, {0, 0, 1}, 120.0}, function, {}});
        views.push_back({{{60.0, -55.0, -70.0}, {-0.6, 0.55, 0.7}, {0, 0, 1}, 40.0}, function, {}});
    }
    return views;
}

TEST_F(Raycaster, LeapingChangesNoPixel) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-60.0, 60.0);
    for (const Grid& grid : {obliqueGrid({61, 58, 47}, {0.7, 0.7, 1.0}),
                             axisAlignedGrid({50, 43, 64}, {1.0, 1.1, 0.6}, {-25, -24, -19})}) {
        const auto tube =
            renderer(sampled(grid, [&](glm::dvec3 p) { return foldedTube(p) + noise(random); }));
        for (CameraView view : tubeViews()) {
            const Image leaping = draw(*tube, view, 150, 101);
            view.march.emptySpaceLeaping = false;
            EXPECT_EQ(leaping.rgb, draw(*tube, view, 150, 101).rgb);
        }
    }
}

TEST_F(Raycaster, AgreesWithAPlainOneOnTheCpu) {
    const Grid grid = obliqueGrid({61, 58, 47}, {0.7, 0.7, 1.0});
    const Volume<std::int16_t> volume = sampled(grid, foldedTube);
    const auto tube = renderer(volume);
    for (const CameraView& view : tubeViews()) {
        const Image image = draw(*tube, view, 96, 64);
        EXPECT_GE(psnr(image, referenceEndoscopic(volume, view, 96, 64)), 45.0);
    }
}

TEST_F(Raycaster, EqualInputsGiveEqualPixels) {
    const Volume<std::int16_t> volume =
        sampled(obliqueGrid({61, 58, 47}, {0.7, 0.7, 1.0}), foldedTube);
    std::vector<Image> first;
    const auto one = renderer(volume, {}, 1);
    for (const CameraView& view : tubeViews())
        first.push_back(draw(*one, view, 120, 90));
    SliceView slice;
    slice.plane = View::coronal;
    const Image firstSlice = draw(*one, slice, 77, 200);
    // In another order, with another picture between, in another renderer, on more threads.
    const auto two = renderer(volume, {}, 3);
    const auto views = tubeViews();
    for (std::size_t i = views.size(); i-- > 0;) {
        draw(*two, views[0], 33, 21);
        EXPECT_EQ(draw(*two, views[i], 120, 90).rgb, first[i].rgb);
    }
    EXPECT_EQ(draw(*two, slice, 77, 200).rgb, firstSlice.rgb);
}

TEST_F(Raycaster, ShowsTheCleansedScanWhereThereIsOne) {
    // A tube half full of dense fluid, whose level blocks the view down.
    const Grid grid = axisAlignedGrid({60, 60, 50}, glm::dvec3(0.8), {-23.6, -23.6, -19.6});
    const Volume<std::int16_t> dry = sampled(grid, foldedTube);
    const Volume<std::int16_t> ct = sampled(grid, [&](glm::dvec3 p) {
        return foldedTube(p) < -480.0 && p.y > 2.0 ? 700.0 : foldedTube(p);
    });
    CameraView down;
    down.camera = {{0.0, -4.0, 0.0}, {0, 1, 0}, {0, 0, 1}, 60.0};
    down.optics.transferFunction = surfaceAt(-480.0);
    const Image level = draw(*renderer(ct), down, 31, 31);
    const Image wall = draw(*renderer(ct, dry), down, 31, 31);
    EXPECT_EQ(wall.rgb, draw(*renderer(dry), down, 31, 31).rgb);
    EXPECT_EQ(level.rgb, draw(*renderer(ct, ct), down, 31, 31).rgb);
    // The wall lies 10 mm deeper than the level: the lamp's fall-off tells.
    EXPECT_GT(pixel(level, 15, 15), pixel(wall, 15, 15) + 4);
}

TEST_F(Raycaster, SaysWhatIsWrong) {
    const auto tube = renderer(sampled(axisAlignedGrid({20, 20, 20}, glm::dvec3(1.0)), foldedTube));
    CameraView good;
    good.optics = *opticsPreset("mucosa");
    EXPECT_TRUE(tube->render(good, 16, 16));
    const auto refuses = [&](const CameraView& view, int width, int height, const char* words) {
        const auto made = tube->render(view, width, height);
        ASSERT_FALSE(made) << words;
        EXPECT_EQ(made.error().kind, ErrorKind::badInput);
        EXPECT_NE(describe(made.error()).find(words), std::string::npos) << describe(made.error());
    };
    refuses(good, 0, 16, "0x16");
    refuses(good, 16, 2049, "16x2049");
    CameraView bad = good;
    bad.optics.transferFunction.points.resize(1);
    refuses(bad, 16, 16, "1 points");
    bad = good;
    std::swap(bad.optics.transferFunction.points[0].hu, bad.optics.transferFunction.points[1].hu);
    refuses(bad, 16, 16, "lower HU");
    bad = good;
    bad.optics.transferFunction.points[1].opacity = std::nan("");
    refuses(bad, 16, 16, "point 2");
    bad = good;
    bad.camera.up = bad.camera.forward;
    refuses(bad, 16, 16, "camera");
    bad = good;
    bad.camera.positionMm.x = INFINITY;
    refuses(bad, 16, 16, "finite");
    bad = good;
    bad.march.stepVoxels = 0.0;
    refuses(bad, 16, 16, "sampling");
}

TEST_F(Raycaster, RefusesScansThatCannotBeDrawn) {
    const Grid longGrid = axisAlignedGrid({2, 2, 2049}, glm::dvec3(1.0));
    const auto tooLong = CaseRenderer::create(*context, Volume<std::int16_t>(longGrid, 0), {});
    ASSERT_FALSE(tooLong);
    EXPECT_EQ(tooLong.error().kind, ErrorKind::device);
    EXPECT_NE(tooLong.error().message.find("2x2x2049"), std::string::npos);

    const Grid grid = axisAlignedGrid({4, 4, 4}, glm::dvec3(1.0));
    const auto elsewhere = CaseRenderer::create(*context, Volume<std::int16_t>(grid, 0),
                                                Volume<std::int16_t>(longGrid, 0));
    ASSERT_FALSE(elsewhere);
    EXPECT_EQ(elsewhere.error().kind, ErrorKind::badInput);
}

TEST_F(Raycaster, ThinScansAndFarCamerasDraw) {
    for (const glm::ivec3 size :
         {glm::ivec3(1, 1, 1), {1, 30, 30}, {30, 1, 2}, {2, 2, 2}, {3, 4, 5}}) {
        const auto made =
            renderer(Volume<std::int16_t>(axisAlignedGrid(size, glm::dvec3(1.0)), 100));
        for (const double away : {0.0, -5.0, -1e4, -1e9}) {
            CameraView view;
            view.camera.positionMm.z = away;
            view.optics.transferFunction = everywhere(0.5);
            draw(*made, view, 20, 20);
        }
    }
}

TEST_F(Raycaster, CountsItsGpuMemory) {
    const Grid grid = axisAlignedGrid({64, 64, 64}, glm::dvec3(1.0));
    const auto plain = renderer(Volume<std::int16_t>(grid, 0));
    const auto unchanged = renderer(Volume<std::int16_t>(grid, 0), Volume<std::int16_t>(grid, 0));
    const auto changed = renderer(Volume<std::int16_t>(grid, 0), Volume<std::int16_t>(grid, 1));
    EXPECT_GE(plain->gpuBytes(), 2 * grid.voxelCount());
    EXPECT_EQ(unchanged->gpuBytes(), plain->gpuBytes());
    EXPECT_EQ(changed->gpuBytes() - plain->gpuBytes(), 2 * grid.voxelCount());
}

}  // namespace
}  // namespace haustra::tests
