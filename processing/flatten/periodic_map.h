// A tube's map to the periodic strip, before it is cut open.
#pragma once

#include "core/tri_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace haustra::flatten {

/// A tube (two boundary loops, genus 0) over the strip [0, 1) × [0, height], x periodic. The
/// flat place of corner c of triangle t is flat[vertex] + (turns[t][c], 0): with its turns, a
/// triangle lies in one piece. Boundary loop 0 (the rectum's) is at y = 0, loop 1 at y = height.
/// Triangles keep their orientation: a flip is a triangle of negative area.
struct PeriodicMap {
    std::vector<glm::dvec2> flat;                   ///< per vertex; x in [0, 1)
    std::vector<std::array<std::int8_t, 3>> turns;  ///< per triangle
    double height = 0.0;

    glm::dvec2 corner(const TriMesh& tube, std::size_t triangle, int corner) const {
        const glm::dvec2 at = flat[std::size_t(tube.triangles[triangle][corner])];
        return {at.x + turns[triangle][std::size_t(corner)], at.y};
    }
};

/// x becomes x − shift modulo 1; turns follow.
void rotate(PeriodicMap& map, const TriMesh& tube, double shift);

}  // namespace haustra::flatten
