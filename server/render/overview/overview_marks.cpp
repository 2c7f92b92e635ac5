#include "render/overview/overview_marks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::render {

namespace {

/// Linear light. The wall is paler than the mucosa's preset, so that what is drawn on it stands
/// out.
constexpr glm::dvec3 wallColor{0.66, 0.36, 0.27}, pathColor{0.10, 0.80, 0.22},
    readerColor{0.02, 0.62, 0.85}, bookmarkColor{0.95, 0.52, 0.03};
/// What shows of a mark far behind a wall.
constexpr double pathShown = 0.12, readerShown = 0.85, bookmarkShown = 0.55;
/// Parts of the picture's height.
constexpr double tubeRadius = 0.0035, coneLength = 0.075, coneRadius = 0.028, ballRadius = 0.014;

struct Ring {
    glm::dvec3 center, normal, axis;  // unit, orthogonal
    double radius;
};

/// Any unit vector orthogonal to `v`.
glm::dvec3 orthogonalTo(glm::dvec3 v) {
    const glm::dvec3 a = glm::abs(v);
    const glm::dvec3 least = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                             : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                      : glm::dvec3(0, 0, 1);
    return glm::normalize(glm::cross(v, least));
}

class ShapeBuilder {
public:
    ShapeBuilder(OverviewShapes& shapes, glm::dvec3 originMm)
        : shapes_(shapes), originMm_(originMm) {}

    void style(glm::dvec3 color, double shown) {
        color_ = color;
        shown_ = shown;
    }
    std::uint32_t vertex(glm::dvec3 placeMm, glm::dvec3 normal) {
        shapes_.vertices.push_back(
            {placeMm - originMm_, float(shown_), glm::vec4(normal, 0.0), glm::vec4(color_, 0.0)});
        return std::uint32_t(shapes_.vertices.size() - 1);
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        shapes_.indices.insert(shapes_.indices.end(), {a, b, c});
    }

    /// `sides` vertices around the axis; `slope` tilts their normals towards it.
    std::uint32_t ring(const Ring& ring, int sides, double slope = 0.0) {
        const glm::dvec3 across = glm::cross(ring.axis, ring.normal);
        const auto first = std::uint32_t(shapes_.vertices.size());
        for (int side = 0; side < sides; ++side) {
            const double angle = 2.0 * std::numbers::pi * side / sides;
            const glm::dvec3 out = std::cos(angle) * ring.normal + std::sin(angle) * across;
            vertex(ring.center + ring.radius * out, glm::normalize(out + slope * ring.axis));
        }
        return first;
    }
    void joinRings(std::uint32_t a, std::uint32_t b, int sides) {
        for (int side = 0; side < sides; ++side) {
            const auto i = std::uint32_t(side), next = std::uint32_t((side + 1) % sides);
            triangle(a + i, a + next, b + next);
            triangle(a + i, b + next, b + i);
        }
    }

    void ball(glm::dvec3 center, double radius) {
        constexpr int sides = 20, rows = 10;
        std::uint32_t before = 0;
        for (int row = 0; row <= rows; ++row) {
            const double polar = std::numbers::pi * row / rows;
            const auto first = std::uint32_t(shapes_.vertices.size());
            for (int side = 0; side < sides; ++side) {
                const double angle = 2.0 * std::numbers::pi * side / sides;
                const glm::dvec3 out(std::sin(polar) * std::cos(angle),
                                     std::sin(polar) * std::sin(angle), std::cos(polar));
                vertex(center + radius * out, out);
            }
            if (row > 0) joinRings(before, first, sides);
            before = first;
        }
    }

