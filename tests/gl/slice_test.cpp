// Slices: values, sides and places.
#include "core/slice_placement.h"
#include "render_scene.h"

#include <random>

namespace haustra::tests {
namespace {

using namespace render;

using Slices = Drawing;

TEST_F(Slices, PixelsAreTheWindowedTrilinearValue) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> hu(-1024, 3000);
    for (const Grid& grid : {axisAlignedGrid({40, 30, 20}, {0.8, 0.9, 2.0}, {-100, 20, 7}),
                             obliqueGrid({40, 30, 20}, {0.8, 0.9, 2.0})}) {
        const Volume<std::int16_t> volume = sampled(grid, [&](glm::dvec3) { return hu(random); });
        const auto scan = renderer(volume);
        const glm::dvec3 middle = grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size));
        for (const View plane : {View::axial, View::coronal, View::sagittal}) {
            for (const double zoom : {1.0, 3.5}) {
                const SliceView view{
                    plane, middle + glm::dvec3(1.3, -0.7, 2.1), zoom, {300.0, 1500.0}};
                const Image image = draw(*scan, view, 90, 70);
                const SlicePlacement placement = *placeSlice(view, grid, 90, 70);
                int different = 0, outside = 0;
                for (int y = 0; y < 70; ++y) {
                    for (int x = 0; x < 90; ++x) {
                        const glm::dvec3 mm = placement.topLeftMm + double(x) * placement.rightMm +
                                              double(y) * placement.downMm;
                        const glm::dvec3 voxel = grid.voxelFromPatientPoint(mm);
                        const glm::dvec3 fromFaces =
                            glm::min(voxel + 0.5, glm::dvec3(grid.size) - 0.5 - voxel);
                        const double edge =
                            std::min(fromFaces.x, std::min(fromFaces.y, fromFaces.z));
                        if (std::abs(edge) < 1e-3) continue;
                        outside += edge < 0.0;
                        const double expected =
                            edge < 0.0 ? 0.0 : windowed(trilinear(volume, voxel), view.window);
                        // A weight rounded to eight bits is off by 1/512 at most: of 4,024 HU from
                        // voxel to voxel 1.3 grey values, by three weights 4. In the mean it is a
                        // third of a grey value, and as many pixels are rounded otherwise.
                        ASSERT_NEAR(pixel(image, x, y), expected, near(0.56, 5.0))
                            << toString(plane) << " " << x << " " << y;
                        different += pixel(image, x, y) != int(std::lround(expected));
                        ASSERT_EQ(pixel(image, x, y, 0), pixel(image, x, y, 1));
                        ASSERT_EQ(pixel(image, x, y, 0), pixel(image, x, y, 2));
                    }
                }
                EXPECT_LT(different, 90 * 70 * near(0.02, 0.4));
                EXPECT_TRUE(zoom > 1.0 || outside > 0);
            }
        }
    }
}

/// The brightness's centre in the picture, −1…1 from its middle.
glm::dvec2 whereSeen(const Image& image) {
    glm::dvec2 sum(0.0);
    double weight = 0.0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double w = pixel(image, x, y);
            sum +=
                w * (2.0 * (glm::dvec2(x, y) + 0.5) / glm::dvec2(image.width, image.height) - 1.0);
            weight += w;
        }
    }
    return weight > 0.0 ? sum / weight : glm::dvec2(0.0);
}

