// The client's map of a slice against the server's: a crosshair must lie where the server drew the
// voxel.
#include "reader/slice_map.h"
#include "render/scene/picture.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

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

TEST(ClientSliceMap, AgreesWithWhatTheServerDraws) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> fraction(0.0, 1.0), zoom(1.0, 20.0), pixel(0.0, 600.0);
    for (int n = 0; n < 300; ++n) {
        const Grid grid = oblique(random);
        const glm::dvec3 voxel(fraction(random), fraction(random), fraction(random));
        const glm::dvec3 position = grid.patientFromVoxelPoint(voxel * glm::dvec3(grid.size - 1));
        const int width = 200 + int(random() % 500), height = 200 + int(random() % 500);
        const double zoomed = zoom(random);
        for (const View plane : {View::axial, View::coronal, View::sagittal}) {
            const SliceView slice{plane, position, zoomed};
            const auto placed = render::placeSlice(slice, grid, width, height);
            ASSERT_TRUE(placed);
            const reader::SliceMap map(slice, grid, width, height);
            const glm::dvec2 at(pixel(random), pixel(random));
            const glm::dvec3 expected =
                placed->topLeftMm + at.x * placed->rightMm + at.y * placed->downMm;
            EXPECT_LT(glm::distance(map.patientFromPixel(at), expected), 1e-9);
            EXPECT_LT(glm::distance(map.pixelFromPatient(expected), at), 1e-6);
        }
    }
}

}  // namespace
}  // namespace haustra
