// Surfaces of revolution round the z axis, whose flat maps are known.
#pragma once

#include "core/tri_mesh.h"
#include "flatten/periodic_map.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace haustra::tests {

/// An open tube: `radiusMm(z)` for z from 0 to `lengthMm`, rings shifted by half a step in turn.
/// Seen from outside the triangles are counter-clockwise.
inline TriMesh openTube(const std::function<double(double)>& radiusMm, double lengthMm, int around,
                        int rings) {
    TriMesh mesh;
    for (int r = 0; r < rings; ++r) {
        for (int i = 0; i < around; ++i) {
            const double angle = 2.0 * std::numbers::pi * (i + 0.5 * (r % 2)) / around;
            const double z = lengthMm * r / (rings - 1);
            mesh.vertices.push_back(
                {radiusMm(z) * std::cos(angle), radiusMm(z) * std::sin(angle), z});
        }
    }
    for (int r = 0; r + 1 < rings; ++r) {
        for (int i = 0; i < around; ++i) {
            const int next = (i + 1) % around, low = r * around, high = low + around;
            const int a = low + i, b = low + next, c = high + i, d = high + next;
            if (r % 2 == 0) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({b, d, c});
            } else {
                mesh.triangles.push_back({a, d, c});
                mesh.triangles.push_back({a, b, d});
            }
        }
    }
    return mesh;
}

/// A tube of one radius with a half ball at each end, from z = −radius to length + radius.
inline TriMesh capsule(double radiusMm, double lengthMm, int around) {
    const double step = 2.0 * std::numbers::pi * radiusMm / around;
    const int capRings = std::max(2, int(std::lround(0.5 * std::numbers::pi * radiusMm / step)));
    const int tubeRings = std::max(1, int(std::lround(lengthMm / step)));
    std::vector<glm::dvec2> profile;  // radius, z; between the poles
    for (int r = 1; r <= capRings; ++r) {
        const double a = 0.5 * std::numbers::pi * r / capRings;
        profile.push_back({radiusMm * std::sin(a), -radiusMm * std::cos(a)});
    }
    for (int r = 1; r < tubeRings; ++r)
        profile.push_back({radiusMm, lengthMm * r / tubeRings});
    for (int r = capRings; r >= 1; --r) {
        const double a = 0.5 * std::numbers::pi * r / capRings;
        profile.push_back({radiusMm * std::sin(a), lengthMm + radiusMm * std::cos(a)});
    }
    TriMesh mesh = openTube([](double) { return 1.0; }, 1.0, around, int(profile.size()));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const glm::dvec2 at = profile[v / std::size_t(around)];
        mesh.vertices[v] = {at.x * mesh.vertices[v].x, at.x * mesh.vertices[v].y, at.y};
    }
    const int low = int(mesh.vertices.size()), high = low + 1, last = low - around;
    mesh.vertices.push_back({0.0, 0.0, -radiusMm});
    mesh.vertices.push_back({0.0, 0.0, lengthMm + radiusMm});
    for (int i = 0; i < around; ++i) {
        const int next = (i + 1) % around;
        mesh.triangles.push_back({low, next, i});
        mesh.triangles.push_back({high, last + i, last + next});
    }
    return mesh;
}

/// Every vertex moved by up to `amountMm` in each direction.
inline TriMesh shaken(TriMesh mesh, double amountMm, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> move(-amountMm, amountMm);
    for (glm::dvec3& v : mesh.vertices)
        v += glm::dvec3(move(random), move(random), move(random));
    return mesh;
}

/// The map of openTube by angle and z, as it is conformal for a cylinder: x = angle / 2π,
/// y = z / (2π radius).
inline flatten::PeriodicMap cylinderMap(const TriMesh& tube, double radiusMm) {
    flatten::PeriodicMap map;
    const double circumferenceMm = 2.0 * std::numbers::pi * radiusMm;
    for (const glm::dvec3& v : tube.vertices) {
        const double turn = std::atan2(v.y, v.x) / (2.0 * std::numbers::pi);
        const double x = turn - std::floor(turn);
        map.flat.push_back({x < 1.0 ? x : 0.0, v.z / circumferenceMm});
        map.height = std::max(map.height, v.z / circumferenceMm);
    }
    for (const glm::ivec3& t : tube.triangles) {
        auto& turns = map.turns.emplace_back();
        for (int c = 0; c < 3; ++c) {
            const double step = map.flat[std::size_t(t[c])].x - map.flat[std::size_t(t.x)].x;
            turns[std::size_t(c)] = std::int8_t(-std::lround(step));
        }
    }
    return map;
}

inline double areaMm2(const TriMesh& mesh) {
    double sum = 0.0;
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
        sum += 0.5 * glm::length(glm::cross(mesh.vertices[std::size_t(t.y)] - a,
                                            mesh.vertices[std::size_t(t.z)] - a));
    }
    return sum;
}

/// The smallest angle of all triangles, degrees.
inline double leastAngleDegrees(const TriMesh& mesh) {
    double least = 180.0;
    for (const glm::ivec3& t : mesh.triangles) {
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 p = mesh.vertices[std::size_t(t[c])];
            const glm::dvec3 u = mesh.vertices[std::size_t(t[(c + 1) % 3])] - p,
                             v = mesh.vertices[std::size_t(t[(c + 2) % 3])] - p;
            least = std::min(least, std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)) *
                                        180.0 / std::numbers::pi);
        }
    }
    return least;
}

}  // namespace haustra::tests
