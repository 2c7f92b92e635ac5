// Tubes of known shape, two boundary loops each.
#pragma once

#include "core/tri_mesh.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace haustra::tests {

/// `place(a, s)` is the point at turn a in [0, 1) and s in [0, 1] along. A grid of `around` ×
/// `along` quadrilaterals cut in two, triangles counter-clockwise seen from the side that a × s
/// points to. Rings are numbered from s = 0.
inline TriMesh tubeMesh(int around, int along,
                        const std::function<glm::dvec3(double, double)>& place) {
    TriMesh mesh;
    for (int j = 0; j <= along; ++j) {
        for (int i = 0; i < around; ++i)
            mesh.vertices.push_back(place(double(i) / around, double(j) / along));
    }
    const auto at = [&](int i, int j) { return j * around + i % around; };
    for (int j = 0; j < along; ++j) {
        for (int i = 0; i < around; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

/// Round the z axis with radius(s) at z = height · s.
inline TriMesh revolvedMesh(int around, int along, double height,
                            const std::function<double(double)>& radius) {
    return tubeMesh(around, along, [&](double a, double s) {
        const double angle = 2.0 * std::numbers::pi * a;
        return glm::dvec3(radius(s) * std::cos(angle), radius(s) * std::sin(angle), height * s);
    });
}

}  // namespace haustra::tests
