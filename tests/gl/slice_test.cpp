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
                        ASSERT_NEAR(pixel(image, x, y), expected, 0.56)
                            << toString(plane) << " " << x << " " << y;
                        different += pixel(image, x, y) != int(std::lround(expected));
                        ASSERT_EQ(pixel(image, x, y, 0), pixel(image, x, y, 1));
                        ASSERT_EQ(pixel(image, x, y, 0), pixel(image, x, y, 2));
                    }
                }
                EXPECT_LT(different, 90 * 70 / 50);
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
                ASSERT_NEAR(pixel(image, x, y), windowed(ramp(mm), view.window), 0.9)
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
