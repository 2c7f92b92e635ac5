// The object-order raycaster against the single pass, and its budget against none.
#include "reference_marcher.h"
#include "render/object_order/object_order_raycaster.h"
#include "render/single_pass_raycaster.h"
#include "render_scene.h"

#include <random>

namespace haustra::tests {
namespace {

using namespace render;

class ObjectOrder : public Drawing {
protected:
    std::shared_ptr<const Scene> sceneOf(Volume<std::int16_t> volume) {
        BlockRanges ranges = blockRanges(volume, 2);
        return std::make_shared<const Scene>(
            Scene{std::move(volume), std::move(ranges), nullptr, nullptr});
    }
    std::unique_ptr<Raycaster> singlePass(std::shared_ptr<const Scene> scene) {
        auto onGpu = GlScene::upload(*context, std::move(scene), 2);
        EXPECT_TRUE(onGpu);
        auto made = SinglePassRaycaster::create(std::move(*onGpu));
        EXPECT_TRUE(made) << describe(made.error());
        return std::move(*made);
    }
    std::unique_ptr<ObjectOrderRaycaster> objectOrder(std::shared_ptr<const Scene> scene,
                                                      ObjectOrderOptions options) {
        auto made = ObjectOrderRaycaster::create(*context, std::move(scene), options);
        EXPECT_TRUE(made) << describe(made.error());
        return std::move(*made);
    }
    static Image cast(Raycaster& raycaster, const CameraView& view, int width, int height) {
        Image image{width, height, std::vector<std::uint8_t>(3u * unsigned(width * height))};
        const auto drawn = raycaster.render(view, Band::whole(width, height), image);
        EXPECT_TRUE(drawn) << describe(drawn.error());
        return image;
    }
};

Grid tubeGrid() { return obliqueGrid({117, 98, 87}, {0.4, 0.5, 0.6}); }

/// From inside, from outside at faces, edges and corners, along cells' faces, by every lens.
std::vector<Camera> cameras() {
    std::vector<Camera> all;
    const auto add = [&](glm::dvec3 from, glm::dvec3 along, double fov, Lens lens = Lens::perspective) {
        all.push_back({from, along, glm::dvec3(0.1, -1.0, 0.3), fov, lens, 50.0});
    };
    add({1.0, -2.0, -14.0}, {0.1, 0.05, 1.0}, 90.0);
    add({-3.0, 2.0, 8.0}, {-0.8, 0.3, -0.4}, 120.0);
    add({60.0, -55.0, -70.0}, {-0.6, 0.55, 0.7}, 40.0);
    add({0.0, 0.0, -80.0}, {0.0, 0.0, 1.0}, 45.0);
    add({70.0, 0.0, 70.0}, {-1.0, 0.0, -1.0}, 40.0);
    add({1.0, -2.0, -4.0}, {0.1, 0.05, 1.0}, 180.0, Lens::fisheye);
    add({1.0, -2.0, -4.0}, {0.7, 0.05, -1.0}, 330.0, Lens::fisheye);
    add({-60.0, 55.0, 70.0}, {0.6, -0.55, -0.7}, 60.0, Lens::fisheye);
    add({60.0, -55.0, -70.0}, {-0.6, 0.55, 0.7}, 0.0, Lens::orthographic);
    add({0.0, 0.0, 0.0}, {0.0, 0.3, -1.0}, 0.0, Lens::orthographic);
    return all;
}

std::vector<std::pair<std::string, Optics>> models() {
    std::vector<std::pair<std::string, Optics>> all;
    all.emplace_back("opaque", *opticsPreset("mucosa"));
    all.emplace_back("translucent", *opticsPreset("translucent"));
    Optics one = *opticsPreset("translucent");
    one.preIntegrated = true;
    all.emplace_back("pre-integrated", one);
    one = *opticsPreset("translucent");
    one.composition = Composition::maximumIntensity;
    all.emplace_back("greatest", one);
    one = *opticsPreset("mucosa");
    one.composition = Composition::firstHit;
    all.emplace_back("first hit", one);
    one = *opticsPreset("translucent");
    GradientRow steep{400.0, one.transferFunction.points};
    for (auto& point : steep.points)
        point.color = glm::dvec3(0.2, 0.9, 0.4), point.opacity *= 0.5;
    one.transferFunction.rows = {steep};
    all.emplace_back("by gradient", one);
    return all;
}

TEST_F(ObjectOrder, ShowsWhatTheSinglePassShows) {
    const auto scene = sceneOf(sampled(tubeGrid(), foldedTube));
    const auto whole = singlePass(scene);
    for (const int side : {16, 64}) {
        const auto cells = objectOrder(scene, {.cellSide = side});
        for (const auto& [name, optics] : models()) {
            int number = 0;
            for (const Camera& camera : cameras()) {
                const CameraView view{camera, optics, {}};
                const Image expected = cast(*whole, view, 120, 88);
                const Image image = cast(*cells, view, 120, 88);
                int apart = 0;
                for (std::size_t i = 0; i < image.rgb.size(); ++i)
                    apart += std::abs(image.rgb[i] - expected.rgb[i]) > 2;
                EXPECT_GE(psnr(image, expected), 55.0)
                    << name << ", camera " << number << ", side " << side << ": " << apart
                    << " differ";
                ++number;
            }
        }
    }
}

}  // namespace
}  // namespace haustra::tests