TEST_F(Slices, SidesFollowTheRadiologicalConvention) {
    // The same patient in grids whose axes run every way: only the affine may tell the sides.
    for (const glm::dvec3 signs : {glm::dvec3(1, 1, 1), {-1, 1, 1}, {1, -1, -1}, {-1, -1, -1}}) {
        Grid grid = axisAlignedGrid({41, 41, 41}, glm::dvec3(2.0));
        for (int axis = 0; axis < 3; ++axis) {
            grid.patientFromVoxel[axis][axis] *= signs[axis];
            grid.patientFromVoxel[3][axis] = -40.0 * signs[axis];
        }
        const auto seen = [&](glm::dvec3 marker, View plane) {
            const auto scan = renderer(sampled(grid, [&](glm::dvec3 p) {
                return glm::distance(p, marker) < 5.0 ? 1000.0 : -1000.0;
            }));
            return whereSeen(
                draw(*scan, SliceView{plane, glm::dvec3(0.0), 1.0, {0.0, 2000.0}}, 82, 82));
        };
        const glm::dvec3 left(25, 0, 0), posterior(0, 25, 0), superior(0, 0, 25);
        EXPECT_NEAR(glm::distance(seen(left, View::axial), glm::dvec2(0.61, 0.0)), 0.0, 0.03);
        EXPECT_NEAR(glm::distance(seen(posterior, View::axial), glm::dvec2(0.0, 0.61)), 0.0, 0.03);
        EXPECT_NEAR(glm::distance(seen(left, View::coronal), glm::dvec2(0.61, 0.0)), 0.0, 0.03);
        EXPECT_NEAR(glm::distance(seen(superior, View::coronal), glm::dvec2(0.0, -0.61)), 0.0,
                    0.03);
        EXPECT_NEAR(glm::distance(seen(posterior, View::sagittal), glm::dvec2(0.61, 0.0)), 0.0,
                    0.03);
        EXPECT_NEAR(glm::distance(seen(superior, View::sagittal), glm::dvec2(0.0, -0.61)), 0.0,
                    0.03);
    }
}

TEST_F(Slices, TheEndoscopeSeesThePatientsLeftAsASurgeonDoes) {
    // Looking up along +z with the front (−y) up, the patient's left is on the picture's right.
    const Grid grid = axisAlignedGrid({41, 41, 41}, glm::dvec3(2.0), glm::dvec3(-40.0));
    const auto scan = renderer(sampled(grid, [](glm::dvec3 p) {
        return glm::distance(p, {15, 0, 20}) < 8.0 ? 500.0 : -1000.0;
    }));
    CameraView view;
    view.camera = {{0, 0, -10}, {0, 0, 1}, {0, -1, 0}, 90.0};
    view.optics.transferFunction = surfaceAt(-200.0);
    const glm::dvec2 seen = whereSeen(draw(*scan, view, 64, 64));
    EXPECT_NEAR(seen.x, 0.5, 0.1);
    EXPECT_NEAR(seen.y, 0.0, 0.02);
}

TEST_F(Slices, ObliquePixelsAreARampsValueWhereTheyLie) {
    // A linear function of the place: interpolation returns it exactly, in whichever grid.
    const glm::dvec3 slope(3.0, -2.0, 4.5);
    const auto ramp = [&](glm::dvec3 p) { return 100.0 + glm::dot(slope, p); };
    for (const Grid& grid : {axisAlignedGrid({60, 60, 60}, glm::dvec3(1.0), glm::dvec3(-30.0)),
                             obliqueGrid({60, 60, 60}, {0.8, 0.9, 1.1})}) {
        const auto scan = renderer(sampled(grid, ramp));
        const glm::dvec3 middle = grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size - 1));
        const ObliqueView view{middle + glm::dvec3(2.0, -1.0, 0.5),
                               {1.0, 2.0, -0.5},
                               {0.3, -1.0, 2.0},
                               18.0,
                               {ramp(middle), 400.0}};
        const int width = 64, height = 36;
        const Image image = draw(*scan, view, width, height);
        const glm::dvec3 forward = glm::normalize(view.forward);
        const glm::dvec3 right = glm::normalize(glm::cross(forward, view.up));
        const glm::dvec3 up = glm::cross(right, forward);
        EXPECT_GT(glm::dot(up, view.up), 0.0);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                // Half a millimetre a pixel, the position in the picture's middle.
                const glm::dvec3 mm = view.positionMm + 0.5 * (x + 0.5 - 0.5 * width) * right -
                                      0.5 * (y + 0.5 - 0.5 * height) * up;
                // Voxels hold whole HU: half of one is a third of a grey value.
                ASSERT_NEAR(pixel(image, x, y), windowed(ramp(mm), view.window), near(0.9, 1.4))
                    << x << " " << y;
            }
    }
}

