// Slices and flattened views of the CPU against those of the GPU and against plain ones.
#include "core/slice_placement.h"
#include "flat_reference.h"
#include "flat_tube.h"
#include "render/flat/flat_coverage.h"
#include "render/gl/flat_painter.h"
#include "render_scene.h"

#include <random>

namespace haustra::tests {
namespace {

using namespace render;

class NativePictures : public Drawing {
protected:
    static constexpr glm::ivec2 cells{48, 80};

    static FlatTube tube() {
        FlatTubeShape shape;
        shape.lengthMm = 45.0;
        shape.leanMm = 8.0;
        return FlatTube(shape);
    }
    std::unique_ptr<CaseRenderer> native(const Volume<std::int16_t>& ct,
                                         const FlatMap* map = nullptr, int threads = 0) {
        auto prepared = prepareCase(ct, {});
        EXPECT_TRUE(prepared);
        if (map) prepared->flatMap = std::make_shared<const FlatMap>(*map);
        auto made = CaseRenderer::upload(*context, std::move(*prepared),
                                         {.raycaster = RaycasterKind::native, .threads = threads});
        if (!made) ADD_FAILURE() << describe(made.error());
        return made ? std::move(*made) : nullptr;
    }
    static FlatView view(glm::dvec2 center, double pixelsPerUnit, const char* preset) {
        FlatView view;
        view.window = {center, pixelsPerUnit};
        view.optics = *opticsPreset(preset);
        return view;
    }
};

TEST_F(NativePictures, NeedNoGpuMemory) {
    const FlatTube shape = tube();
    const FlatMap map = shape.map(cells);
    const Volume<std::int16_t> scan = shape.scan();
    const auto renderer = native(scan, &map);
    CameraView camera;
    camera.optics = *opticsPreset("mucosa");
    draw(*renderer, camera, 32, 32);
    draw(*renderer, SliceView{}, 32, 32);
    draw(*renderer, view({0.5, 0.4}, 90.0, "mucosa"), 32, 32);
    draw(*renderer, FlatOverview{camera.optics, {}}, 64, 64);
    EXPECT_EQ(renderer->gpuBytes(), 0u);
    ASSERT_TRUE(renderer->use(RaycasterKind::singlePass));
    EXPECT_GE(renderer->gpuBytes(), scan.sizeBytes());
}

TEST_F(NativePictures, SlicesAreTheWindowedTrilinearValue) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> hu(-1024, 3000);
    const Grid grid = obliqueGrid({40, 30, 20}, {0.8, 0.9, 2.0});
    const Volume<std::int16_t> volume = sampled(grid, [&](glm::dvec3) { return hu(random); });
    const auto renderer = native(volume);
    for (const View plane : {View::axial, View::coronal, View::sagittal}) {
        const SliceView slice{plane, {1.3, -0.7, 2.1}, 1.2, {300.0, 1500.0}};
        const SlicePlacement placement = *placeSlice(slice, grid, 90, 70);
        ASSERT_TRUE(renderer->use(RaycasterKind::native));
        const Image image = draw(*renderer, slice, 90, 70);
        for (int y = 0; y < 70; ++y) {
            for (int x = 0; x < 90; ++x) {
                const glm::dvec3 voxel =
                    grid.voxelFromPatientPoint(placement.topLeftMm + double(x) * placement.rightMm +
                                               double(y) * placement.downMm);
                const glm::dvec3 room = glm::min(voxel + 0.5, glm::dvec3(grid.size) - 0.5 - voxel);
                const double edge = std::min(room.x, std::min(room.y, room.z));
                if (std::abs(edge) < 1e-3) continue;
                ASSERT_NEAR(pixel(image, x, y, 2),
                            edge < 0.0 ? 0.0 : windowed(trilinear(volume, voxel), slice.window),
                            0.51)
                    << toString(plane) << " " << x << " " << y;
            }
        }
        ASSERT_TRUE(renderer->use(RaycasterKind::singlePass));
        EXPECT_GE(psnr(image, draw(*renderer, slice, 90, 70)), 48.0);
    }
}

TEST_F(NativePictures, TrianglesAreTheGpus) {
    const FlatTube shape = tube();
    const FlatMap map = shape.map(cells);
    const Grid grid = shape.scan(2.0).grid();
    auto painter = FlatPainter::create(map, grid);
    const auto geometry = FlatGeometry::of(map, grid);
    ASSERT_TRUE(painter && geometry);
    const glm::ivec2 size(173, 121);
    for (const double pixels : {60.0, 170.0, 1900.0, 60000.0}) {
        for (const glm::dvec2 center : {glm::dvec2(0.43, 0.31), {0.003, 0.0}, {0.9, 0.77}}) {
            const FlatWindow window{center, pixels};
            ASSERT_TRUE(painter->findTriangles(window, Band::whole(size.x, size.y)));
            const std::vector<int> theirs = painter->triangleOfPixel();
            const FlatLattice lattice = (*geometry)->lattice(window, Band::whole(size.x, size.y));
            int different = 0;
            for (int row = 0; row < size.y; row += 11) {
                std::vector<FlatPixel> ours;
                coverRows(**geometry, lattice, row, 11, ours);
                for (std::size_t n = 0; n < ours.size(); ++n) {
                    const int triangle = ours[n].triangle;
                    different += (triangle < 0 ? -1 : (*geometry)->mapTriangle(triangle)) !=
                                 theirs[std::size_t(row * size.x) + n];
                }
            }
            EXPECT_EQ(different, 0) << pixels << " " << center.y;
        }
    }
}

TEST_F(NativePictures, FlatViewsAgreeWithAPlainOneAndTheGpus) {
    const FlatTube shape = tube();
    const FlatMap map = shape.map(cells);
    const Volume<std::int16_t> scan = shape.scan();
    const ReferenceWall reference(map);
    const auto renderer = native(scan, &map);
    const glm::ivec2 size(90, 70);
    for (const char* preset : {"mucosa", "translucent"}) {
        for (const auto& [center, pixels] : {std::pair(glm::dvec2(0.5, 0.4), 90.0),
                                             {glm::dvec2(0.02, 0.0), 150.0},
                                             {glm::dvec2(0.3, 0.55), 1500.0}}) {
            FlatView window = view(center, pixels, preset);
            for (const bool preIntegrated : {false, true}) {
                window.optics.preIntegrated = preIntegrated;
                ASSERT_TRUE(renderer->use(RaycasterKind::native));
                const Image image = draw(*renderer, window, size.x, size.y);
                ASSERT_TRUE(renderer->use(RaycasterKind::singlePass));
                EXPECT_GE(psnr(image, draw(*renderer, window, size.x, size.y)), 45.0)
                    << preset << " " << pixels << " " << preIntegrated;
                if (!preIntegrated) {
                    EXPECT_GE(psnr(image, referenceFlat(reference, scan, window, size)), 45.0)
                        << preset << " " << pixels;
                }
            }
        }
    }
}

TEST_F(NativePictures, ThreadsAndLeapingAndTheWindowsPlaceChangeNoPixel) {
    const FlatTube shape = tube();
    const FlatMap map = shape.map(cells);
    const Volume<std::int16_t> scan = shape.scan();
    const auto one = native(scan, &map, 1), other = native(scan, &map, 5);
    for (const char* preset : {"mucosa", "translucent"}) {
        FlatView window = view({0.9, 0.5}, 170.0, preset);
        const Image image = draw(*one, window, 131, 90);
        EXPECT_EQ(image.rgb, draw(*other, window, 131, 90).rgb);
        window.march.emptySpaceLeaping = false;
        EXPECT_EQ(image.rgb, draw(*other, window, 131, 90).rgb);
        window.window.center -= glm::dvec2(13.0, 6.0) / 170.0;
        const Image moved = draw(*other, window, 131, 90);
        for (int y = 10; y < 80; ++y)
            for (int x = 20; x < 110; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(pixel(image, x + 13, y + 6, c), pixel(moved, x, y, c));
    }
}

}  // namespace
}  // namespace haustra::tests
