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
    // Sum and product of the level surface's principal curvatures, by its gradient and Hessian
    // (Goldman, Computer Aided Geometric Design 2005; 22: 632); the cofactors' rows are products
    // of the Hessian's.
    const glm::dmat3& h = scan.hessian;
    const double mean = -0.5 * perGradient * (h[0][0] + h[1][1] + h[2][2] - glm::dot(n, h * n));
    const glm::dvec3 cofactors(glm::dot(n, glm::cross(h[1], h[2])),
                               glm::dot(n, glm::cross(h[2], h[0])),
                               glm::dot(n, glm::cross(h[0], h[1])));
    const double gaussian = perGradient * perGradient * glm::dot(n, cofactors);
    const double spread = std::sqrt(std::max(0.0, mean * mean - gaussian));
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
