// A slice has one place in the patient, for the server that draws it and for the client whose
// crosshair lies on it.
#include "core/slice_placement.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

class Placement : public testing::Test {
public:
    const Grid grid = axisAlignedGrid({100, 80, 60}, {0.5, 0.5, 2.0}, {-10.0, 30.0, -50.0});
    static glm::dvec3 at(const SlicePlacement& placement, double x, double y) {
        return placement.topLeftMm + x * placement.rightMm + y * placement.downMm;
    }
};

TEST_F(Placement, ZoomOneFitsTheSliceCentredWithSquareMillimetres) {
    SliceView view;
    view.plane = View::coronal;
    view.positionMm = {5.0, 40.0, 3.0};
    const SlicePlacement placement = *placeSlice(view, grid, 300, 200);
    EXPECT_NEAR(glm::length(placement.rightMm), glm::length(placement.downMm), 1e-12);
    // 120 mm high by 50 wide into 300 by 200: the height decides.
    EXPECT_NEAR(glm::length(placement.downMm), 120.0 / 200, 1e-12);
    const glm::dvec3 middle = at(placement, 149.5, 99.5);
    EXPECT_NEAR(middle.x, -10.0 + 49.5 * 0.5, 1e-9);
    EXPECT_NEAR(middle.y, 40.0, 1e-9);
    EXPECT_NEAR(middle.z, -50.0 + 29.5 * 2.0, 1e-9);
}

TEST_F(Placement, ZoomingHoldsThePositionInThePicture) {
    for (const View plane : {View::axial, View::coronal, View::sagittal}) {
        SliceView view;
        view.plane = plane;
        view.positionMm = {3.0, 44.0, 11.0};
        const auto pixelOfPosition = [&] {
            const SlicePlacement p = *placeSlice(view, grid, 256, 256);
            const glm::dvec3 d = view.positionMm - p.topLeftMm;
            const double perPixel = glm::dot(p.rightMm, p.rightMm);
            EXPECT_NEAR(glm::dot(d, glm::cross(p.rightMm, p.downMm)), 0.0, 1e-9);
            return glm::dvec2(glm::dot(d, p.rightMm), glm::dot(d, p.downMm)) / perPixel;
        };
        const glm::dvec2 before = pixelOfPosition();
        view.zoom = 5.0;
        EXPECT_NEAR(glm::distance(pixelOfPosition(), before), 0.0, 1e-9) << toString(plane);
    }
}

Grid oblique(std::mt19937& random) {
    std::uniform_real_distribution<double> angle(-0.3, 0.3), mm(-300.0, 300.0), spacing(0.5, 1.5);
    Grid grid = axisAlignedGrid({100 + int(random() % 400), 100 + int(random() % 400), 50},
                                {spacing(random), spacing(random), spacing(random)},
                                {mm(random), mm(random), mm(random)});
    const double a = angle(random);
    const glm::dmat4 tilt(1, 0, 0, 0, 0, std::cos(a), std::sin(a), 0, 0, -std::sin(a), std::cos(a),
                          0, 0, 0, 0, 1);
    grid.patientFromVoxel = tilt * grid.patientFromVoxel;
    return grid;
}

TEST(SlicePlacement, PixelsAndPatientPointsAreInverseOnTheSliceThroughThePosition) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> fraction(0.0, 1.0), zoom(1.0, 20.0), pixel(0.0, 600.0);
    for (int n = 0; n < 300; ++n) {
        const Grid grid = oblique(random);
        const glm::dvec3 voxel(fraction(random), fraction(random), fraction(random));
        const glm::dvec3 position = grid.patientFromVoxelPoint(voxel * glm::dvec3(grid.size - 1));
        const int width = 200 + int(random() % 500), height = 200 + int(random() % 500);
        const double zoomed = zoom(random);
        const auto isInverse = [&](const SlicePlacement& placed) {
            const glm::dvec2 at(pixel(random), pixel(random));
            const glm::dvec3 point = placed.patientFromPixel(at);
            const glm::dvec3 normal = glm::normalize(glm::cross(placed.rightMm, placed.downMm));
            EXPECT_LT(glm::distance(point, Placement::at(placed, at.x, at.y)), 1e-9);
            EXPECT_LT(glm::distance(placed.pixelFromPatient(point), at), 1e-6);
            EXPECT_LT(glm::distance(placed.pixelFromPatient(point + 7.0 * normal), at), 1e-6);
            EXPECT_NEAR(glm::dot(point - position, normal), 0.0, 1e-9);
            EXPECT_NEAR(glm::length(placed.rightMm), placed.pixelMm(), 1e-12);
            EXPECT_NEAR(glm::length(placed.downMm), placed.pixelMm(), 1e-12);
            EXPECT_NEAR(glm::dot(placed.rightMm, placed.downMm), 0.0, 1e-12);
        };
        for (const View plane : {View::axial, View::coronal, View::sagittal})
            isInverse(*placeSlice(SliceView{plane, position, zoomed}, grid, width, height));
        isInverse(*placeSlice(ObliqueView{position, {pixel(random), 1.0, 2.0}}, width, height));
    }
}

