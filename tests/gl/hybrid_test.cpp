// The hybrid raycaster against the single pass, whatever its controls.
#include "reference_marcher.h"
#include "render/gl/single_pass_raycaster.h"
#include "render/hybrid/hybrid_raycaster.h"
#include "render/optics/optics_presets.h"
#include "wall_scene.h"

namespace haustra::tests {
namespace {

using namespace render;

class Hybrid : public Drawing {
protected:
    std::shared_ptr<GlScene> scene(double (*field)(glm::dvec3)) {
        const Volume<std::int16_t> volume = sampled(grid, field);
        auto made = GlScene::upload(
            *context,
            std::make_shared<const Scene>(Scene{volume.share(), blockRanges(volume, blockSide, 0),
                                                nullptr, nullptr, nullptr}),
            0);
        if (!made) ADD_FAILURE() << describe(made.error());
        return std::move(*made);
    }
    static std::vector<Camera> cameras() {
        std::vector<Camera> cameras = {{{1, -2, -13}, {0.1, 0.05, 1.0}, {0, -1, 0}, 90.0},
                                       {{60, -55, -70}, {-0.6, 0.55, 0.7}, {0, 0, 1}, 40.0}};
        Camera other = cameras[0];
        other.lens = Lens::fisheye;
        other.fovDegrees = 240.0;
        cameras.push_back(other);
        other = cameras[1];
        other.lens = Lens::orthographic;
        other.heightMm = 55.0;
        cameras.push_back(other);
        return cameras;
    }
    static TransferFunction translucent() {
        return {{{-900.0, {0.9, 0.5, 0.4}, 0.0},
                 {-400.0, {0.9, 0.5, 0.4}, 0.08},
                 {40.0, {1.0, 0.9, 0.8}, 0.02}},
                {}};
    }
    /// Every way in which a ray's samples make its pixel.
    static std::vector<Optics> allOptics() {
        std::vector<Optics> all = {*opticsPreset("mucosa")};
        Optics optics;
        optics.transferFunction = translucent();
        all.push_back(optics);
        optics.preIntegrated = true;
        all.push_back(optics);
        optics.transferFunction = surfaceAt(-300.0);
        all.push_back(optics);
        optics.preIntegrated = false;
        optics.shading = false;
        all.push_back(optics);
        optics.composition = Composition::firstHit;
        optics.shading = true;
        all.push_back(optics);
        optics.composition = Composition::maximumIntensity;
        optics.transferFunction = translucent();
        all.push_back(optics);
        return all;
    }
    const Grid grid = obliqueGrid({71, 68, 57}, {0.7, 0.7, 1.0});
};

TEST_F(Hybrid, DrawsTheSinglePassesPixelsWhateverItsControls) {
    const auto shared = scene(tubeWithResidue);
    const auto plain = *SinglePassRaycaster::create(shared);
    std::vector<std::unique_ptr<HybridRaycaster>> hybrids;
    for (const int split : {0, 2, 4, 6, 8})
        hybrids.push_back(*HybridRaycaster::create(shared, {0, hybridSplits[std::size_t(split)]}));
    for (const Optics& optics : allOptics()) {
        for (const Camera& camera : cameras()) {
            const CameraView view{camera, optics, {}};
            const Image expected = drawn(*plain, view, {75, 51});
            for (const auto& hybrid : hybrids) {
                // To the bit, but where the GPU interpolates otherwise than the CPU.
                EXPECT_GE(psnr(drawn(*hybrid, view, {75, 51}), expected), 60.0)
                    << "composition " << int(optics.composition) << " lens " << int(camera.lens)
                    << " entry level " << hybrid->stats().controls.entryLevel;
            }
        }
    }
}

TEST_F(Hybrid, StopsShortOfABoundaryThatIsManySamplesAway) {
    const auto shared = scene(tubeWithResidue);
    const auto plain = *SinglePassRaycaster::create(shared);
    const auto hybrid = *HybridRaycaster::create(shared, {0, hybridSplits[8]});
    CameraView view{cameras()[0], *opticsPreset("mucosa"), {}};
    view.march.stepVoxels = 0.05;  // forty samples and more to a leaf
    EXPECT_GE(psnr(drawn(*hybrid, view, {48, 32}), drawn(*plain, view, {48, 32})), 60.0);
}

TEST_F(Hybrid, EndsRaysAtTheBackdrop) {
    const auto shared = scene(closedTube);
    const auto plain = *SinglePassRaycaster::create(shared);
    const auto hybrid = *HybridRaycaster::create(shared, {0, hybridSplits[7]});
    CameraView view{cameras()[0], {}, {}};
    view.optics.transferFunction = translucent();
    auto backdrop = std::make_shared<Backdrop>();
    backdrop->size = {64, 48};
    for (int i = 0; i < 64 * 48; ++i)
        backdrop->pixels.push_back({0.2, 0.3, 0.1 * (i % 7), 3.0f + float(i % 64) * 0.5f});
    view.backdrop = backdrop;
    EXPECT_EQ(drawn(*hybrid, view, {64, 48}).rgb, drawn(*plain, view, {64, 48}).rgb);
}

TEST_F(Hybrid, BandsMakeTheWholePicture) {
    const auto shared = scene(tubeWithResidue);
    const auto hybrid = *HybridRaycaster::create(shared);
    for (const Camera& camera : cameras()) {
        const CameraView view{camera, *opticsPreset("mucosa"), {}};
        EXPECT_EQ(drawn(*hybrid, view, {91, 77}).rgb, drawn(*hybrid, view, {91, 77}, 30).rgb);
    }
}

TEST_F(Hybrid, FollowsRaysToTheirEndsSoThatTheGpuCastsFewQuads) {
    const auto shared = scene(closedTube);
    CameraView view{cameras()[0], {}, {}};
    view.optics.transferFunction = surfaceAt(-300.0);
    const auto cost = [&](const HybridControls& controls) {
        const auto hybrid = *HybridRaycaster::create(shared, {0, controls});
        drawn(*hybrid, view, {64, 64});
        return hybrid->stats();
    };
    const HybridStats followed = cost({0, false, 0, 0.0}), left = cost({0, false, -1, 1.01});
    EXPECT_EQ(followed.quads, 32 * 32);
    EXPECT_EQ(left.quadsFilled, 32 * 32);  // from inside, every ray meets the wall
    EXPECT_EQ(left.quadsCast, 0);
    // The wall is opaque within a slab or two of where it begins.
    EXPECT_GE(followed.quadsCast, followed.quads - followed.quadsFilled);
    EXPECT_LE(followed.quadsCast, 2 * followed.quads);
    EXPECT_LT(followed.quadsFilled, followed.quads / 2);
    // A translucent medium ends no ray before its last sample.
    view.optics.transferFunction = everywhere(0.01);
    EXPECT_GT(cost({0, false, 0, 0.0}).passes, 2);
}

TEST_F(Hybrid, ReadersWithTheirOwnColoursDoNotTakeEachOthers) {
    const auto shared = scene(tubeWithResidue);
    const auto plain = *SinglePassRaycaster::create(shared);
    const auto hybrid = *HybridRaycaster::create(shared);
    CameraView one{cameras()[0], *opticsPreset("mucosa"), {}}, other = one;
    other.optics.transferFunction = translucent();
    const Image expected[] = {drawn(*plain, one, {75, 51}), drawn(*plain, other, {75, 51})};
    for (int i = 0; i < 20; ++i)
        EXPECT_GE(psnr(drawn(*hybrid, i % 2 ? other : one, {75, 51}), expected[i % 2]), 60.0);
    EXPECT_EQ(hybrid->classifications(), 2);
    // Of more readers than that the latest are known.
    for (int i = 0; i < 12; ++i) {
        one.optics.light.ambient = 0.1 + 0.01 * (i % 6);
        drawn(*hybrid, one, {20, 20});
    }
    EXPECT_EQ(hybrid->classifications(), 14);
}

TEST_F(Hybrid, PixelsAreTheSameWhateverTheBalanceAsks) {
    const auto shared = scene(tubeWithResidue);
    const auto plain = *SinglePassRaycaster::create(shared);
    const auto hybrid = *HybridRaycaster::create(shared);
    const CameraView view{cameras()[1], *opticsPreset("mucosa"), {}};
    const Image expected = drawn(*plain, view, {75, 51});
    std::vector<HybridControls> asked;
    for (int i = 0; i < 100; ++i) {
        EXPECT_GE(psnr(drawn(*hybrid, view, {75, 51}), expected), 60.0);
        const HybridControls& controls = hybrid->stats().controls;
        if (std::find(asked.begin(), asked.end(), controls) == asked.end())
            asked.push_back(controls);
    }
    EXPECT_EQ(asked.front(), hybridSplits.front());
    EXPECT_GE(asked.size(), 2u);
}

TEST_F(Hybrid, NothingToSeeCostsNoPass) {
    const auto shared = scene(closedTube);
    const auto hybrid = *HybridRaycaster::create(shared);
    CameraView view{cameras()[0], {}, {}};
    view.optics.transferFunction = surfaceAt(3000.0);
    const Image picture = drawn(*hybrid, view, {40, 40});
    EXPECT_EQ(*std::max_element(picture.rgb.begin(), picture.rgb.end()), 0);
    EXPECT_EQ(hybrid->stats().passes, 0);
    EXPECT_EQ(hybrid->stats().quadsFilled, 0);
}

}  // namespace
}  // namespace haustra::tests
