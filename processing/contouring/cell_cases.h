// How the lumen's surface passes through a cell: the 256 cases of dual contouring with several
// components to a cell (Zhang, Hong, Kaufman, IEEE Visualization 2004; dissertation [139]).
#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace haustra::contouring {

/// A cell is the cube between eight voxel centres; corner c is at (c & 1, c >> 1 & 1, c >> 2 & 1).
/// Its case has bit c set where corner c is inside. Edge 4a + u + 2v runs along axis a; u and v are
/// its places along the two other axes, in their order.
using CellCase = std::uint8_t;
inline constexpr int cellEdges = 12;

/// The edge along `axis` whose lower corner is `corner`.
constexpr int cellEdge(int axis, int corner) {
    const int u = axis == 0 ? corner >> 1 & 1 : corner & 1;
    const int v = axis == 2 ? corner >> 1 & 1 : corner >> 2 & 1;
    return 4 * axis + u + 2 * v;
}
constexpr int lowerCorner(int edge) {
    const int axis = edge / 4, u = edge & 1, v = edge >> 1 & 1;
    return axis == 0 ? 2 * u + 4 * v : axis == 1 ? u + 4 * v : u + 2 * v;
}
constexpr int upperCorner(int edge) {
    return lowerCorner(edge) | 1 << edge / 4;
}

inline glm::ivec3 cornerOffset(int corner) {
    return {corner & 1, corner >> 1 & 1, corner >> 2 & 1};
}

/// The surface in a cell is a disc for each closed loop of arcs over the cell's faces. An arc joins
/// two crossed edges of a face; on an ambiguous face (inside at two opposite corners alone) each
/// arc goes round one inside corner, so that inside is 6-connected and outside 18-connected.
struct CellLoops {
    std::int8_t count = 0;                          ///< 0…4
    std::array<std::int8_t, cellEdges> loopOfEdge;  ///< −1 where the edge is not crossed
};

/// By case.
const CellLoops& cellLoops(CellCase inside);

/// Whether the low face across `axis` is inside at two opposite corners alone.
constexpr bool ambiguousLowFace(CellCase inside, int axis) {
    const int u = axis == 0 ? 2 : 1, v = axis == 2 ? 2 : 4;  // corner bits along the face
    const bool o = inside & 1, a = inside >> u & 1, b = inside >> v & 1, c = inside >> (u + v) & 1;
    return o == c && a == b && o != a;
}

}  // namespace haustra::contouring
