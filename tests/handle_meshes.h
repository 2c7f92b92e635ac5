// Closed meshes with handles of known girth.
#pragma once

#include "core/tri_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace haustra::tests {

/// A torus round the z axis: `around` × `along` quadrilaterals, each cut in two.
inline TriMesh torusMesh(double majorMm, double minorMm, int around, int along) {
    TriMesh mesh;
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < along; ++j) {
            const double u = 2.0 * std::numbers::pi * i / around,
                         v = 2.0 * std::numbers::pi * j / along;
            const double ring = majorMm + minorMm * std::cos(v);
            mesh.vertices.push_back(
                {ring * std::cos(u), ring * std::sin(u), minorMm * std::sin(v)});
            const auto at = [&](int a, int b) { return (a % around) * along + b % along; };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

/// A sphere made of six grids of `side`² squares, to which arched tubes are joined.
class HandledSphere {
public:
    HandledSphere(double radiusMm, int side) : radiusMm_(radiusMm), side_(side) {
        for (int face = 0; face < 6; ++face) {
            for (int i = 0; i < side; ++i) {
                for (int j = 0; j < side; ++j)
                    squares_[{face, i, j}] = {vertex(face, i, j), vertex(face, i + 1, j),
                                              vertex(face, i + 1, j + 1), vertex(face, i, j + 1)};
            }
        }
    }

    /// Joins the patches of `width`² squares at (i, j) and (i + apart, j) of a face by a tube of
    /// `radiusMm`: outside as a bridge, or inside as a tunnel. Its cross-sections are regular
    /// polygons of 4·width corners. Returns their girth.
    double addTube(int face, int i, int j, int apart, int width, double radiusMm, bool outside) {
        const std::vector<int> from = outline(face, i, j, width),
                               to = outline(face, i + apart, j, width);
        for (int a = 0; a < width; ++a) {
            for (int b = 0; b < width; ++b) {
                squares_.erase({face, i + a, j + b});
                squares_.erase({face, i + apart + a, j + b});
            }
        }
        const glm::dvec3 start = centerOf(from), end = centerOf(to);
        const double span = 0.5 * glm::distance(start, end);
        const glm::dvec3 middle = 0.5 * (start + end), across = glm::normalize(end - start);
        const glm::dvec3 up = (outside ? 1.0 : -1.0) * glm::normalize(middle);
        const glm::dvec3 aside = glm::cross(across, up);
        const auto byAngle = [&](std::vector<int> rim, const glm::dvec3& center,
                                 const glm::dvec3& axis) {
            std::sort(rim.begin(), rim.end(), [&](int p, int q) {
                const auto angle = [&](int v) {
                    const glm::dvec3 d = mesh_.vertices[v] - center;
                    return std::atan2(glm::dot(d, aside), glm::dot(d, axis));
                };
                return angle(p) < angle(q);
            });
            return rim;
        };
        const int corners = 4 * width;
        std::vector<std::vector<int>> rings{byAngle(from, start, -across)};
        const int steps = std::max(4, int(std::numbers::pi * span / (radiusMm * 0.5)));
        for (int s = 1; s < steps; ++s) {
            const double turn = std::numbers::pi * s / steps;
            const glm::dvec3 radial = -std::cos(turn) * across + std::sin(turn) * up;
            std::vector<int>& ring = rings.emplace_back();
            for (int c = 0; c < corners; ++c) {
                const double angle =
                    2.0 * std::numbers::pi * (c + 0.5) / corners - std::numbers::pi;
                ring.push_back(int(mesh_.vertices.size()));
                mesh_.vertices.push_back(middle + span * radial +
                                         radiusMm *
                                             (std::cos(angle) * radial + std::sin(angle) * aside));
            }
        }
        rings.push_back(byAngle(to, end, across));
        // The tube's triangles must run along the hole's edges as the patch did.
        const auto first = std::find(from.begin(), from.end(), rings[0][0]);
        const int next = first + 1 == from.end() ? from.front() : *(first + 1);
        const bool forward = next == rings[0][1];
        for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
            for (int c = 0; c < corners; ++c) {
                int p = rings[r][c], q = rings[r][(c + 1) % corners];
                int pp = rings[r + 1][c], qq = rings[r + 1][(c + 1) % corners];
                if (!forward) std::swap(p, q), std::swap(pp, qq);
                tube_.push_back({p, q, qq});
                tube_.push_back({p, qq, pp});
            }
        }
        return 2.0 * corners * radiusMm * std::sin(std::numbers::pi / corners);
    }

    /// The vertices inside the patches stay, unused by any triangle.
    TriMesh mesh() const {
        TriMesh made{mesh_.vertices, tube_};
        for (const auto& [place, q] : squares_) {
            made.triangles.push_back({q[0], q[1], q[2]});
            made.triangles.push_back({q[0], q[2], q[3]});
        }
        return made;
    }

private:
    int vertex(int face, int i, int j) {
        const std::array<int, 2> grid{2 * i - side_, 2 * j - side_};
        const int axis = face / 2, sign = face % 2 ? 1 : -1;
        std::array<int, 3> place{};
        place[axis] = sign * side_;
        place[(axis + 1) % 3] = sign * grid[0];
        place[(axis + 2) % 3] = grid[1];
        const auto [found, isNew] = numbers_.try_emplace(place, int(mesh_.vertices.size()));
        if (isNew) {
            const auto bent = [&](int x) { return std::tan(0.25 * std::numbers::pi * x / side_); };
            mesh_.vertices.push_back(
                radiusMm_ *
                glm::normalize(glm::dvec3(bent(place[0]), bent(place[1]), bent(place[2]))));
        }
        return found->second;
    }

    std::vector<int> outline(int face, int i, int j, int width) {
        std::vector<int> rim;
        for (int k = 0; k < width; ++k)
            rim.push_back(vertex(face, i + k, j));
        for (int k = 0; k < width; ++k)
            rim.push_back(vertex(face, i + width, j + k));
        for (int k = 0; k < width; ++k)
            rim.push_back(vertex(face, i + width - k, j + width));
        for (int k = 0; k < width; ++k)
            rim.push_back(vertex(face, i, j + width - k));
        return rim;
    }

    glm::dvec3 centerOf(const std::vector<int>& rim) const {
        glm::dvec3 center(0.0);
        for (const int v : rim)
            center += mesh_.vertices[v] / double(rim.size());
        return center;
    }

    double radiusMm_;
    int side_;
    TriMesh mesh_;
    std::vector<glm::ivec3> tube_;
    std::map<std::array<int, 3>, int> numbers_;
    std::map<std::array<int, 3>, std::array<int, 4>> squares_;
};

}  // namespace haustra::tests
