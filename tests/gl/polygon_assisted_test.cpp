// Rays that begin at the wall's mesh, and the wall's paint.
#include "reference_marcher.h"
#include "render/gl/single_pass_raycaster.h"
#include "render/optics/optics_presets.h"
#include "render/polygon_assisted/polygon_assisted_raycaster.h"
#include "wall_scene.h"

#include <map>
#include <optional>

namespace haustra::tests {
namespace {

using namespace render;

class PolygonAssisted : public Drawing {
protected:
    /// The volume with a mesh of the wall.
    std::shared_ptr<GlScene> scene(const Volume<std::int16_t>& volume, const TriMesh& wall) {
        auto made = GlScene::upload(*context,
                                    std::make_shared<const Scene>(Scene{
                                        volume.share(), blockRanges(volume, blockSide, 0),
                                        std::make_shared<const TriMesh>(wall), nullptr, nullptr}),
                                    0);
        if (!made) ADD_FAILURE() << describe(made.error());
        return std::move(*made);
    }
    static std::vector<CameraView> insideViews() {
        std::vector<CameraView> views;
        for (const auto& name : opticsPresets()) {
            const Optics optics = *opticsPreset(name);
            views.push_back({{{1, -2, -9}, {0.1, 0.05, 1.0}, {0, -1, 0}, 90.0}, optics, {}});
            views.push_back({{{-3, 2, 8}, {-0.8, 0.3, -0.4}, {0, 0, 1}, 120.0}, optics, {}});
            views.push_back({{{0, 0, 0}, {1.0, 0.2, 0.1}, {0, 0, 1}, 60.0}, optics, {0.31}});
        }
        return views;
    }
    const Grid grid = obliqueGrid({71, 68, 57}, {0.7, 0.7, 1.0});
    const Tube tube = makeTube(120);
};

TEST_F(PolygonAssisted, DrawsWhatTheSinglePassDraws) {
    // With residue before the mesh, and with a mesh that misses the wall by a millimetre and more.
    Tube coarse = makeTube(12);
    for (const auto& [field, mesh] : std::vector<std::pair<double (*)(glm::dvec3), const TriMesh*>>{
             {closedTube, &tube.wall}, {tubeWithResidue, &tube.wall}, {closedTube, &coarse.wall}}) {
        const auto shared = scene(sampled(grid, field), *mesh);
        const auto plain = *SinglePassRaycaster::create(shared);
        const auto assisted = *PolygonAssistedRaycaster::create(shared, 0);
        int began = 0;
        for (const CameraView& view : insideViews()) {
            const Image expected = drawn(*plain, view, {150, 101});
            EXPECT_GE(psnr(drawn(*assisted, view, {150, 101}), expected), 60.0);
            began += assisted->beganAtMesh();
        }
        EXPECT_GT(began, 0);
    }
}

TEST_F(PolygonAssisted, BeginsAsTheSinglePassWhereTheMeshTellsNothing) {
    const auto shared = scene(sampled(grid, closedTube), tube.wall);
    const auto plain = *SinglePassRaycaster::create(shared);
    const auto assisted = *PolygonAssistedRaycaster::create(shared, 0);
    std::vector<CameraView> views;
    CameraView view = insideViews().front();
    ASSERT_EQ(drawn(*assisted, view, {50, 40}).rgb, drawn(*plain, view, {50, 40}).rgb);
    ASSERT_TRUE(assisted->beganAtMesh());
    view.camera.lens = Lens::fisheye;
    view.camera.fovDegrees = 200.0;
    views.push_back(view);
    view.camera.lens = Lens::orthographic;
    view.camera.heightMm = 15.0;
    views.push_back(view);
    view = insideViews().front();
    view.march.emptySpaceLeaping = false;
    views.push_back(view);
    view = insideViews().front();
    view.camera.positionMm = {60.0, -55.0, -70.0};
    view.camera.forward = -view.camera.positionMm;
    views.push_back(view);
    view.camera.positionMm = {14.0, 0.0, 5.2};  // in the wall
    views.push_back(view);
    view.camera.positionMm = {14.0, 0.0, -5.2};
    views.push_back(view);
    view = insideViews().front();
    view.optics.transferFunction = everywhere(0.01);
    views.push_back(view);
    for (const CameraView& one : views) {
        EXPECT_EQ(drawn(*assisted, one, {90, 61}).rgb, drawn(*plain, one, {90, 61}).rgb);
        EXPECT_FALSE(assisted->beganAtMesh());
    }
}

TEST_F(PolygonAssisted, FindsResidueAndNothingWhereTheLumenIsClean) {
    const CameraView view = insideViews().front();
    const auto count = [&](double (*field)(glm::dvec3)) {
        const auto assisted =
            *PolygonAssistedRaycaster::create(scene(sampled(grid, field), tube.wall), 0);
        drawn(*assisted, view, {20, 20});
        return assisted->blocksBefore();
    };
    const std::size_t clean = count(closedTube), dirty = count(tubeWithResidue);
    // A ball of 2 mm and what the transfer function shows of its blur, in blocks of 4 mm³.
    EXPECT_GT(dirty, clean + 10);
    EXPECT_LT(dirty, clean + 300);
}

TEST_F(PolygonAssisted, ReadersWithTheirOwnColoursDoNotTakeEachOthers) {
    const auto shared = scene(sampled(grid, tubeWithResidue), tube.wall);
    const auto plain = *SinglePassRaycaster::create(shared);
    const auto assisted = *PolygonAssistedRaycaster::create(shared, 0);
    CameraView one = insideViews().front(), other = one;
    other.optics.transferFunction = surfaceAt(-300.0);
    const Image expected[] = {drawn(*plain, one, {75, 51}), drawn(*plain, other, {75, 51})};
    drawn(*assisted, one, {75, 51});
    const std::size_t blocks = assisted->blocksBefore(), bytes = assisted->gpuBytes();
    for (int i = 0; i < 20; ++i) {
        EXPECT_GE(psnr(drawn(*assisted, i % 2 ? other : one, {75, 51}), expected[i % 2]), 60.0);
        EXPECT_EQ(assisted->blocksBefore() == blocks, i % 2 == 0);
    }
    EXPECT_EQ(assisted->searches(), 2);
    // The faces of both are counted.
    EXPECT_GT(assisted->gpuBytes(), bytes);
}

TEST_F(PolygonAssisted, BandsMakeTheWholePicture) {
    const auto assisted =
        *PolygonAssistedRaycaster::create(scene(sampled(grid, tubeWithResidue), tube.wall), 0);
    for (const CameraView& view : insideViews()) {
        const Image whole = drawn(*assisted, view, {120, 90});
        EXPECT_GE(psnr(drawn(*assisted, view, {120, 90}, 37), whole), 70.0);
    }
}

TEST_F(PolygonAssisted, RefusesWhatIsNoClosedMesh) {
    const Volume<std::int16_t> volume = sampled(grid, closedTube);
    const auto refuses = [&](const TriMesh& mesh, const char* words) {
        const auto made = PolygonAssistedRaycaster::create(scene(volume, mesh), 0);
        ASSERT_FALSE(made);
        EXPECT_EQ(made.error().kind, ErrorKind::badInput);
        EXPECT_NE(describe(made.error()).find(words), std::string::npos) << describe(made.error());
    };
    refuses({}, "not closed");
    refuses(tube.map.surface, "not closed");
    TriMesh wrong = tube.wall;
    wrong.triangles.back().y = int(wrong.vertices.size());
    refuses(wrong, "vertices");
    const auto none = PolygonAssistedRaycaster::create(
        *GlScene::upload(
            *context,
            std::make_shared<const Scene>(Scene{volume.share(), blockRanges(volume, blockSide, 0),
                                                nullptr, nullptr, nullptr}),
            0),
        0);
    EXPECT_FALSE(none);
}

}  // namespace
}  // namespace haustra::tests
