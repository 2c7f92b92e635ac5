// Where rays end that look beneath the wall.
#include "render/scene/beneath_wall.h"

#include <gtest/gtest.h>

namespace haustra::render {
namespace {

// Gas up to z = 20, then tissue: 4 mm of it and gas again where x < 0, else no end of it.
Scene plateAndBlock() {
    const Grid grid = axisAlignedGrid({80, 40, 120}, {0.5, 0.5, 0.5}, {-20, -10, 0});
    Volume<std::int16_t> hu(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
        hu.writable()[n] = p.z < 20.0 || (p.x < 0.0 && p.z > 24.0) ? -1000 : 40;
    }
    Scene scene;
    scene.volume = std::move(hu);
    return scene;
}

constexpr glm::ivec2 size{40, 20};

// Depth, along each ray, of the plane z = 20.
std::vector<float> wallOf(const Camera& camera) {
    std::vector<float> depths;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const auto along = rayThrough(
                camera, (glm::dvec2(x, y) + 0.5 - 0.5 * glm::dvec2(size)) / double(size.y));
            depths.push_back(float((20.0 - camera.positionMm.z) / (along ? along->z : 1.0)));
        }
    return depths;
}

Camera ahead(Lens lens) {
    Camera camera;
    camera.positionMm = {0.0, 0.0, 2.0};
    camera.fovDegrees = 40.0, camera.heightMm = 15.0;
    camera.lens = lens;
    return camera;
}

TEST(BeneathWall, RaysEndInTheDepthOrWhereTheyLeaveTheTissue) {
    const Scene scene = plateAndBlock();
    for (const Lens lens : {Lens::perspective, Lens::fisheye, Lens::orthographic}) {
        const Camera camera = ahead(lens);
        const auto wall = wallOf(camera);
        const auto ends =
            endsBeneathWall(scene, camera, Band::whole(size.x, size.y), wall, 10.0, 2);
        ASSERT_EQ(ends->size, size);
        EXPECT_EQ(
            ends->pixels,
            endsBeneathWall(scene, camera, Band::whole(size.x, size.y), wall, 10.0, 1)->pixels);
        int plate = 0, block = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const std::size_t n = std::size_t(y * size.x + x);
                const glm::vec4 end = ends->pixels[n];
                EXPECT_EQ(glm::vec3(end), glm::vec3(0.0f)) << "it is black behind them";
                // Right is forward × up: towards +x.
                const auto along = rayThrough(
                    camera, (glm::dvec2(x, y) + 0.5 - 0.5 * glm::dvec2(size)) / double(size.y));
                const double slope = along ? along->z : 1.0;
                if (x < size.x / 2 - 1) {
                    EXPECT_NEAR((end.w - wall[n]) * slope, 4.0, 0.9);
                    ++plate;
                } else if (x > size.x / 2) {
                    EXPECT_NEAR(end.w - wall[n], 10.0, 1e-4);
                    ++block;
                }
            }
        EXPECT_GT(plate, 100);
        EXPECT_GT(block, 100);
    }
}

TEST(BeneathWall, BandsHaveTheEndsOfTheWhole) {
    const Scene scene = plateAndBlock();
    const Camera camera = ahead(Lens::perspective);
    const auto wall = wallOf(camera);
    const auto whole = endsBeneathWall(scene, camera, Band::whole(size.x, size.y), wall, 10.0, 1);
    const std::size_t first = 40 * 7, count = 40 * 5;
    const auto part = endsBeneathWall(scene, camera, {size, 7, 5},
                                      std::span(wall).subspan(first, count), 10.0, 1);
    ASSERT_EQ(part->pixels.size(), whole->pixels.size());
    for (std::size_t n = 0; n < count; ++n)
        EXPECT_EQ(part->pixels[first + n], whole->pixels[first + n]);
}

TEST(BeneathWall, ARayThatSeesNoWallHasNoEnd) {
    const Camera camera = ahead(Lens::perspective);
    auto wall = wallOf(camera);
    wall[7] = -1.0f;
    const auto ends =
        endsBeneathWall(plateAndBlock(), camera, Band::whole(size.x, size.y), wall, 10.0, 1);
    EXPECT_GT(ends->pixels[7].w, 1e6f);
    EXPECT_LT(ends->pixels[8].w, 60.0f);
}

}  // namespace
}  // namespace haustra::render