TEST_F(Slices, AnObliqueSliceShowsWhatTheCameraHasOnItsRight) {
    // The cross-section of a tube ahead: a marker on the camera's right and one above it.
    const Grid grid = axisAlignedGrid({41, 41, 41}, glm::dvec3(2.0), glm::dvec3(-40.0));
    const glm::dvec3 forward(0.0, 1.0, 0.2), up(0.1, 0.0, 1.0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    for (const auto& [direction, expected] :
         {std::pair{right, glm::dvec2(0.5, 0.0)},
          {glm::cross(right, glm::normalize(forward)), {0.0, -0.5}}}) {
        const auto scan = renderer(sampled(grid, [&, d = direction](glm::dvec3 p) {
            return glm::distance(p, 15.0 * d) < 5.0 ? 1000.0 : -1000.0;
        }));
        const glm::dvec2 seen =
            whereSeen(draw(*scan, ObliqueView{{}, forward, up, 60.0, {0.0, 2000.0}}, 64, 64));
        EXPECT_NEAR(glm::distance(seen, expected), 0.0, 0.03);
    }
}

TEST_F(Slices, ShowTheScanUnlessTheCleansedOneIsAskedFor) {
    const Grid grid = axisAlignedGrid({16, 16, 16}, glm::dvec3(1.0));
    const Volume<std::int16_t> ct(grid, 600), air(grid, 540), same(grid, 600);
    SliceView view{View::axial, glm::dvec3(7.5), 1.0, {600.0, 200.0}};
    const auto cleansed = renderer(ct, air), unchanged = renderer(ct, same), bare = renderer(ct);
    const Image before = draw(*cleansed, view, 16, 16);
    EXPECT_NEAR(pixel(before, 8, 8), 127.5, 0.6);
    EXPECT_EQ(before.rgb, draw(*bare, view, 16, 16).rgb);
    view.scan = Scan::cleansed;
    const Image after = draw(*cleansed, view, 16, 16);
    EXPECT_NEAR(pixel(after, 8, 8), 127.5 - 0.3 * 255.0, 0.6);
    EXPECT_EQ(draw(*unchanged, view, 16, 16).rgb, before.rgb);
    const auto none = bare->render(view, 16, 16);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::badInput);
    EXPECT_NE(describe(none.error()).find("no cleansed scan"), std::string::npos);
}

// Slices are drawn by the GPU or by the CPU, as the case's raycaster is.
class Slabs : public Drawing, public testing::WithParamInterface<RaycasterKind> {
protected:
    std::unique_ptr<render::CaseRenderer> rendererOf(const Volume<std::int16_t>& ct) {
        auto made = render::CaseRenderer::create(*context, ct, {}, {.raycaster = GetParam()});
        EXPECT_TRUE(made);
        return made ? std::move(*made) : nullptr;
    }
};
INSTANTIATE_TEST_SUITE_P(OnGpuAndCpu, Slabs,
                         testing::Values(RaycasterKind::singlePass, RaycasterKind::native));

