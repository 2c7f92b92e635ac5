#include "render/flat/flat_geometry.h"

#include "render/scene/picture.h"
#include "render/scene/wall_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace haustra::render {

namespace {

/// The lattice's phase is kept to this part of a pixel, so that windows whose centres differ by
/// whole pixels share one lattice in spite of rounding.
constexpr double phasesPerPixel = 65536.0;

bool finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Result<void> checkFlatMap(const FlatMap& map) {
    const auto bad = [](const char* what) { return fail(ErrorKind::badInput, what, "flat map"); };
    const auto& [vertices, triangles] = map.surface;
    const int count = int(vertices.size()), cameras = int(map.cameras.size());
    if (triangles.empty() || cameras == 0) return bad("has no triangles or no cameras");
    if (map.flat.size() != vertices.size() || map.camera.size() != vertices.size())
        return bad("has not one flat coordinate and one camera for each vertex");
    if (!(map.height > 0.0 && map.height <= maxFlatHeight))
        return bad("is too long or has no height");
    // A hair of rounding may stand out over the strip.
    const auto onStrip = [&](glm::dvec2 flat) {
        return flat.x >= -0.5 && flat.x <= 1.5 && flat.y >= -0.5 && flat.y <= map.height + 0.5;
    };
    if (!std::all_of(map.flat.begin(), map.flat.end(), onStrip))
        return bad("has flat coordinates beyond the strip");
    const auto known = [&](glm::ivec3 t) {
        return std::min({t.x, t.y, t.z}) >= 0 && std::max({t.x, t.y, t.z}) < count;
    };
    if (!std::all_of(triangles.begin(), triangles.end(), known))
        return bad("has triangles of vertices that it has not");
    const auto registered = [&](std::int32_t camera) { return camera >= 0 && camera < cameras; };
    if (!std::all_of(map.camera.begin(), map.camera.end(), registered))
        return bad("names cameras that it has not");
    const auto placed = [](const FlatCamera& camera) {
        return finite(camera.positionMm) && std::isfinite(camera.arcMm);
    };
    if (!std::all_of(vertices.begin(), vertices.end(), finite) ||
        !std::all_of(map.cameras.begin(), map.cameras.end(), placed))
        return bad("has coordinates that are not finite");
    return {};
}

/// Cameras, and the way along the colon: their chord over `chordMm` to either side.
std::vector<shaders::FlatEye> eyes(const std::vector<FlatCamera>& cameras, glm::dvec3 originMm) {
    constexpr double chordMm = 8.0;
    std::vector<shaders::FlatEye> result;
    std::size_t before = 0, after = 0;
    for (const FlatCamera& camera : cameras) {
        while (cameras[before].arcMm < camera.arcMm - chordMm)
            ++before;
        while (after + 1 < cameras.size() && cameras[after].arcMm < camera.arcMm + chordMm)
            ++after;
        const glm::dvec3 chord = cameras[after].positionMm - cameras[before].positionMm;
        const double length = glm::length(chord);
        const glm::dvec3 ahead = length > 0.0 ? chord / length : glm::dvec3(0.0);
        result.push_back({glm::vec4(camera.positionMm - originMm, 0.0), glm::vec4(ahead, 0.0)});
    }
    return result;
}

}  // namespace

