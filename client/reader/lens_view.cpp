#include "reader/lens_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::reader {
namespace {

// The lens's picture reaches a little beyond its rim: rounding, and the hand's next movement.
constexpr double margin = 1.1;
constexpr int rimSamples = 48;

/// What a camera's pictures are made of.
struct Axes {
    explicit Axes(const Camera& of)
        : camera(of),
          ahead(glm::normalize(of.forward)),
          right(glm::normalize(glm::cross(ahead, of.up))),
          down(glm::cross(ahead, right)) {}
    const Camera& camera;
    glm::dvec3 ahead, right, down;

    glm::dvec3 aside(glm::dvec2 place) const { return place.x * right + place.y * down; }
    glm::dvec2 across(glm::dvec3 v) const { return {glm::dot(v, right), glm::dot(v, down)}; }
};

/// A place on the ray through a place of the picture: 1 mm before the camera, or on the plane of an
/// orthographic one.
std::optional<glm::dvec3> placeOn(const Axes& axes, glm::dvec2 place) {
    const Camera& camera = axes.camera;
    if (camera.lens == Lens::orthographic)
        return camera.positionMm + camera.heightMm * axes.aside(place);
    if (camera.lens == Lens::perspective)
        return camera.positionMm + axes.ahead +
               2.0 * std::tan(glm::radians(0.5 * camera.fovDegrees)) * axes.aside(place);
    const auto direction = rayThrough(camera, place);
    if (!direction) return std::nullopt;
    return camera.positionMm + *direction;
}

/// And where in its picture a camera shows a place.
std::optional<glm::dvec2> placeIn(const Axes& axes, glm::dvec3 pointMm) {
    const Camera& camera = axes.camera;
    const glm::dvec3 to = pointMm - camera.positionMm;
    const glm::dvec2 across = axes.across(to);
    if (camera.lens == Lens::orthographic) return across / camera.heightMm;
    const double depth = glm::dot(to, axes.ahead), sine = glm::length(across),
                 half = glm::radians(0.5 * camera.fovDegrees);
    if (camera.lens == Lens::fisheye)
        return sine > 0.0 ? across * (0.5 * std::atan2(sine, depth) / (half * sine)) : across;
    if (!(depth > 0.0)) return std::nullopt;
    return across * (0.5 / (depth * std::tan(half)));
}

glm::dvec4 pixelOf(const tiles::Picture& picture, int x, int y) {
    const std::uint8_t* at =
        picture.pixels.data() + 4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
    return {at[0], at[1], at[2], 1.0};
}

/// Blue, green, red; `at` in pixels, whose middles are at halves. None beyond the picture.
std::optional<glm::dvec3> colorAt(const tiles::Picture& picture, glm::dvec2 at) {
    const glm::dvec2 size(picture.width, picture.height);
    if (at.x < 0.0 || at.y < 0.0 || at.x > size.x || at.y > size.y) return std::nullopt;
    const glm::dvec2 low = glm::clamp(at - 0.5, glm::dvec2(0.0), size - 1.0);
    const glm::ivec2 a(glm::floor(low)), b = glm::min(a + 1, glm::ivec2(size) - 1);
    const glm::dvec2 share = low - glm::dvec2(a);
    return glm::dvec3(glm::mix(
        glm::mix(pixelOf(picture, a.x, a.y), pixelOf(picture, b.x, a.y), share.x),
        glm::mix(pixelOf(picture, a.x, b.y), pixelOf(picture, b.x, b.y), share.x), share.y));
}

}  // namespace

