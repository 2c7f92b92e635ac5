// Flat maps of surfaces that a formula gives: what is measured on them has a known answer.
#pragma once

#include "core/flat_map.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace haustra::tests {

/// The flat map of the surface position(x, y), of period 1 in x: an irregular triangulation of
/// [0, 1] × [0, height], cut along x = 0. Every triangle is its own source; cameras stand on the
/// axis, one per row, at arcs of `y`.
inline FlatMap flatMapOf(const std::function<glm::dvec3(double x, double y)>& position,
                         double height, int columns, int rows, unsigned seed = 1) {
    std::mt19937 random(seed);
    const auto jitter = [&] { return 0.6 * (double(random()) / 4294967296.0 - 0.5); };
    FlatMap map;
    map.height = height;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const bool rim = j == 0 || j == rows, seam = i == 0 || i == columns;
            const glm::dvec2 place((i + (seam ? 0.0 : jitter())) / columns,
                                   height * (j + (rim || seam ? 0.0 : jitter())) / rows);
            map.flat.push_back(place);
            map.surface.vertices.push_back(position(i == columns ? 0.0 : place.x, place.y));
            map.camera.push_back(j);
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
            if (random() % 2) {
                map.surface.triangles.insert(map.surface.triangles.end(), {{a, b, d}, {a, d, c}});
            } else {
                map.surface.triangles.insert(map.surface.triangles.end(), {{a, b, c}, {b, d, c}});
            }
        }
    }
    for (std::size_t t = 0; t < map.surface.triangles.size(); ++t)
        map.sourceTriangle.push_back(int(t));
    for (int j = 0; j <= rows; ++j)
        map.cameras.push_back({{0.0, 0.0, height * j / rows}, height * j / rows});
    return map;
}

/// A round cylinder along z, unrolled: millimetres are `circumferenceMm` times flat units.
inline std::function<glm::dvec3(double, double)> cylinder(double circumferenceMm) {
    return [=](double x, double y) {
        const double angle = 2.0 * std::numbers::pi * x;
        const double radius = circumferenceMm / (2.0 * std::numbers::pi);
        return glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), circumferenceMm * y);
    };
}

/// A cylinder along z with half a ball on its wall, bulging inwards: every place of the ball's foot
/// is `ballMm` from its middle.
struct HalfBall {
    double circumferenceMm = 150.0, ballMm = 5.0;
    glm::dvec2 middle{0.98, 0.5};  ///< in circumferences

    double radiusMm() const { return circumferenceMm / (2.0 * std::numbers::pi); }
    /// How far inward of the cylinder's tangent plane the foot is that lies in this direction.
    double riseMm(double azimuth) const {
        double rise = 0.0;
        for (int n = 0; n < 50; ++n) {
            const double aside = std::sqrt(ballMm * ballMm - rise * rise) * std::cos(azimuth);
            rise = radiusMm() - std::sqrt(radiusMm() * radiusMm() - aside * aside);
        }
        return rise;
    }
    /// Where on the unrolled cylinder that foot is.
    glm::dvec2 foot(double azimuth) const {
        const double rise = riseMm(azimuth), reach = std::sqrt(ballMm * ballMm - rise * rise);
        const double turn = std::asin(reach * std::cos(azimuth) / radiusMm());
        return middle + glm::dvec2(turn / (2.0 * std::numbers::pi),
                                   reach * std::sin(azimuth) / circumferenceMm);
    }
    /// Of the ball's part of the surface.
    double areaMm2() const {
        constexpr int parts = 360;
        double sum = 0.0;
        for (int n = 0; n < parts; ++n) {
            const double azimuth = 2.0 * std::numbers::pi * n / parts;
            sum += 2.0 * std::numbers::pi / parts * ballMm * (ballMm - riseMm(azimuth));
        }
        return sum;
    }
    /// The surface over the unrolled cylinder.
    glm::dvec3 position(double x, double y) const {
        const auto wall = cylinder(circumferenceMm);
        const glm::dvec3 center = wall(middle.x, middle.y), away = wall(x, y) - center;
        const double distance = glm::length(away);
        if (distance >= ballMm) return wall(x, y);
        const glm::dvec3 inward = -glm::normalize(glm::dvec3(center.x, center.y, 0.0));
        const glm::dvec3 around(inward.y, -inward.x, 0.0), along(0.0, 0.0, 1.0);
        const double azimuth = std::atan2(away.z, glm::dot(away, around));
        const double polar = std::acos(riseMm(azimuth) / ballMm) * distance / ballMm;
        const glm::dvec3 side = std::cos(azimuth) * around + std::sin(azimuth) * along;
        return center + ballMm * (std::cos(polar) * inward + std::sin(polar) * side);
    }
};

}  // namespace haustra::tests
