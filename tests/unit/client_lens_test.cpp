// The lens over an endoscopic view registers with what is beneath it, whatever the lenses.
#include "reader/lens_view.h"

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

struct Ray {
    glm::dvec3 fromMm, direction;
};

// As core/camera.h defines lenses, by the picture's heights.
std::optional<Ray> rayOf(const Camera& camera, glm::dvec2 place) {
    if (camera.lens != Lens::orthographic) {
        const auto direction = rayThrough(camera, place);
        if (!direction) return std::nullopt;
        return Ray{camera.positionMm, *direction};
    }
    const glm::dvec3 ahead = glm::normalize(camera.forward),
                     right = glm::normalize(glm::cross(ahead, camera.up)),
                     down = glm::cross(ahead, right);
    return Ray{camera.positionMm + camera.heightMm * (place.x * right + place.y * down), ahead};
}

// What a ray sees: waves across directions and places, some pixels long.
glm::dvec3 seenBy(const Ray& ray) {
    const glm::dvec3 d = 14.0 * ray.direction + 0.4 * ray.fromMm;
    return 127.5 + 120.0 * glm::dvec3(std::sin(d.x + 0.3 * d.y), std::sin(d.y - 0.5 * d.z),
                                      std::cos(d.z + 0.2 * d.x));
}

tiles::Picture pictureOf(const Camera& camera, int width, int height) {
    tiles::Picture picture;
    picture.width = width, picture.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto ray =
                rayOf(camera,
                      (glm::dvec2(x, y) + 0.5 - 0.5 * glm::dvec2(width, height)) / double(height));
            const glm::dvec3 color = ray ? seenBy(*ray) : glm::dvec3(0.0);
            for (const double share : {color.b, color.g, color.r, 255.0})
                picture.pixels.push_back(std::uint8_t(std::lround(share)));
        }
    return picture;
}

Camera looking(Lens lens, double fovDegrees) {
    Camera camera;
    camera.positionMm = {3, -4, 5};
    camera.forward = {0.4, -0.5, 2.0};
    camera.up = {0.3, -1.0, 0.1};  // neither unit nor orthogonal
    camera.fovDegrees = fovDegrees;
    camera.lens = lens;
    camera.heightMm = 40.0;
    return camera;
}

struct Difference {
    double mean = 0.0, greatest = 0.0;
    int pixels = 0;
};
// Between the picture beneath and what lies over it.
Difference compare(const tiles::Picture& beneath, const LensDisc& disc) {
    Difference found;
    for (int y = 0; y < disc.side; ++y)
        for (int x = 0; x < disc.side; ++x) {
            const std::uint32_t over =
                disc.pixels[std::size_t(y) * std::size_t(disc.side) + std::size_t(x)];
            const glm::ivec2 at = disc.corner + glm::ivec2(x, y);
            if (over >> 24 != 255 || at.x < 0 || at.y < 0 || at.x >= beneath.width ||
                at.y >= beneath.height)
                continue;
            const std::uint8_t* under =
                beneath.pixels.data() +
                4 * (std::size_t(at.y) * std::size_t(beneath.width) + std::size_t(at.x));
            for (int c = 0; c < 3; ++c) {
                const double difference = std::abs(double(over >> (8 * c) & 255) - under[c]);
                found.mean += difference;
                found.greatest = std::max(found.greatest, difference);
            }
            ++found.pixels;
        }
    found.mean /= std::max(1, 3 * found.pixels);
    return found;
}