TEST_P(Slabs, AreTheMeanAndTheMaximumOfSlicesThroughThem) {
    std::mt19937 random(11);
    std::uniform_int_distribution<int> hu(-1000, 1000);
    const Grid grid = obliqueGrid({30, 26, 22}, {0.9, 0.8, 1.5});
    const Volume<std::int16_t> volume = sampled(grid, [&](glm::dvec3) { return hu(random); });
    const auto scan = rendererOf(volume);
    const WindowLevel window{0.0, 2000.0};
    for (const double thickness : {0.3, 2.0, 9.0, 100.0}) {
        for (const Projection projection : {Projection::mean, Projection::maximum}) {
            const ObliqueView view{{0.4, -0.6, 0.3}, {0.2, 0.5, 1.0}, {0, -1, 0.1},           36.0,
                                   window,           Scan::original,  {thickness, projection}};
            const SliceView axial{View::axial, {0.4, -0.6, 0.3},       1.5, window, Scan::original,
                                  {0.0, 0.0},  {thickness, projection}};
            const auto check = [&](const Image& image, const SlicePlacement& placement) {
                const glm::dvec3 normal =
                    glm::normalize(glm::cross(placement.rightMm, placement.downMm));
                for (int y = 0; y < image.height; ++y) {
                    for (int x = 0; x < image.width; ++x) {
                        // By far finer steps than the renderer's.
                        const int steps = 4001;
                        double sum = 0.0, most = -INFINITY, atEdge = INFINITY;
                        int inside = 0;
                        for (int n = 0; n < steps; ++n) {
                            const double at = thickness * ((n + 0.5) / steps - 0.5);
                            const glm::dvec3 voxel = grid.voxelFromPatientPoint(
                                placement.patientFromPixel({x, y}) + at * normal);
                            const glm::dvec3 in =
                                glm::min(voxel + 0.5, glm::dvec3(grid.size) - 0.5 - voxel);
                            const double edge = std::min(in.x, std::min(in.y, in.z));
                            atEdge = std::min(atEdge, std::abs(edge));
                            if (edge < 0.0) continue;
                            const double value = trilinear(volume, voxel);
                            sum += value, most = std::max(most, value), ++inside;
                        }
                        if (inside == 0 && atEdge > 0.01) {
                            EXPECT_EQ(pixel(image, x, y), 0);
                        }
                        if (inside < steps && (inside < steps / 10 || atEdge < 0.5)) continue;
                        const double expected =
                            windowed(projection == Projection::mean ? sum / inside : most, window);
                        // Samples half a voxel apart miss a peak by what values change in a
                        // quarter of a voxel, and the mean by far less.
                        const double tolerance = projection == Projection::mean ? 8.0 : 40.0;
                        ASSERT_NEAR(pixel(image, x, y), expected, tolerance)
                            << thickness << " mm at " << x << " " << y;
                        if (projection == Projection::maximum) {
                            ASSERT_LE(pixel(image, x, y), expected + near(1.0, 1.5));
                        }
                    }
                }
            };
            check(draw(*scan, view, 24, 18), *placeSlice(view, 24, 18));
            check(draw(*scan, axial, 20, 20), *placeSlice(axial, grid, 20, 20));
        }
    }
}

TEST_P(Slabs, TheMaximumShowsABallThatTheSliceMisses) {
    const Grid grid = axisAlignedGrid({41, 41, 41}, glm::dvec3(1.0), glm::dvec3(-20.0));
    const glm::dvec3 ball(6.0, -4.0, 9.0);
    const auto scan = rendererOf(
        sampled(grid, [&](glm::dvec3 p) { return glm::distance(p, ball) < 3.0 ? 900.0 : -900.0; }));
    SliceView view{View::axial, glm::dvec3(0.0), 1.0, {0.0, 2000.0}};
    const auto brightest = [&] {
        const Image image = draw(*scan, view, 41, 41);
        return *std::max_element(image.rgb.begin(), image.rgb.end());
    };
    const int air = brightest();
    view.slab = {11.0, Projection::maximum};  // ends 0.5 mm before the ball
    EXPECT_EQ(brightest(), air);
    view.slab.thicknessMm = 20.0;  // past its middle
    EXPECT_EQ(brightest(), int(std::lround(windowed(900.0, view.window))));
    const glm::dvec2 seen = whereSeen([&] {
        Image image = draw(*scan, view, 41, 41);
        for (auto& byte : image.rgb)
            byte = byte > 128 ? 255 : 0;
        return image;
    }());
    EXPECT_NEAR(glm::distance(seen, glm::dvec2(6.0, -4.0) / 20.5), 0.0, 0.01);
}

TEST_P(Slabs, TheMeanOfALinearRampIsItsMiddleSlice) {
    const Grid grid = obliqueGrid({60, 60, 60}, {0.7, 0.8, 1.1});
    const auto scan = rendererOf(
        sampled(grid, [](glm::dvec3 p) { return 40.0 * p.x - 25.0 * p.y + 30.0 * p.z; }));
    ObliqueView view{{0.3, -0.2, 0.1}, {0.3, -0.4, 1.0}, {0, -1, 0}, 12.0, {0.0, 1600.0}};
    const Image slice = draw(*scan, view, 40, 40);
    for (const double thickness : {0.4, 1.0, 7.3, 16.0}) {
        view.slab = {thickness, Projection::mean};
        const Image slab = draw(*scan, view, 40, 40);
        for (std::size_t n = 0; n < slab.rgb.size(); ++n)
            ASSERT_NEAR(slab.rgb[n], slice.rgb[n], 1.0) << thickness;
    }
    // The maximum is not: it grows with the thickness.
    view.slab = {7.3, Projection::maximum};
    const Image most = draw(*scan, view, 40, 40);
    const double perMm = std::abs(glm::dot(glm::dvec3(40, -25, 30), glm::normalize(view.forward)));
    EXPECT_NEAR(pixel(most, 20, 20) - pixel(slice, 20, 20), 0.5 * 7.3 * perMm * 255 / 1600, 1.5);
}