TEST(SlicePlacement, PixelsAndPatientPointsAreInverseAndThePositionLiesOnTheSlice) {
    const Grid grid = axisAlignedGrid({512, 512, 430}, {0.7, 0.7, 0.8}, {-180, -160, -900});
    for (const View view : {View::axial, View::coronal, View::sagittal}) {
        const SliceView slice{view, {20, 30, -700}, 3.0};
        const SlicePlacement map = *placeSlice(slice, grid, 640, 480);
        const glm::dvec2 pixel(123.25, 77.5);
        const glm::dvec3 point = map.patientFromPixel(pixel);
        EXPECT_LT(glm::distance(map.pixelFromPatient(point), pixel), 1e-9);
        const glm::dvec3 normal = glm::normalize(glm::cross(map.rightMm, map.downMm));
        EXPECT_NEAR(glm::dot(point - slice.positionMm, normal), 0.0, 1e-9);
    }
}

TEST(SlicePlacement, TheWholeScanFitsAtZoomOneAndZoomingHoldsThePosition) {
    const Grid grid = axisAlignedGrid({512, 512, 430}, {0.7, 0.7, 0.8}, {-180, -160, -900});
    for (const View view : {View::axial, View::coronal, View::sagittal}) {
        SliceView slice{view, {20, 30, -700}, 1.0};
        const SlicePlacement whole = *placeSlice(slice, grid, 640, 480);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
            const glm::dvec2 pixel = whole.pixelFromPatient(
                grid.patientFromVoxelPoint(side * glm::dvec3(grid.size) - 0.5));
            EXPECT_GE(pixel.x, -0.5 - 1e-9);
            EXPECT_GE(pixel.y, -0.5 - 1e-9);
            EXPECT_LE(pixel.x, 639.5 + 1e-9);
            EXPECT_LE(pixel.y, 479.5 + 1e-9);
        }
        const glm::dvec2 before = whole.pixelFromPatient(slice.positionMm);
        slice.zoom = 5.0;
        const SlicePlacement near = *placeSlice(slice, grid, 640, 480);
        EXPECT_LT(glm::distance(near.pixelFromPatient(slice.positionMm), before), 1e-6);
        EXPECT_NEAR(near.pixelMm() * 5.0, whole.pixelMm(), 1e-12);
    }
}

TEST(SlicePlacement, APanMovesThePictureAndNotThePlane) {
    const Grid grid = axisAlignedGrid({512, 512, 430}, {0.7, 0.7, 0.8}, {-180, -160, -900});
    const glm::dvec3 point(33, 41, -650);
    for (const View view : {View::axial, View::coronal, View::sagittal}) {
        for (const double zoom : {1.0, 4.0}) {
            SliceView slice{view, {20, 30, -700}, zoom};
            const SlicePlacement before = *placeSlice(slice, grid, 640, 480);
            slice.panMm = {12.0, -7.0};
            const SlicePlacement moved = *placeSlice(slice, grid, 640, 480);
            const glm::dvec2 by = moved.pixelFromPatient(point) - before.pixelFromPatient(point);
            EXPECT_LT(glm::distance(by, glm::dvec2(12.0, -7.0) / before.pixelMm()), 1e-9);
            EXPECT_EQ(moved.rightMm, before.rightMm);
            EXPECT_EQ(moved.downMm, before.downMm);
            EXPECT_NEAR(glm::dot(moved.topLeftMm - slice.positionMm, moved.normal()), 0.0, 1e-9);
        }
    }
}

TEST(SlicePlacement, ASlabsSamplesAreTheMiddlesOfThinLayersOfIt) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> thickness(0.0, maxSlabMm), part(-1.0, 1.0);
    for (int n = 0; n < 300; ++n) {
        const Grid grid = oblique(random);
        const glm::dvec3 spacing = grid.spacingMm();
        const double least = std::min({spacing.x, spacing.y, spacing.z});
        const glm::dvec3 normal(part(random), part(random), 1.5);
        const Slab slab{n % 3 == 0 ? 0.1 * thickness(random) : thickness(random)};
        const SlabSamples samples = slabSamples(slab, normal, grid);
        EXPECT_NEAR(samples.count() * glm::length(samples.stepMm), slab.thicknessMm, 1e-9);
        EXPECT_LE(glm::length(samples.stepMm), 0.5 * least * (1.0 + 1e-6));
        EXPECT_LT(glm::length(glm::cross(samples.stepMm, normal)), 1e-9);
        // As few as that takes.
        if (samples.aside > 0) {
            EXPECT_GT(slab.thicknessMm / (samples.count() - 2), 0.5 * least);
        }
    }
    const Grid grid = axisAlignedGrid({10, 10, 10}, {1.0, 1.0, 2.0});
    EXPECT_EQ(slabSamples({}, {0, 0, 1}, grid).aside, 0);
    EXPECT_EQ(slabSamples({0.5}, {0, 0, 1}, grid).aside, 0);
    EXPECT_EQ(slabSamples({1.5}, {0, 0, 1}, grid).aside, 1);
}

TEST(SlicePlacement, WhatIsNoSliceIsRefused) {
    const Grid grid = axisAlignedGrid({10, 10, 10}, {1.0, 1.0, 1.0});
    EXPECT_TRUE(placeSlice(SliceView{View::axial}, grid, 1, 1));
    EXPECT_FALSE(placeSlice(SliceView{View::overview}, grid, 8, 8));
    EXPECT_FALSE(placeSlice(SliceView{View::axial, {}, 0.5}, grid, 8, 8));
    EXPECT_FALSE(placeSlice(SliceView{View::axial}, grid, 0, 8));
    EXPECT_FALSE(placeSlice(ObliqueView{{}, {0.0, 1.0, 0.0}}, 8, 8));
    EXPECT_FALSE(placeSlice(ObliqueView{}, 8, 0));
}

}  // namespace
}  // namespace haustra