TEST(Lens, OfTheSameOpticsReproducesThePictureBeneath) {
    for (const Camera& beneath :
         {looking(Lens::perspective, 60.0), looking(Lens::perspective, 130.0),
          looking(Lens::fisheye, 150.0), looking(Lens::fisheye, 240.0),
          looking(Lens::orthographic, 90.0)}) {
        const tiles::Picture picture = pictureOf(beneath, 400, 300);
        for (const LensPlace& place :
             {LensPlace{{0.0, 0.0}, 0.15}, LensPlace{{0.35, -0.3}, 0.15},
              LensPlace{{-0.55, 0.4}, 0.2}, LensPlace{{0.1, 0.05}, 0.45}}) {
            SCOPED_TRACE(testing::Message() << int(beneath.lens) << " " << beneath.fovDegrees << " "
                                            << place.center.x << " " << place.radius);
            const auto camera = cameraOfLens(beneath, place);
            ASSERT_TRUE(camera);
            ASSERT_TRUE(checkCamera(*camera)) << describe(checkCamera(*camera).error());
            ASSERT_TRUE(registers(*camera, beneath));
            const LensDisc disc = throughLens(pictureOf(*camera, 320, 320), *camera, beneath, place,
                                              {picture.width, picture.height});
            const Difference found = compare(picture, disc);
            EXPECT_LT(found.mean, 0.7);
            EXPECT_LT(found.greatest, 10.0);
            // All of it is covered, as far as it lies in the picture.
            int within = 0;
            for (int y = 0; y < picture.height; ++y)
                for (int x = 0; x < picture.width; ++x) {
                    const glm::dvec2 at = glm::dvec2(x, y) + 0.5 - glm::dvec2(200, 150);
                    within +=
                        glm::distance(at, 300.0 * place.center) < 300.0 * place.radius - 1.0 &&
                        rayOf(beneath, at / 300.0);
                }
            EXPECT_GE(found.pixels, within);
        }
    }
}

// The test above would find an error of half a pixel.
TEST(Lens, HalfAPixelWouldBeSeen) {
    const Camera beneath = looking(Lens::perspective, 90.0);
    const LensPlace place{{0.1, 0.1}, 0.2};
    const Camera camera = *cameraOfLens(beneath, place);
    LensPlace beside = place;
    beside.center.x += 0.5 / 300.0;
    const Camera other = *cameraOfLens(beneath, beside);
    const LensDisc disc =
        throughLens(pictureOf(other, 320, 320), camera, beneath, place, {400, 300});
    EXPECT_GT(compare(pictureOf(beneath, 400, 300), disc).mean, 1.5);
}

TEST(Lens, APictureOfAnotherPlaceDoesNotRegister) {
    const Camera beneath = looking(Lens::perspective, 90.0);
    Camera moved = *cameraOfLens(beneath, {});
    EXPECT_TRUE(registers(moved, beneath));
    moved.positionMm.x += 0.1;
    EXPECT_FALSE(registers(moved, beneath));
    // Turned, it does: rays from one place see the same.
    Camera turned = beneath;
    turned.forward += glm::dvec3(0.2, 0.0, 0.0);
    EXPECT_TRUE(registers(*cameraOfLens(beneath, {}), turned));
    EXPECT_FALSE(registers(looking(Lens::orthographic, 90.0), beneath));
    // Parallel rays: to one side, but not ahead or turned.
    const Camera flat = looking(Lens::orthographic, 90.0);
    Camera lens = *cameraOfLens(flat, {{0.2, 0.1}, 0.1});
    EXPECT_TRUE(registers(lens, flat));
    lens.positionMm += 0.01 * flat.forward;
    EXPECT_FALSE(registers(lens, flat));
}

TEST(Lens, BeyondTheLensItsPictureAndAFisheyesRimNothingIsShown) {
    const Camera beneath = looking(Lens::perspective, 90.0);
    const LensPlace place{{0.1, 0.1}, 0.2};
    const Camera camera = *cameraOfLens(beneath, place);
    const tiles::Picture picture = pictureOf(camera, 64, 64);
    // The lens has moved on: of its new place only what the picture reaches.
    const LensPlace moved{{0.35, 0.1}, 0.2}, away{{-0.5, 0.1}, 0.2};
    const auto shown = [&](const LensPlace& at) {
        const LensDisc disc = throughLens(picture, camera, beneath, at, {400, 300});
        return std::count_if(disc.pixels.begin(), disc.pixels.end(),
                             [](std::uint32_t p) { return p != 0; });
    };
    const auto all = shown(place), part = shown(moved);
    EXPECT_NEAR(double(all), 3.1416 * 60 * 60, 400.0);
    EXPECT_GT(part, 0);
    EXPECT_LT(part, 2 * all / 3);
    EXPECT_EQ(shown(away), 0);
    EXPECT_FALSE(cameraOfLens(looking(Lens::fisheye, 300.0), {{0.7, 0.0}, 0.1}));
}

}  // namespace
}  // namespace haustra::reader