Result<std::shared_ptr<const FlatGeometry>> FlatGeometry::of(const FlatMap& map,
                                                             glm::dvec3 originMm) {
    TRY(checkFlatMap(map));
    auto made = std::make_shared<FlatGeometry>();
    made->originMm_ = originMm;
    made->height_ = map.height;
    made->unitsPerCircumference_ = flatUnitsPerCircumference(map.height);
    made->cameras_ = eyes(map.cameras, originMm);
    const std::vector<glm::dvec3> normals = inwardNormals(map.surface);
    made->vertices_.resize(map.flat.size());
    for (std::size_t i = 0; i < map.flat.size(); ++i) {
        const glm::ivec2 flat(glm::round(map.flat[i] * double(made->unitsPerCircumference_)));
        made->vertices_[i] = {glm::ivec4(flat, 0, 0), map.surface.vertices[i] - originMm,
                              float(map.camera[i]), glm::vec4(normals[i], 0.0)};
    }
    const auto& triangles = map.surface.triangles;
    const auto flatY = [&](int triangle, int corner) {
        return map.flat[std::size_t(triangles[std::size_t(triangle)][corner])].y;
    };
    std::vector<double> lowest(triangles.size()), highest(triangles.size());
    for (int t = 0; t < int(triangles.size()); ++t) {
        std::tie(lowest[std::size_t(t)], highest[std::size_t(t)]) =
            std::minmax({flatY(t, 0), flatY(t, 1), flatY(t, 2)});
    }
    std::vector<int>& order = made->mapTriangle_;
    order.resize(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return std::pair(lowest[std::size_t(a)], a) < std::pair(lowest[std::size_t(b)], b);
    });
    double highestSoFar = -INFINITY;
    for (const int t : order) {
        made->triangles_.push_back(triangles[std::size_t(t)]);
        made->lowestY_.push_back(lowest[std::size_t(t)]);
        highestSoFar = std::max(highestSoFar, highest[std::size_t(t)]);
        made->highestYSoFar_.push_back(highestSoFar);
    }
    return made;
}

Result<std::shared_ptr<const FlatGeometry>> FlatGeometry::of(const FlatMap& map, const Grid& grid) {
    return of(map, grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size) - 0.5));
}

TriangleRange FlatGeometry::trianglesWithin(double lowY, double highY) const {
    const auto first = std::lower_bound(highestYSoFar_.begin(), highestYSoFar_.end(), lowY) -
                       highestYSoFar_.begin();
    const auto last = std::upper_bound(lowestY_.begin(), lowestY_.end(), highY) - lowestY_.begin();
    return {int(first), int(std::max(last - first, std::ptrdiff_t(0)))};
}

FlatLattice FlatGeometry::lattice(const FlatWindow& window, const Band& band) const {
    const glm::ivec2 size = band.pictureSize;
    const double pixels = window.pixelsPerUnit, units = unitsPerCircumference_;
    // Pixel (i, j) shows the flat coordinate (edge − (i, j) − ½) / pixels.
    const glm::dvec2 middle(window.center.x - std::floor(window.center.x), window.center.y);
    const glm::dvec2 edge =
        glm::round((middle * pixels + 0.5 * glm::dvec2(size)) * phasesPerPixel) / phasesPerPixel;
    const glm::dvec2 whole = glm::floor(edge);
    const auto flatY = [&](int row) { return window.center.y + (0.5 * size.y - row) / pixels; };
    FlatLattice lattice;
    lattice.triangles =
        trianglesWithin(flatY(band.firstRow + band.rows + 1), flatY(band.firstRow - 1));
    shaders::FlatUniforms& u = lattice.uniforms;
    u.phase = edge - whole;
    u.unitsPerPixel = units / pixels;
    u.pixelsPerUnit = pixels / units;
    const int firstCopy = int(std::floor((edge.x - size.x) / pixels));
    lattice.copies = int(std::floor(edge.x / pixels)) - firstCopy + 1;
    u.lattice = glm::ivec2(whole) - glm::ivec2(0, band.firstRow);
    u.unitsPerCircumference = unitsPerCircumference_;
    u.firstCopy = firstCopy;
    u.pictureSize = {size.x, band.rows};
    u.firstTriangle = lattice.triangles.first;
    u.lastCamera = int(cameras_.size()) - 1;
    u.mostRayAngle = float(flatRay.mostRayAngle);
    u.mostLightAngle = float(flatRay.mostLightAngle);
    u.lampAhead = float(flatRay.lampAhead);
    return lattice;
}

}  // namespace haustra::render