TEST_P(Slabs, ALayerAsThinAsOneSampleIsTheSliceToTheByte) {
    std::mt19937 random(4);
    const Grid grid = axisAlignedGrid({20, 20, 20}, {0.8, 0.8, 1.0});
    const auto scan = rendererOf(sampled(grid, [&](glm::dvec3) { return int(random() % 2000); }));
    SliceView view{View::coronal, {8.0, 7.3, 9.0}, 1.3, {1000.0, 2000.0}};
    const Image slice = draw(*scan, view, 33, 29);
    for (const Projection projection : {Projection::mean, Projection::maximum}) {
        view.slab = {0.39, projection};
        EXPECT_EQ(draw(*scan, view, 33, 29).rgb, slice.rgb);
        view.slab.thicknessMm = 2.0;
        EXPECT_NE(draw(*scan, view, 33, 29).rgb, slice.rgb);
    }
}

TEST_P(Slabs, APanMovesABrightVoxelByThePixelsThatItShould) {
    const Grid grid = axisAlignedGrid({40, 40, 40}, glm::dvec3(1.0));
    Volume<std::int16_t> volume(grid, -1000);
    volume.writable()[grid.index(22, 17, 25)] = 1000;
    const auto scan = rendererOf(volume);
    for (const auto& [plane, at] : {std::pair{View::axial, glm::dvec2(22, 17)},
                                    {View::coronal, glm::dvec2(22, 39 - 25)},
                                    {View::sagittal, glm::dvec2(17, 39 - 25)}}) {
        const auto brightest = [&](glm::dvec2 panMm) {
            const Image image = draw(
                *scan, SliceView{plane, {22, 17, 25}, 1.0, {0.0, 2000.0}, Scan::original, panMm},
                80, 80);
            return 0.5 * glm::dvec2(80) * (whereSeen(image) + 1.0);
        };
        // Two pixels a voxel.
        EXPECT_LT(glm::distance(brightest({0, 0}), 2.0 * at + 1.0), 1e-6) << toString(plane);
        EXPECT_LT(glm::distance(brightest({5, 3}), 2.0 * at + 1.0 + glm::dvec2(10, 6)), 1e-6);
        EXPECT_LT(glm::distance(brightest({-4, -1.5}), 2.0 * at + 1.0 - glm::dvec2(8, 3)), 1e-6);
    }
}

TEST_F(Slices, SayWhatIsWrong) {
    const auto scan =
        renderer(Volume<std::int16_t>(axisAlignedGrid({8, 8, 8}, glm::dvec3(1.0)), 0));
    SliceView view;
    EXPECT_TRUE(scan->render(view, 8, 8));
    view.plane = View::endoscopic;
    EXPECT_FALSE(scan->render(view, 8, 8));
    view = {};
    view.zoom = 0.0;
    EXPECT_FALSE(scan->render(view, 8, 8));
    view = {};
    view.window.widthHu = std::nan("");
    EXPECT_FALSE(scan->render(view, 8, 8));
    view = {};
    EXPECT_FALSE(scan->render(view, 4096, 8));

    ObliqueView oblique;
    EXPECT_TRUE(scan->render(oblique, 8, 8));
    EXPECT_FALSE(scan->render(oblique, 0, 8));
    oblique.scan = Scan::cleansed;
    EXPECT_FALSE(scan->render(oblique, 8, 8));
    oblique = {};
    oblique.up = -3.0 * oblique.forward;
    EXPECT_FALSE(scan->render(oblique, 8, 8));
    for (const double height : {0.0, -5.0, 1e9, std::nan("")}) {
        oblique = {};
        oblique.heightMm = height;
        EXPECT_FALSE(scan->render(oblique, 8, 8)) << height;
    }
}

}  // namespace
}  // namespace haustra::tests
