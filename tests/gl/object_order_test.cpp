// The object-order raycaster against the single pass, and its budget against none.
#include "reference_marcher.h"
#include "render/gl/single_pass_raycaster.h"
#include "render/object_order/object_order_raycaster.h"
#include "render_scene.h"

#include <random>

namespace haustra::tests {
namespace {

using namespace render;

class ObjectOrder : public Drawing {
protected:
    std::shared_ptr<const Scene> sceneOf(Volume<std::int16_t> volume) {
        BlockRanges ranges = blockRanges(volume, blockSide, 2);
        Scene scene;
        scene.volume = std::move(volume);
        scene.ranges = std::move(ranges);
        return std::make_shared<const Scene>(std::move(scene));
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
};

Grid tubeGrid() {
    return obliqueGrid({117, 98, 87}, {0.4, 0.5, 0.6});
}

/// From inside, from outside at faces, edges and corners, along cells' faces, by every lens.
std::vector<Camera> cameras() {
    std::vector<Camera> all;
    const auto add = [&](glm::dvec3 from, glm::dvec3 along, double fov,
                         Lens lens = Lens::perspective) {
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
    const auto small = objectOrder(scene, {.cellSide = 16}), large = objectOrder(scene, {});
    for (const auto& [name, optics] : models()) {
        int number = 0;
        for (const Camera& camera : cameras()) {
            const CameraView view{camera, optics, {}};
            const Image expected = drawn(*whole, view, {72, 53});
            for (ObjectOrderRaycaster* cells : {small.get(), large.get()})
                EXPECT_GE(psnr(drawn(*cells, view, {72, 53}), expected), 45.0)
                    << name << ", camera " << number;
            ++number;
        }
    }
}

/// A view of the tube in an aura: many cells show something.
CameraView misty(const Camera& camera) {
    CameraView view{camera, *opticsPreset("mucosa"), {}};
    view.optics.transferFunction = {{{-1100.0, glm::dvec3(0.4, 0.6, 0.9), 0.01},
                                     {-300.0, glm::dvec3(0.9, 0.6, 0.5), 0.02},
                                     {40.0, glm::dvec3(0.9, 0.5, 0.4), 0.2}}};
    return view;
}

TEST_F(ObjectOrder, NoPixelDependsOnTheBudgetOnWhatWasDrawnBeforeOrOnBands) {
    const auto scene = sceneOf(sampled(tubeGrid(), foldedTube));
    const auto roomy = objectOrder(scene, {.cellSide = 16});
    // Room for four cells of the many in a picture, and for one.
    const auto tight = objectOrder(scene, {.cellSide = 16, .budgetBytes = 64 * 64 * 32 * 2});
    const auto single = objectOrder(scene, {.cellSide = 16, .budgetBytes = 32 * 32 * 32 * 2});
    EXPECT_EQ(tight->gpuBytes() - single->gpuBytes(), std::size_t(64 * 64 * 32 - 32 * 32 * 32) * 2);
    std::vector<Image> first;
    for (const Camera& camera : cameras()) {
        first.push_back(drawn(*roomy, misty(camera), {72, 53}));
        EXPECT_TRUE(samePicture(first.back(), drawn(*tight, misty(camera), {72, 53})));
        EXPECT_GT(tight->residency().uploaded, tight->residency().resident);
        EXPECT_EQ(tight->residency().bytesMoved,
                  std::size_t(tight->residency().uploaded) * 23 * 23 * 23 * 2);
    }
    EXPECT_TRUE(samePicture(first[0], drawn(*single, misty(cameras()[0]), {72, 53})));
    // Again, the other way round; then in bands.
    const auto all = cameras();
    for (std::size_t i = all.size(); i-- > 0;)
        EXPECT_TRUE(samePicture(first[i], drawn(*roomy, misty(all[i]), {72, 53})));
    for (const std::size_t i : {0, 6, 8}) {
        Image banded{72, 53, std::vector<std::uint8_t>(3u * 72 * 53)};
        for (int row = 0; row < 53; row += 13)
            ASSERT_TRUE(
                roomy->render(misty(all[i]), {{72, 53}, row, std::min(13, 53 - row)}, banded));
        EXPECT_TRUE(samePicture(first[i], banded));
    }
}

TEST_F(ObjectOrder, WhatDoesNotFitIntoABatchIsNotOverwritten) {
    const auto scene = sceneOf(sampled(tubeGrid(), foldedTube));
    const auto roomy = objectOrder(scene, {.cellSide = 16});
    for (const int batchCells : {1, 2, 3, 5})
        for (const std::size_t slots : {1, 4, 8}) {
            const auto tight = objectOrder(scene, {.cellSide = 16,
                                                   .budgetBytes = slots * 32 * 32 * 32 * 2,
                                                   .batchCells = batchCells});
            for (const Camera& camera : {cameras()[0], cameras()[6]})
                EXPECT_TRUE(samePicture(drawn(*roomy, misty(camera), {40, 30}),
                                        drawn(*tight, misty(camera), {40, 30})))
                    << batchCells << " cells a batch, " << slots << " slots";
        }
}

TEST_F(ObjectOrder, ReadersOfDifferentFunctionsShareTheCells) {
    const auto scene = sceneOf(sampled(tubeGrid(), foldedTube));
    // They differ in how far beyond a cell its samples look.
    std::vector<CameraView> views;
    for (const auto& [name, optics] : models())
        views.push_back({cameras()[0], optics, {}});
    views.push_back({cameras()[1], views[4].optics, {.stepVoxels = 1.7}});
    views.back().optics.preIntegrated = false;
    std::vector<Image> alone;
    for (const CameraView& view : views)
        alone.push_back(drawn(*objectOrder(scene, {.cellSide = 16}), view, {64, 64}));
    const auto shared = objectOrder(scene, {.cellSide = 16});
    for (int round = 0; round < 3; ++round)
        for (std::size_t i = 0; i < views.size(); ++i) {
            EXPECT_TRUE(samePicture(drawn(*shared, views[i], {64, 64}), alone[i])) << i;
            if (round == 2) {
                EXPECT_EQ(shared->residency().uploaded, 0) << i;
            }
        }
}

TEST_F(ObjectOrder, CellsStayAndOnlyWhatIsSeenIsBrought) {
    const auto scene = sceneOf(sampled(tubeGrid(), foldedTube));
    const auto cells = objectOrder(scene, {.cellSide = 16});
    const CameraView inside{cameras()[0], *opticsPreset("mucosa"), {}};
    drawn(*cells, inside, {64, 64});
    const ResidencyStats first = cells->residency();
    EXPECT_GT(first.uploaded, 0);
    EXPECT_EQ(first.uploaded, first.visited);
    EXPECT_LE(first.visited, first.inView);
    EXPECT_LT(first.inView, first.nonEmpty);
    EXPECT_LT(first.nonEmpty, first.cells);
    EXPECT_EQ(first.cells, 8 * 7 * 6);
    drawn(*cells, inside, {64, 64});
    EXPECT_EQ(cells->residency().uploaded, 0);
    EXPECT_EQ(cells->residency().visited, first.visited);
    // Air alone: nothing to show.
    CameraView nothing = inside;
    nothing.optics.transferFunction = {
        {{3000.0, glm::dvec3(1.0), 0.0}, {3001.0, glm::dvec3(1.0), 1.0}}};
    for (const std::uint8_t value : drawn(*cells, nothing, {16, 16}).rgb)
        ASSERT_EQ(value, 0);
    EXPECT_EQ(cells->residency().nonEmpty, 0);
}

TEST_F(ObjectOrder, EndsRaysAtTheBackdropAndShowsItBehind) {
    const auto scene = sceneOf(sampled(tubeGrid(), foldedTube));
    const auto whole = singlePass(scene);
    const auto cells = objectOrder(scene, {.cellSide = 16});
    auto backdrop = std::make_shared<Backdrop>();
    backdrop->size = {60, 44};
    for (int i = 0; i < 60 * 44; ++i)
        backdrop->pixels.push_back({0.1f, 0.3f, 0.05f, 8.0f + float(i % 60)});
    for (CameraView view : {misty(cameras()[0]), misty(cameras()[3]), misty(cameras()[8])}) {
        view.backdrop = backdrop;
        const Image image = drawn(*cells, view, {60, 44});
        EXPECT_GE(psnr(image, drawn(*whole, view, {60, 44})), 55.0);
        view.backdrop = nullptr;
        EXPECT_NE(image.rgb, drawn(*cells, view, {60, 44}).rgb);
    }
}

TEST_F(ObjectOrder, DrawsCasesThatNoTextureHolds) {
    // Longer than the device's textures: near its end it looks like that end alone.
    const auto tube = [](glm::dvec3 p) { return foldedTube({p.x, p.y, 0.1 * p.z}); };
    const Grid grid = axisAlignedGrid({40, 36, 2100}, glm::dvec3(1.0), {-19.5, -17.5, 0.0});
    const Grid end = axisAlignedGrid({40, 36, 300}, glm::dvec3(1.0), {-19.5, -17.5, 1800.0});
    auto made =
        CaseRenderer::create(*context, sampled(grid, tube), {},
                             {.raycaster = RaycasterKind::objectOrder, .gpuBudgetBytes = 8 << 20});
    ASSERT_TRUE(made) << describe(made.error());
    const auto cut = renderer(sampled(end, tube));
    const CameraView view{
        {{1.0, 2.0, 1950.0}, {0.2, 0.1, 1.0}, {0, -1, 0}, 90.0}, *opticsPreset("mucosa"), {}};
    EXPECT_GE(psnr(draw(**made, view, 80, 60), draw(*cut, view, 80, 60)), 45.0);
    const SliceView slice{View::axial, {0.0, 0.0, 2050.0}, 1.0, {}};
    EXPECT_GE(psnr(draw(**made, slice, 40, 36), draw(*cut, slice, 40, 36)), 45.0);
    EXPECT_LT((*made)->gpuBytes(), std::size_t(40) << 20);
    const auto whole = (*made)->use(RaycasterKind::singlePass);
    ASSERT_FALSE(whole);
    EXPECT_EQ(whole.error().kind, ErrorKind::device);
    EXPECT_TRUE((*made)->render(view, 16, 16));
}

TEST_F(ObjectOrder, SaysWhatIsWrong) {
    const auto scene = sceneOf(sampled(tubeGrid(), foldedTube));
    const auto odd = ObjectOrderRaycaster::create(*context, scene, {.cellSide = 48});
    ASSERT_FALSE(odd);
    EXPECT_EQ(odd.error().kind, ErrorKind::badInput);
    EXPECT_NE(odd.error().message.find("48"), std::string::npos);
    const auto poor = ObjectOrderRaycaster::create(*context, scene, {.budgetBytes = 1000});
    ASSERT_FALSE(poor);
    EXPECT_EQ(poor.error().kind, ErrorKind::device);
}

}  // namespace
}  // namespace haustra::tests
