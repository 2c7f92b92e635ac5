// Surfaces of genus one whose period ratio is known.
#pragma once

#include "core/tri_mesh.h"
#include "mesh/halfedge_mesh.h"

#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace haustra::tests {

/// The triangles of a periodic grid of `m` × `n` squares, numbered along i first.
inline std::vector<glm::ivec3> periodicGrid(int m, int n) {
    std::vector<glm::ivec3> triangles;
    const auto at = [&](int i, int j) { return (j % n) * m + i % m; };
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < m; ++i) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return triangles;
}

/// The plane modulo the lattice of 1 and τ: no embedding, lengths alone. m, n ≥ 3.
inline mesh::HalfedgeMesh flatTorus(std::complex<double> tau, int m, int n) {
    const std::vector<glm::ivec3> triangles = periodicGrid(m, n);
    const std::complex<double> right = 1.0 / m, up = tau / double(n);
    std::map<std::pair<int, int>, int> halfedges;
    std::vector<double> lengthMm;
    for (int h = 0; h < int(triangles.size()) * 3; ++h) {
        const glm::ivec3& t = triangles[std::size_t(h / 3)];
        halfedges[{t[h % 3], t[(h + 1) % 3]}] = h;
        const double sides[2][3] = {{std::abs(right), std::abs(up), std::abs(right + up)},
                                    {std::abs(right + up), std::abs(right), std::abs(up)}};
        lengthMm.push_back(sides[h / 3 % 2][h % 3]);
    }
    std::vector<int> opposite;
    for (int h = 0; h < int(triangles.size()) * 3; ++h) {
        const glm::ivec3& t = triangles[std::size_t(h / 3)];
        opposite.push_back(halfedges.at({t[(h + 1) % 3], t[h % 3]}));
    }
    return *mesh::HalfedgeMesh::glued(m * n, triangles, opposite, lengthMm);
}

/// A torus in space that is conformally the plane modulo 1 and `tau`, up to the lattice's choice.
struct KnownTorus {
    TriMesh mesh;
    std::complex<double> tau;
};

/// The circles over a closed curve on the unit sphere in Hopf's fibration, projected from the
/// 3-sphere to space, which keeps angles (Pinkall 1985): the plane modulo 2π and A/2 + iL/2, where
/// the curve has the length L and A lies inside. The curve is at polar(φ) for the azimuth φ.
inline KnownTorus hopfTorus(int around, int along, const std::function<double(double)>& polar) {
    KnownTorus torus;
    const double turn = 2.0 * std::numbers::pi;
    for (int j = 0; j < along; ++j) {
        const double azimuth = turn * j / along, half = 0.5 * polar(azimuth);
        for (int i = 0; i < around; ++i) {
            const double fibre = turn * i / around;
            const auto a = std::polar(std::cos(half), fibre),
                       b = std::polar(std::sin(half), fibre + azimuth);
            torus.mesh.vertices.push_back(glm::dvec3(a.real(), a.imag(), b.real()) /
                                          (1.0 - b.imag()));
        }
    }
    torus.mesh.triangles = periodicGrid(around, along);
    // The trapezoidal rule on a periodic function is exact to rounding.
    const int steps = 20000;
    double area = 0.0, length = 0.0;
    for (int k = 0; k < steps; ++k) {
        const double azimuth = turn * k / steps, d = 1e-4;
        const double slope = (8.0 * (polar(azimuth + d) - polar(azimuth - d)) -
                              (polar(azimuth + 2.0 * d) - polar(azimuth - 2.0 * d))) /
                             (12.0 * d);
        area += (1.0 - std::cos(polar(azimuth))) * turn / steps;
        length += std::hypot(slope, std::sin(polar(azimuth))) * turn / steps;
    }
    torus.tau = std::complex<double>(0.5 * area, 0.5 * length) / turn;
    return torus;
}

/// The representative in the fundamental region |Re τ| ≤ ½, |τ| ≥ 1.
inline std::complex<double> reducedRatio(std::complex<double> tau) {
    for (;;) {
        tau -= std::round(tau.real());
        if (std::abs(tau) >= 1.0 - 1e-12) return tau;
        tau = -1.0 / tau;
    }
}

}  // namespace haustra::tests
