#include "phantom/body_plan.h"

#include "phantom/implicit.h"

#include <array>
#include <cmath>

namespace haustra::phantom {
namespace {

/// Approximate signed distance to the rounded rectangle x²/a² + y²/b² − c x²y²/(a²b²) = 1, in the
/// manner of the ellipsoid's; with c > 0 only as far as about the corners.
double squircle(double x, double y, double a, double b, double c) {
    const double u = x / a, v = y / b;
    const double k0 = std::sqrt(std::max(0.0, u * u + v * v - c * u * u * v * v));
    const double k1 = std::hypot(u * (1.0 - c * v * v) / a, v * (1.0 - c * u * u) / b);
    return k0 < 0.1 || k1 < 1e-9 ? -0.9 * std::min(a, b) : k0 * (k0 - 1.0) / k1;
}

/// Piecewise linear, with smooth corners by smoothstep in between.
template <std::size_t N>
double through(const std::array<std::array<double, 2>, N>& knots, double z) {
    if (z <= knots[0][0]) return knots[0][1];
    for (std::size_t n = 1; n < N; ++n) {
        if (z < knots[n][0]) {
            const double t = smoothstep(knots[n - 1][0], knots[n][0], z);
            return knots[n - 1][1] + t * (knots[n][1] - knots[n - 1][1]);
        }
    }
    return knots[N - 1][1];
}

}  // namespace

double BodyPlan::skin(glm::dvec3 p) const {
    const double a =
        widthScale * through<5>({{{0, 168}, {80, 172}, {190, 158}, {260, 156}, {420, 160}}}, p.z);
    const bool supine = position != PatientPosition::prone;
    const double front = supine ? 106.0 : 98.0, back = supine ? 104.0 : 108.0;
    const double b = p.y < 0.0 ? front : back;
    return squircle(p.x, p.y, a, b, 0.35);
}

double BodyPlan::cavity(glm::dvec3 p) const {
    const double a = widthScale * through<4>({{{60, 56}, {110, 66}, {190, 134}, {420, 136}}}, p.z);
    const double front = position != PatientPosition::prone ? 84.0 : 78.0;
    const double b = p.y < 0.0 ? front : 76.0;
    return squircle(p.x, p.y, a, b, 0.3);
}

double BodyPlan::spineY(double z) {
    return through<6>({{{20, 58}, {55, 72}, {100, 80}, {165, 46}, {250, 40}, {420, 52}}}, z);
}

double BodyPlan::spineColumn(glm::dvec3 p) {
    const double y = spineY(p.z);
    const double half = through<5>({{{20, 10}, {60, 14}, {110, 40}, {165, 36}, {190, 25}}}, p.z);
    const double deep = through<4>({{{20, 5}, {110, 11}, {165, 18}, {420, 18}}}, p.z);
    const double behind = std::max(std::abs(p.x) - half, y - p.y);
    return std::min(squircle(p.x, p.y - y, half, deep, 0.0), behind);
}

double BodyPlan::iliacWing(glm::dvec3 p) {
    // A bent plate from the sacro-iliac joint to the front spine of the hip bone.
    const glm::dvec3 center{96, 20, 142};
    const glm::dvec3 along = glm::normalize(glm::dvec3(66, -112, 12));
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.25, 0.02, 1.0));
    const glm::dvec3 normal = glm::normalize(glm::cross(along, up));
    const glm::dvec3 across = glm::cross(normal, along);
    const glm::dvec3 q = glm::dvec3(std::abs(p.x), p.y, p.z) - center;
    const double u = glm::dot(q, along), v = glm::dot(q, across);
    const double bend = 0.0022 * (u * u + 0.5 * v * v) - 4.0;
    const double w =
        glm::dot(q, normal) - (glm::dot(normal, glm::dvec3(1, 0, 0)) > 0 ? -bend : bend);
    return ellipsoid({u, v, w}, glm::dvec3(0.0), {64, 57, 6.5});
}

double BodyPlan::diaphragmZ(double x, double y) {
    const double dx = std::abs(x) - 70.0, dy = y - 4.0;
    return (x < 0 ? 402.0 : 394.0) - (dx * dx + dy * dy) / 85.0;
}

}  // namespace haustra::phantom
