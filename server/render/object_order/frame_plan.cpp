#include "render/object_order/frame_plan.h"

#include "render/scene/lens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace haustra::render {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

glm::dvec3 corner(glm::dvec3 low, glm::dvec3 high, int which) {
    return {which & 1 ? high.x : low.x, which & 2 ? high.y : low.y, which & 4 ? high.z : low.z};
}

struct Bounds {
    glm::dvec2 low{infinity}, high{-infinity};
    void add(glm::dvec2 p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

}  // namespace

Footprint::Footprint(const Camera& camera, const Grid& grid, glm::ivec2 pictureSize)
    : lens_(camera.lens), size_(pictureSize) {
    const LensFrame frame = lensFrame(camera, 1.0);
    perUnit_ = 1.0 / glm::length(frame.down);
    const glm::dvec3 right = glm::normalize(frame.right), down = glm::normalize(frame.down);
    glm::dmat4 cameraFromPatient(1.0);
    for (int axis = 0; axis < 3; ++axis)
        cameraFromPatient[axis] = {right[axis], down[axis], frame.ahead[axis], 0.0};
    cameraFromPatient[3] =
        glm::dvec4(-glm::dvec3(cameraFromPatient * glm::dvec4(camera.positionMm, 0.0)), 1.0);
    cameraFromVoxel_ = cameraFromPatient * grid.patientFromVoxel;
}

PixelRect Footprint::around(glm::dvec2 low, glm::dvec2 high) const {
    PixelRect rect;
    for (int axis = 0; axis < 2; ++axis) {
        const auto pixel = [&](double at) {
            return std::clamp(0.5 * (at * size_.y + size_[axis]), -2.0, size_[axis] + 2.0);
        };
        rect.low[axis] = std::max(int(std::floor(pixel(low[axis]))) - 1, 0);
        rect.high[axis] = std::min(int(std::ceil(pixel(high[axis]))) + 1, size_[axis]);
    }
    return rect;
}

PixelRect Footprint::of(glm::dvec3 low, glm::dvec3 high) const {
    // A hair more, for what rounding takes for inside.
    low -= 1e-3;
    high += 1e-3;
    switch (lens_) {
        case Lens::fisheye:
            return fisheye(low, high);
        case Lens::orthographic:
            return orthographic(low, high);
        default:
            return perspective(low, high);
    }
}

PixelRect Footprint::perspective(glm::dvec3 low, glm::dvec3 high) const {
    glm::dvec3 corners[8];
    double size = 0.0;
    bool ahead = false;
    for (int i = 0; i < 8; ++i) {
        corners[i] = inCamera(corner(low, high, i));
        size = std::max(size, glm::length(corners[i]));
        ahead = ahead || corners[i].z > 0.0;
    }
    if (!ahead) return {};
    // What is cut off lies all in the plane of the eye: no ray of the picture meets it.
    const double near = 1e-9 * size;
    Bounds bounds;
    for (int i = 0; i < 8; ++i) {
        if (corners[i].z > near) bounds.add(glm::dvec2(corners[i]) / corners[i].z);
        for (const int other : {i ^ 1, i ^ 2, i ^ 4}) {
            const glm::dvec3 &a = corners[i], &b = corners[other];
            if (other < i || (a.z > near) == (b.z > near)) continue;
            const glm::dvec3 cut = a + (near - a.z) / (b.z - a.z) * (b - a);
            bounds.add(glm::dvec2(cut) / near);
        }
    }
    return around(bounds.low * perUnit_, bounds.high * perUnit_);
}

PixelRect Footprint::orthographic(glm::dvec3 low, glm::dvec3 high) const {
    Bounds bounds;
    bool ahead = false;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 at = inCamera(corner(low, high, i));
        bounds.add(glm::dvec2(at));
        ahead = ahead || at.z >= 0.0;
    }
    if (!ahead) return {};
    return around(bounds.low * perUnit_, bounds.high * perUnit_);
}

// The box's sphere, seen from the eye, is a disc of directions.
PixelRect Footprint::fisheye(glm::dvec3 low, glm::dvec3 high) const {
    const glm::dvec3 center = inCamera(0.5 * (low + high));
    double radius = 0.0;
    for (int i = 0; i < 4; ++i)  // opposite corners are as far
        radius = std::max(radius, glm::distance(center, inCamera(corner(low, high, i))));
    const double distance = glm::length(center);
    const double whole = double(size_.x + size_.y);
    if (distance <= radius) return around(glm::dvec2(-whole), glm::dvec2(whole));
    const double spread = std::asin(radius / distance);
    const double axis = std::atan2(glm::length(glm::dvec2(center)), center.z);
    const double inner = std::max(axis - spread, 0.0) * perUnit_;
    const double outer = std::min(axis + spread, std::numbers::pi) * perUnit_;
    Bounds bounds;
    const bool allAround = axis <= spread || axis + spread >= std::numbers::pi;
    const double turn =
        allAround ? std::numbers::pi : std::asin(std::min(std::sin(spread) / std::sin(axis), 1.0));
    const double middle = std::atan2(center.y, center.x);
    const auto add = [&](double angle) {
        const glm::dvec2 way(std::cos(angle), std::sin(angle));
        bounds.add(outer * way);
        bounds.add(inner * way);
    };
    add(middle - turn);
    add(middle + turn);
    for (int quarter = -4; quarter <= 4; ++quarter)
        if (const double angle = 0.5 * std::numbers::pi * quarter; std::abs(angle - middle) <= turn)
            add(angle);
    return around(bounds.low, bounds.high);
}

std::vector<PlannedCell> planFrame(const CellGrid& cells, const std::vector<std::uint8_t>& needed,
                                   const Grid& grid, const Camera& camera, glm::ivec2 pictureSize,
                                   int firstRow, int rows) {
    const Footprint footprint(camera, grid, pictureSize);
    const glm::ivec3 source = sourceCell(cells, camera, grid);
    std::vector<PlannedCell> planned;
    const int layers = lastLayer(cells, source);
    for (int layer = 0; layer <= layers; ++layer)
        forEachCellOfLayer(cells, source, layer, [&](glm::ivec3 cell) {
            const int index = cells.index(cell);
            if (!needed[std::size_t(index)]) return;
            PixelRect seen = footprint.of(cells.low(cell), cells.high(cell));
            seen.low.y = std::max(seen.low.y - firstRow, 0);
            seen.high.y = std::min(seen.high.y - firstRow, rows);
            if (seen.empty()) return;
            planned.push_back(
                {index, layer, {seen.low / rayTile, (seen.high + rayTile - 1) / rayTile}});
        });
    return planned;
}

}  // namespace haustra::render
