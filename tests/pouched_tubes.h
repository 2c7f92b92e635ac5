// Tubes with blind fingers, whose conformal maps crowd what lies deep in them on no room at all.
#pragma once

#include "core/tri_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

namespace haustra::tests {

/// A blind finger on a tube's wall, outwards, with a half ball at its end.
struct Finger {
    int column = 0, row = 0;  ///< the quadrilateral where its foot begins
    int width = 4;            ///< of its foot, in quadrilaterals each way
    double radiusMm = 5.0, lengthMm = 20.0;
};

struct FingeredTube {
    TriMesh mesh;
    std::vector<char> inFinger;  ///< per triangle
};

/// A round cylinder along z of `around` × `along` quadrilaterals of about `stepMm`, cut in two,
/// with the fingers, whose feet do not touch. Vertices but for the rims' are shaken by `shake` of a
/// step. Triangles are counter-clockwise seen from outside.
inline FingeredTube fingeredTube(int around, int along, double stepMm,
                                 const std::vector<Finger>& fingers, double shake = 0.0,
                                 unsigned seed = 1) {
    FingeredTube made;
    TriMesh& mesh = made.mesh;
    const double radiusMm = stepMm * around / (2.0 * std::numbers::pi);
    const auto outward = [&](double column) {
        const double angle = 2.0 * std::numbers::pi * column / around;
        return glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    };
    std::vector<std::vector<int>> number(std::size_t(along) + 1,
                                         std::vector<int>(std::size_t(around), -1));
    const auto inside = [&](const Finger& f, int i, int j) {  // vertices strictly within a foot
        const int across = ((i - f.column) % around + around) % around;
        return across > 0 && across < f.width && j > f.row && j < f.row + f.width;
    };
    for (int j = 0; j <= along; ++j) {
        for (int i = 0; i < around; ++i) {
            if (std::ranges::any_of(fingers, [&](const Finger& f) { return inside(f, i, j); }))
                continue;
            number[std::size_t(j)][std::size_t(i)] = int(mesh.vertices.size());
            mesh.vertices.push_back(radiusMm * outward(i) + glm::dvec3(0.0, 0.0, stepMm * j));
        }
    }
    const auto at = [&](int i, int j) {
        return number[std::size_t(j)][std::size_t(((i % around) + around) % around)];
    };
    const auto add = [&](int a, int b, int c, bool finger) {
        mesh.triangles.push_back({a, b, c});
        made.inFinger.push_back(finger);
    };
    for (int j = 0; j < along; ++j) {
        for (int i = 0; i < around; ++i) {
            const bool foot = std::ranges::any_of(fingers, [&](const Finger& f) {
                const int across = ((i - f.column) % around + around) % around;
                return across < f.width && j >= f.row && j < f.row + f.width;
            });
            if (foot) continue;
            add(at(i, j), at(i + 1, j), at(i + 1, j + 1), false);
            add(at(i, j), at(i + 1, j + 1), at(i, j + 1), false);
        }
    }
    for (const Finger& f : fingers) {
        std::vector<int> ring;  // counter-clockwise from outside
        for (int n = 0; n < f.width; ++n)
            ring.push_back(at(f.column + n, f.row));
        for (int n = 0; n < f.width; ++n)
            ring.push_back(at(f.column + f.width, f.row + n));
        for (int n = 0; n < f.width; ++n)
            ring.push_back(at(f.column + f.width - n, f.row + f.width));
        for (int n = 0; n < f.width; ++n)
            ring.push_back(at(f.column, f.row + f.width - n));
        const glm::dvec3 out = outward(f.column + 0.5 * f.width), side(-out.y, out.x, 0.0),
                         up(0.0, 0.0, 1.0);
        const glm::dvec3 foot = radiusMm * out + stepMm * (f.row + 0.5 * f.width) * up;
        const int count = int(ring.size());
        const double step = 2.0 * std::numbers::pi * f.radiusMm / count;
        const int straight = std::max(1, int(std::lround(f.lengthMm / step)));
        const int round = std::max(2, int(std::lround(0.5 * std::numbers::pi * f.radiusMm / step)));
        for (int r = 1; r < straight + round; ++r) {
            const double bend =
                r <= straight ? 0.0 : 0.5 * std::numbers::pi * (r - straight) / round;
            const double high =
                std::min(r, straight) * f.lengthMm / straight + f.radiusMm * std::sin(bend);
            std::vector<int> next;
            for (int n = 0; n < count; ++n) {
                const double angle =
                    2.0 * std::numbers::pi * (n - 0.5 * f.width) / count - 0.5 * std::numbers::pi;
                next.push_back(int(mesh.vertices.size()));
                mesh.vertices.push_back(foot + high * out +
                                        f.radiusMm * std::cos(bend) *
                                            (std::cos(angle) * side + std::sin(angle) * up));
            }
            for (int n = 0; n < count; ++n) {
                const auto a = std::size_t(n), b = std::size_t((n + 1) % count);
                add(ring[a], ring[b], next[b], true);
                add(ring[a], next[b], next[a], true);
            }
            ring = std::move(next);
        }
        const int tip = int(mesh.vertices.size());
        mesh.vertices.push_back(foot + (f.lengthMm + f.radiusMm) * out);
        for (int n = 0; n < count; ++n)
            add(ring[std::size_t(n)], ring[std::size_t((n + 1) % count)], tip, true);
    }
    std::mt19937 random(seed);
    for (glm::dvec3& v : mesh.vertices) {
        const bool rim = v.z == 0.0 || v.z == stepMm * along;
        for (int axis = 0; axis < 3; ++axis) {
            const double move = 2.0 * double(random()) / 4294967296.0 - 1.0;
            if (!rim) v[axis] += shake * stepMm * move;
        }
    }
    return made;
}

}  // namespace haustra::tests
