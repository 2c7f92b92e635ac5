#include "cad/wall_shape.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::cad {

float WallShape::shapeIndex() const {
    return 0.5f + float(std::numbers::inv_pi) * std::atan2(k1 + k2, k1 - k2);
}

float WallShape::curvedness() const {
    return std::sqrt(0.5f * (k1 * k1 + k2 * k2));
}

WallShape shapeOf(const Derivatives& scan) {
    WallShape shape;
    const double steep = glm::length(scan.gradient);
    shape.gradient = float(steep), shape.hu = float(scan.hu);
    if (steep < 1e-6) return shape;
    const double perGradient = 1.0 / steep;
    const glm::dvec3 n = perGradient * scan.gradient;
    shape.intoWall = glm::vec3(n);
    // Two directions along the wall; the shape operator there is the Hessian over the gradient.
    const glm::dvec3 aside = std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(n, aside)), v = glm::cross(n, u);
    const glm::dvec3 hu = scan.hessian * u, hv = scan.hessian * v;
    const double a = -perGradient * glm::dot(u, hu), b = -perGradient * glm::dot(u, hv),
                 c = -perGradient * glm::dot(v, hv);
    const double mean = 0.5 * (a + c), spread = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
    shape.k1 = float(mean + spread), shape.k2 = float(mean - spread);
    return shape;
}

std::vector<WallShape> shapesOf(const WallSamples& samples, const SmoothScan& scan, int threads) {
    std::vector<WallShape> shapes(samples.mesh.vertices.size());
    parallelFor(shapes.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            shapes[v] = shapeOf(scan.derivatives(samples.mesh.vertices[v]));
    });
    return shapes;
}

}  // namespace haustra::cad