std::optional<Camera> cameraOfLens(const Camera& beneath, const LensPlace& place) {
    if (!checkCamera(beneath)) return std::nullopt;
    const Axes axes(beneath);
    const auto middle = placeOn(axes, place.center);
    if (!middle) return std::nullopt;
    Camera lens = beneath;
    if (beneath.lens == Lens::orthographic) {
        lens.positionMm = *middle;
        lens.heightMm = 2.0 * margin * place.radius * beneath.heightMm;
        return lens;
    }
    lens.forward = glm::normalize(*middle - beneath.positionMm);
    // What is up in the picture beneath, there.
    constexpr double little = 1e-4;
    const auto above = placeOn(axes, place.center - glm::dvec2(0.0, little)),
               below = placeOn(axes, place.center + glm::dvec2(0.0, little));
    if (above && below) lens.up = *above - *below;
    lens.up -= glm::dot(lens.up, lens.forward) * lens.forward;
    if (!(glm::length(lens.up) > 1e-9)) return std::nullopt;
    lens.up = glm::normalize(lens.up);
    double widest = 0.0;  // angle to the rim
    for (int n = 0; n < rimSamples; ++n) {
        const double turn = 2.0 * std::numbers::pi * n / rimSamples;
        const auto rim =
            placeOn(axes, place.center + place.radius * glm::dvec2(std::cos(turn), std::sin(turn)));
        if (!rim) continue;
        const double cosine = glm::dot(glm::normalize(*rim - beneath.positionMm), lens.forward);
        widest = std::max(widest, std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
    // Of a wide picture a perspective would spend its pixels on the rim.
    constexpr double widestPerspective = 40.0;
    if (glm::degrees(widest) > widestPerspective) lens.lens = Lens::fisheye;
    lens.fovDegrees = std::clamp(glm::degrees(2.0 * margin * widest), 1.0, 360.0);
    return lens;
}

bool registers(const Camera& lens, const Camera& beneath) {
    constexpr double closeMm = 1e-6;
    const bool parallel = beneath.lens == Lens::orthographic;
    if ((lens.lens == Lens::orthographic) != parallel) return false;
    const glm::dvec3 apart = lens.positionMm - beneath.positionMm;
    if (!parallel) return glm::length(apart) < closeMm;
    const glm::dvec3 ahead = glm::normalize(beneath.forward);
    return glm::distance(glm::normalize(lens.forward), ahead) < 1e-9 &&
           std::abs(glm::dot(apart, ahead)) < closeMm;
}

LensDisc throughLens(const tiles::Picture& picture, const Camera& lens, const Camera& beneath,
                     const LensPlace& place, glm::ivec2 size) {
    LensDisc disc;
    const double height = size.y, radius = place.radius * height;
    if (size.x < 1 || size.y < 1 || picture.width < 1 || !(radius < 4096.0)) return disc;
    const glm::dvec2 middle = 0.5 * glm::dvec2(size), center = middle + height * place.center;
    disc.corner = glm::ivec2(glm::floor(center - radius));
    disc.side = int(std::ceil(2.0 * radius)) + 1;
    disc.pixels.assign(std::size_t(disc.side) * std::size_t(disc.side), 0);
    const Axes from(beneath), into(lens);
    const glm::dvec2 lensSize(picture.width, picture.height);
    for (int y = 0; y < disc.side; ++y) {
        for (int x = 0; x < disc.side; ++x) {
            const glm::dvec2 pixel = glm::dvec2(disc.corner + glm::ivec2(x, y)) + 0.5;
            // The rim covers its pixels in part.
            const double cover = std::min(radius - glm::distance(pixel, center) + 0.5, 1.0);
            if (cover <= 0.0) continue;
            const auto seen = placeOn(from, (pixel - middle) / height);
            const auto there = seen ? placeIn(into, *seen) : std::nullopt;
            const auto color =
                there ? colorAt(picture, 0.5 * lensSize + lensSize.y * *there) : std::nullopt;
            if (!color) continue;
            const glm::uvec3 bgr(glm::round(cover * *color));
            disc.pixels[std::size_t(y) * std::size_t(disc.side) + std::size_t(x)] =
                std::uint32_t(std::lround(255.0 * cover)) << 24 | bgr.z << 16 | bgr.y << 8 | bgr.x;
        }
    }
    return disc;
}

void layOver(tiles::Picture& beneath, const LensDisc& disc) {
    for (int y = 0; y < disc.side; ++y) {
        for (int x = 0; x < disc.side; ++x) {
            const glm::ivec2 at = disc.corner + glm::ivec2(x, y);
            if (at.x < 0 || at.y < 0 || at.x >= beneath.width || at.y >= beneath.height) continue;
            const std::uint32_t over =
                disc.pixels[std::size_t(y) * std::size_t(disc.side) + std::size_t(x)];
            std::uint8_t* pixel =
                beneath.pixels.data() +
                4 * (std::size_t(at.y) * std::size_t(beneath.width) + std::size_t(at.x));
            const std::uint32_t through = 255 - (over >> 24);
            for (int c = 0; c < 3; ++c)
                pixel[c] = std::uint8_t((over >> (8 * c) & 255) + (pixel[c] * through + 127) / 255);
        }
    }
}

}  // namespace haustra::reader
