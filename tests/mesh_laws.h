// What holds of a closed surface, told from its triangles alone.
#pragma once

#include "core/tri_mesh.h"

#include <cstddef>
#include <map>
#include <vector>

namespace haustra::tests {

/// Whether the triangles around each used vertex form one cycle: no vertex where two sheets or two
/// solids meet in a point.
inline bool everyVertexHasOneFan(const TriMesh& mesh) {
    std::vector<std::map<int, int>> next(mesh.vertices.size());  // around a vertex: from → to
    for (const glm::ivec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            auto& around = next[std::size_t(t[corner])];
            if (!around.emplace(t[(corner + 1) % 3], t[(corner + 2) % 3]).second) return false;
        }
    }
    for (const auto& around : next) {
        if (around.empty()) continue;
        std::size_t steps = 0;
        int at = around.begin()->first;
        do {
            const auto step = around.find(at);
            if (step == around.end()) return false;
            at = step->second;
        } while (++steps < around.size() && at != around.begin()->first);
        if (steps != around.size() || at != around.begin()->first) return false;
    }
    return true;
}

/// Positive where the triangles are counter-clockwise seen from outside.
inline double signedVolumeMm3(const TriMesh& mesh) {
    double sum = 0.0;
    for (const glm::ivec3& t : mesh.triangles)
        sum +=
            glm::dot(mesh.vertices[std::size_t(t.x)],
                     glm::cross(mesh.vertices[std::size_t(t.y)], mesh.vertices[std::size_t(t.z)]));
    return sum / 6.0;
}

}  // namespace haustra::tests