    /// Wide where it ends.
    void cone(glm::dvec3 apex, glm::dvec3 axis, double length, double radius) {
        constexpr int sides = 24;
        const glm::dvec3 normal = orthogonalTo(axis), base = apex + length * axis;
        const double slope = -radius / length;
        const auto tip = ring({apex, normal, axis, 0.0}, sides, slope);
        const auto rim = ring({base, normal, axis, radius}, sides, slope);
        joinRings(tip, rim, sides);
        const auto lid = ring({base, normal, axis, radius}, sides, 1e6);
        const auto middle = vertex(base, axis);
        for (int side = 0; side < sides; ++side)
            triangle(middle, lid + std::uint32_t(side), lid + std::uint32_t((side + 1) % sides));
    }

private:
    OverviewShapes& shapes_;
    glm::dvec3 originMm_;
    glm::dvec3 color_{1.0};
    double shown_ = 1.0;
};

void addPath(ShapeBuilder& shapes, const Centerline& path, const Camera& camera) {
    constexpr int sides = 8;
    shapes.style(pathColor, pathShown);
    const auto& points = path.points;
    glm::dvec3 normal(0.0);
    bool joined = false;
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 chord = points[std::min(i + 1, points.size() - 1)].positionMm -
                                 points[i > 0 ? i - 1 : 0].positionMm;
        if (points[i].gap || !(glm::length(chord) > 0.0)) {
            joined = false;
            continue;
        }
        const glm::dvec3 axis = glm::normalize(chord);
        normal -= glm::dot(normal, axis) * axis;  // carried along without twist
        normal = glm::length(normal) > 1e-3 ? glm::normalize(normal) : orthogonalTo(axis);
        const glm::dvec3 center = points[i].positionMm;
        const auto ring = shapes.ring(
            {center, normal, axis, tubeRadius * pictureHeightMm(camera, center)}, sides);
        if (joined) shapes.joinRings(before, ring, sides);
        before = ring;
        joined = true;
    }
}

}  // namespace

double pictureHeightMm(const Camera& camera, glm::dvec3 placeMm) {
    if (camera.lens == Lens::orthographic) return camera.heightMm;
    const double depth = glm::dot(placeMm - camera.positionMm, glm::normalize(camera.forward));
    return 2.0 * std::max(depth, 0.0) * std::tan(glm::radians(0.5 * camera.fovDegrees));
}

OverviewShapes wallShape(const TriMesh& wall, glm::dvec3 originMm) {
    std::vector<glm::dvec3> normals(wall.vertices.size(), glm::dvec3(0.0));
    OverviewShapes shapes;
    shapes.indices.reserve(3 * wall.triangles.size());
    for (const glm::ivec3 t : wall.triangles) {
        const glm::dvec3 a = wall.vertices[std::size_t(t.x)];
        const glm::dvec3 area =
            glm::cross(wall.vertices[std::size_t(t.y)] - a, wall.vertices[std::size_t(t.z)] - a);
        for (int corner = 0; corner < 3; ++corner) {
            normals[std::size_t(t[corner])] += area;
            shapes.indices.push_back(std::uint32_t(t[corner]));
        }
    }
    shapes.vertices.reserve(wall.vertices.size());
    for (std::size_t i = 0; i < wall.vertices.size(); ++i) {
        const double length = glm::length(normals[i]);
        const glm::dvec3 normal = length > 0.0 ? normals[i] / length : glm::dvec3(0.0, 0.0, 1.0);
        shapes.vertices.push_back(
            {wall.vertices[i] - originMm, 0.0f, glm::vec4(normal, 0.0), glm::vec4(wallColor, 0.0)});
    }
    return shapes;
}

OverviewShapes markShapes(const OverviewView& view, const Centerline* path, glm::dvec3 originMm) {
    OverviewShapes shapes;
    ShapeBuilder builder(shapes, originMm);
    if (view.path && path) addPath(builder, *path, view.camera);
    builder.style(bookmarkColor, bookmarkShown);
    for (const glm::dvec3 place : view.bookmarksMm)
        builder.ball(place, ballRadius * pictureHeightMm(view.camera, place));
    if (view.reader) {
        const glm::dvec3 apex = view.reader->positionMm;
        const double height = pictureHeightMm(view.camera, apex);
        builder.style(readerColor, readerShown);
        builder.cone(apex, glm::normalize(view.reader->forward), coneLength * height,
                     coneRadius * height);
    }
    return shapes;
}

}  // namespace haustra::render
