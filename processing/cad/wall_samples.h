// The colon's wall as evenly spaced samples.
#pragma once

#include "core/tri_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::cad {

/// Detection looks at the wall itself, not at the strip: a conformal map shrinks what stands on a
/// stalk to a few pixels, while here neighbours are nowhere farther apart than asked.
struct WallSamples {
    /// The surface, its triangles divided until no edge is longer than asked; no place of the
    /// wall has moved. Samples near to each other mostly have near numbers.
    TriMesh mesh;
    std::vector<std::int32_t> sourceTriangle;  ///< per triangle, of the surface
    std::vector<float> areaMm2;                ///< per vertex: a third of its triangles'
    /// The neighbours of all vertices in one list: those of vertex v are at begin[v] and on, before
    /// begin[v + 1].
    std::vector<std::uint32_t> begin, neighbours;
    /// The triangles at all vertices in one list, by their numbers in mesh.triangles: those of
    /// vertex v are at beginTriangles[v] and on, before beginTriangles[v + 1].
    std::vector<std::uint32_t> beginTriangles, triangles;

    /// Vertices next to a vertex, ascending.
    std::span<const std::uint32_t> around(std::uint32_t v) const {
        return {neighbours.data() + begin[v], neighbours.data() + begin[v + 1]};
    }
    /// Triangles at a vertex, ascending.
    std::span<const std::uint32_t> trianglesAround(std::uint32_t v) const {
        return {triangles.data() + beginTriangles[v], triangles.data() + beginTriangles[v + 1]};
    }
};

/// Divides the surface. Each edge that is too long is cut in its middle, or beside it where it
/// takes an odd number of pieces, in all triangles that have it at once, until none is left: the
/// mesh stays as closed as it was. Edges in `mostSpacingMm` > 0; indices in range. O(n log n) in
/// the number of samples.
WallSamples sampleWall(const TriMesh& surface, double mostSpacingMm);

/// The two halves of that, as what is measured at a place needs `mesh.vertices` alone: first the
/// mesh and its triangles' sources; then areas and what is around each sample, which before must
/// not be asked for. Of any mesh whose indices are in range.
WallSamples dividedWall(const TriMesh& surface, double mostSpacingMm);
void joinSamples(WallSamples& samples);

}  // namespace haustra::cad
