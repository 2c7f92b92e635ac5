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

/// Three parallelograms of the sides `right` and `up` in the shape of an L, opposite sides glued:
/// of genus two, flat but for one vertex with three turns around it. `form` is dz. Each is cut in
/// n² cells of two triangles.
struct TranslationSurface {
    mesh::HalfedgeMesh halfedges;
    std::vector<std::complex<double>> form;
};
inline TranslationSurface glueL(std::complex<double> right, std::complex<double> up, int n) {
    // Tile 1 is to the right of tile 0, tile 2 above it.
    const int rightOf[] = {1, 0, 2}, above[] = {2, 1, 0};
    const auto cell = [&](int tile, int i, int j) { return (tile * n + j) * n + i; };
    const int count = 3 * n * n * 6;
    std::vector<int> opposite(std::size_t(count), -1);
    const auto glue = [&](int g, int h) {
        opposite[std::size_t(g)] = h;
        opposite[std::size_t(h)] = g;
    };
    TranslationSurface made;
    std::vector<double> lengthMm;
    for (int tile = 0; tile < 3; ++tile) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                // Half-edges of the cell: bottom, right, diagonal; diagonal, top, left.
                const int h = 6 * cell(tile, i, j);
                glue(h + 2, h + 3);
                glue(h + 1, 5 + 6 * (i + 1 < n ? cell(tile, i + 1, j) : cell(rightOf[tile], 0, j)));
                glue(h + 4, 6 * (j + 1 < n ? cell(tile, i, j + 1) : cell(above[tile], i, 0)));
                for (const std::complex<double> side :
                     {right, up, -right - up, right + up, -right, -up})
                    made.form.push_back(side / double(n));
            }
        }
    }
    // A vertex is what turning left around it meets.
    std::vector<glm::ivec3> triangles(std::size_t(count / 3), glm::ivec3(-1));
    int vertices = 0;
    for (int start = 0; start < count; ++start) {
        lengthMm.push_back(std::abs(made.form[std::size_t(start)]));
        if (triangles[std::size_t(start / 3)][start % 3] >= 0) continue;
        int h = start;
        do {
            triangles[std::size_t(h / 3)][h % 3] = vertices;
            h = opposite[std::size_t(mesh::HalfedgeMesh::previous(h))];
        } while (h != start);
        ++vertices;
    }
    // Opposite sides' lengths are equal bit for bit: the sum's sign alone differs.
    made.halfedges = *mesh::HalfedgeMesh::glued(vertices, triangles, opposite, lengthMm);
    return made;
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
