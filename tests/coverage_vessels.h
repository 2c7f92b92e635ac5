// Closed vessels of known shape for simulated colonoscopies.
#pragma once

#include "core/centerline.h"
#include "core/tri_mesh.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace haustra::tests {

/// Round the z axis: `profile` runs from a point on the axis to another farther up, as (radius, z).
/// Triangles are counter-clockwise seen from outside.
inline TriMesh revolved(const std::vector<glm::dvec2>& profile, int around) {
    TriMesh mesh;
    const auto rings = int(profile.size()) - 2;
    mesh.vertices.push_back({0.0, 0.0, profile.front().y});
    for (int n = 1; n <= rings; ++n) {
        for (int i = 0; i < around; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / around;
            const glm::dvec2 at = profile[std::size_t(n)];
            mesh.vertices.push_back({at.x * std::cos(angle), at.x * std::sin(angle), at.y});
        }
    }
    mesh.vertices.push_back({0.0, 0.0, profile.back().y});
    const auto at = [&](int ring, int i) { return 1 + ring * around + i % around; };
    const int last = int(mesh.vertices.size()) - 1;
    for (int i = 0; i < around; ++i) {
        mesh.triangles.push_back({0, at(0, i + 1), at(0, i)});
        mesh.triangles.push_back({last, at(rings - 1, i), at(rings - 1, i + 1)});
    }
    for (int n = 0; n + 1 < rings; ++n) {
        for (int i = 0; i < around; ++i) {
            mesh.triangles.push_back({at(n, i), at(n, i + 1), at(n + 1, i + 1)});
            mesh.triangles.push_back({at(n, i), at(n + 1, i + 1), at(n + 1, i)});
        }
    }
    return mesh;
}

/// Points from `from` to `to`, `from` left out, at most `stepMm` apart.
inline void lineTo(std::vector<glm::dvec2>& profile, glm::dvec2 to, double stepMm) {
    const glm::dvec2 from = profile.back();
    const int steps = std::max(1, int(std::ceil(glm::distance(from, to) / stepMm)));
    for (int n = 1; n <= steps; ++n)
        profile.push_back(glm::mix(from, to, double(n) / steps));
}

/// A tube with half balls for ends, from z = 0 to `lengthMm`.
inline TriMesh capsule(double radiusMm, double lengthMm, int around) {
    std::vector<glm::dvec2> profile;
    const int steps = around / 4;
    for (int n = 0; n <= steps; ++n) {
        const double angle = 0.5 * std::numbers::pi * n / steps;
        profile.push_back({radiusMm * std::sin(angle), radiusMm * (1.0 - std::cos(angle))});
    }
    profile.front().x = 0.0;
    lineTo(profile, {radiusMm, lengthMm - radiusMm}, 1.4);
    for (int n = steps - 1; n >= 0; --n) {
        const double angle = 0.5 * std::numbers::pi * n / steps;
        profile.push_back({n == 0 ? 0.0 : radiusMm * std::sin(angle),
                           lengthMm - radiusMm * (1.0 - std::cos(angle))});
    }
    return revolved(profile, around);
}

/// A tube of radius 15 from z = 0 to 140 with a thin fold that stands in to radius 8 from z = 60 to
/// 62. From the axis up to z = 40 nothing is seen of what lies behind it up to z = 81.25; a ring of
/// vertices lies at pocketEndMm, so that all triangles are wholly on one side.
inline constexpr double pocketBeginMm = 62.0, pocketEndMm = 81.2, lastEyeMm = 40.0;
inline TriMesh pocketTube(int around = 72) {
    std::vector<glm::dvec2> profile{{0.0, 0.0}};
    lineTo(profile, {15.0, 0.0}, 1.4);
    lineTo(profile, {15.0, 60.0}, 1.4);
    lineTo(profile, {8.0, 60.0}, 1.4);
    lineTo(profile, {8.0, pocketBeginMm}, 1.4);
    lineTo(profile, {15.0, pocketBeginMm}, 1.4);
    lineTo(profile, {15.0, pocketEndMm}, 1.4);
    lineTo(profile, {15.0, 140.0}, 1.4);
    lineTo(profile, {0.0, 140.0}, 1.4);
    return revolved(profile, around);
}

/// A tube of 200 mm whose axis and width swing, with folds all along it that hide what lies behind.
inline glm::dvec3 foldedAxis(double z) {
    return {14.0 * std::sin(z / 28.0), 10.0 * std::cos(z / 35.0), z};
}
inline TriMesh foldedTube(int around = 72) {
    std::vector<glm::dvec2> profile{{0.0, 0.0}};
    for (double z = 0.0; z <= 200.0; z += 1.2) {
        const double phase = z / 18.0 - std::floor(z / 18.0);
        const double fold = std::exp(-std::pow((phase - 0.5) / 0.09, 2.0));
        const double ends = std::min({1.0, (z + 2.0) / 14.0, (204.0 - z) / 14.0});
        profile.push_back({(17.0 - 9.0 * fold) * std::sqrt(ends * (2.0 - ends)), z});
    }
    profile.push_back({0.0, 200.6});
    TriMesh mesh = revolved(profile, around);
    for (glm::dvec3& v : mesh.vertices)
        v += glm::dvec3(glm::dvec2(foldedAxis(v.z)), 0.0);
    return mesh;
}

/// Along the axis, a millimetre apart.
template <class Place>
Centerline lineThrough(const Place& place, double from, double to) {
    Centerline line;
    for (double z = from; z <= to; z += 1.0) {
        const glm::dvec3 mm = place(z);
        const double arc =
            line.points.empty()
                ? 0.0
                : line.points.back().arcMm + glm::distance(mm, line.points.back().positionMm);
        line.points.push_back({mm, arc, 8.0, false});
    }
    return line;
}
inline Centerline straightLine(double from, double to) {
    return lineThrough([](double z) { return glm::dvec3(0.0, 0.0, z); }, from, to);
}

inline double triangleAreaMm2(const TriMesh& mesh, std::size_t triangle) {
    const glm::ivec3 t = mesh.triangles[triangle];
    const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
    return 0.5 * glm::length(glm::cross(mesh.vertices[std::size_t(t.y)] - a,
                                        mesh.vertices[std::size_t(t.z)] - a));
}

}  // namespace haustra::tests
