// Layers of cells, and the pixels that see a cell, by brute force along rays.
#include "render/object_order/frame_plan.h"

#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace haustra::render {
namespace {

/// The dissertation's propagation: from the source cell on, through faces, to cells not visited.
std::vector<int> propagated(const CellGrid& cells, glm::ivec3 source) {
    std::vector<int> layers(std::size_t(cells.cells()), -1);
    std::deque<glm::ivec3> front{source};
    layers[std::size_t(cells.index(source))] = 0;
    while (!front.empty()) {
        const glm::ivec3 cell = front.front();
        front.pop_front();
        for (int axis = 0; axis < 3; ++axis)
            for (const int way : {-1, 1}) {
                glm::ivec3 next = cell;
                next[axis] += way;
                if (next[axis] < 0 || next[axis] >= cells.count()[axis]) continue;
                int& layer = layers[std::size_t(cells.index(next))];
                if (layer >= 0) continue;
                layer = layers[std::size_t(cells.index(cell))] + 1;
                front.push_back(next);
            }
    }
    return layers;
}

TEST(CellLayers, AreWhatPropagationFromFaceToFaceReaches) {
    for (const glm::ivec3 voxels :
         {glm::ivec3(100, 70, 33), {1, 1, 1}, {17, 200, 16}, {2, 2, 90}}) {
        const CellGrid cells{voxels, 16};
        for (int index = 0; index < cells.cells(); index += 3) {
            const glm::ivec3 source = cells.cellAt(index);
            EXPECT_EQ(cells.index(source), index);
            const std::vector<int> expected = propagated(cells, source);
            std::vector<int> visits(expected.size(), 0);
            for (int layer = 0; layer <= lastLayer(cells, source); ++layer) {
                int count = 0;
                forEachCellOfLayer(cells, source, layer, [&](glm::ivec3 cell) {
                    ++visits[std::size_t(cells.index(cell))];
                    ++count;
                    EXPECT_EQ(expected[std::size_t(cells.index(cell))], layer);
                    EXPECT_EQ(layerOf(cell, source), layer);
                });
                EXPECT_GT(count, 0);
            }
            for (const int count : visits)
                EXPECT_EQ(count, 1);
        }
    }
}

Grid obliqueGrid() {
    Grid grid{{90, 61, 75}, glm::dmat4(1.0)};
    const glm::dmat4 turned =
        glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
    grid.patientFromVoxel = glm::translate(glm::scale(turned, glm::dvec3(0.7, 0.9, 1.1)),
                                           -0.5 * glm::dvec3(grid.size - 1));
    return grid;
}

struct Ray {
    glm::dvec3 origin, direction;  // mm
    bool shown = true;
};

/// By the definition of the lenses (core/camera.h).
Ray rayOf(const Camera& camera, glm::ivec2 size, glm::dvec2 pixel) {
    const glm::dvec3 ahead = glm::normalize(camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(ahead, camera.up));
    const glm::dvec3 down = glm::cross(ahead, right);
    const glm::dvec2 at = (2.0 * pixel - glm::dvec2(size)) / double(size.y);
    const glm::dvec3 aside = at.x * right + at.y * down;
    switch (camera.lens) {
        case Lens::orthographic:
            return {camera.positionMm + 0.5 * camera.heightMm * aside, ahead};
        case Lens::fisheye: {
            const double angle = glm::radians(0.5 * camera.fovDegrees) * glm::length(at);
            return {camera.positionMm,
                    std::cos(angle) * ahead + std::sin(angle) / glm::length(at) * aside,
                    angle <= std::numbers::pi};
        }
        default:
            return {
                camera.positionMm,
                glm::normalize(ahead + std::tan(glm::radians(0.5 * camera.fovDegrees)) * aside)};
    }
}

std::vector<Camera> randomCameras(const Grid& grid, int count) {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<Camera> cameras;
    for (int i = 0; i < count; ++i) {
        const auto any = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
        // Inside; or outside, at faces, edges and corners, in voxels from the middle.
        glm::dvec3 place = any();
        if (i % 3 > 0)
            for (int axis = 0; axis < 3; ++axis)
                if (unit(random) > 0.0) place[axis] = std::copysign(1.3, place[axis]);
        // Some on cells' faces to the bit.
        glm::dvec3 voxel = 0.5 * (1.0 + place) * glm::dvec3(grid.size - 1);
        if (i % 5 == 0) voxel.x = 16.0 * std::round(voxel.x / 16.0);
        Camera camera;
        camera.positionMm = grid.patientFromVoxelPoint(voxel);
        camera.forward = any() - (i % 2 ? glm::normalize(camera.positionMm) : glm::dvec3(0.0));
        camera.up = any();
        camera.lens = Lens(i % 7 % 3);
        camera.fovDegrees = camera.lens == Lens::fisheye ? 40.0 + 300.0 * std::abs(unit(random))
                                                         : 20.0 + 140.0 * std::abs(unit(random));
        camera.heightMm = 60.0;
        cameras.push_back(camera);
    }
    return cameras;
}

TEST(CellLayers, ARayMeetsLaterCellsInLaterLayersAndOnlyPixelsOfTheirFootprints) {
    const Grid grid = obliqueGrid();
    const CellGrid cells{grid.size, 16};
    const glm::ivec2 size(48, 33);
    const std::vector<std::uint8_t> all(std::size_t(cells.cells()), 1);
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    int met = 0;
    double seen = 0.0, planned = 0.0;
    for (const Camera& camera : randomCameras(grid, 60)) {
        const auto plan = planFrame(cells, all, grid, camera, size, 0, size.y);
        std::map<int, const PlannedCell*> byCell;
        int before = 0;
        for (const PlannedCell& one : plan) {
            EXPECT_GE(one.layer, before);
            before = one.layer;
            byCell[one.cell] = &one;
            const glm::ivec2 along = one.tiles.high - one.tiles.low;
            planned += along.x * along.y;
        }
        std::map<std::pair<int, int>, int> tilesOfCells;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const Ray ray = rayOf(camera, size, {x + 0.5, y + 0.5});
                if (!ray.shown) continue;
                int lastLayerMet = -1, lastCell = -1;
                for (double t = 0.01; t < 400.0; t += 0.4) {  // beyond rounding at the eye
                    const glm::dvec3 voxel(voxelFromPatient *
                                           glm::dvec4(ray.origin + t * ray.direction, 1.0));
                    if (glm::any(glm::lessThan(voxel, glm::dvec3(-0.5))) ||
                        glm::any(glm::greaterThan(voxel, glm::dvec3(grid.size) - 0.5)))
                        continue;
                    const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(voxel / 16.0)),
                                                       glm::ivec3(0), cells.count() - 1);
                    const int index = cells.index(cell);
                    if (index == lastCell) continue;
                    const auto one = byCell.find(index);
                    ASSERT_NE(one, byCell.end()) << "a cell that a ray meets is not drawn";
                    ASSERT_GT(one->second->layer, lastLayerMet) << "hidden before it is drawn";
                    const PixelRect& tiles = one->second->tiles;
                    ASSERT_TRUE(x / rayTile >= tiles.low.x && x / rayTile < tiles.high.x &&
                                y / rayTile >= tiles.low.y && y / rayTile < tiles.high.y);
                    ++tilesOfCells[{index, x / rayTile + 100 * (y / rayTile)}];
                    lastCell = index;
                    lastLayerMet = one->second->layer;
                    ++met;
                }
            }
        seen += double(tilesOfCells.size());
    }
    EXPECT_GT(met, 50000);
    // A footprint is not much larger than what it must hold.
    EXPECT_LT(planned, 2.5 * seen);
}

}  // namespace
}  // namespace haustra::render
