// Extra vertices on the faces between cells, where dual vertices alone would not do.
#pragma once

#include "contouring/boundary_cells.h"
#include "contouring/boundary_crossing.h"

#include <vector>

namespace haustra::contouring {

/// A vertex in the middle of each arc over an ambiguous face, and over a face of a cell with
/// several loops. Two cells that an ambiguous face parts may both join its two arcs in one loop;
/// straight from vertex to vertex both arcs would be one edge of four polygons, not manifold. And
/// from a cell with several loops the straight way may leave the hull of its loop's crossings.
class FaceVertices {
public:
    FaceVertices(const BoundaryCells& cells, const BoundaryCrossings& crossings, int threads);

    /// In voxel coordinates.
    const std::vector<glm::dvec3>& positions() const { return positions_; }

    /// The vertex on the low face across `axis` of a cell (its place among all), on the arc that
    /// goes round the face's corner `insideCorner` (corner number in that cell); −1: none.
    std::int32_t find(std::int32_t cell, CellCase inside, int axis, int insideCorner) const {
        const Entry& entry = entries_[std::size_t(cell)];
        const unsigned bit = 1u << (2 * axis + arcOf(inside, axis, insideCorner));
        if (!(entry.arcs & bit)) return -1;
        return entry.first + __builtin_popcount(entry.arcs & (bit - 1));
    }

private:
    struct Entry {
        std::int32_t first = 0;
        std::uint8_t arcs = 0;  ///< bit 2 · axis + arc
    };
    /// The one arc of a face is 0; of an ambiguous face's two, it is named by the inside corner.
    static int arcOf(CellCase inside, int axis, int insideCorner) {
        return ambiguousLowFace(inside, axis) ? insideCorner >> (axis == 2 ? 1 : 2) & 1 : 0;
    }
    static std::uint8_t arcsOf(const BoundaryCell& cell, glm::ivec3 place, const LayerPair& pair,
                               const BoundaryCells& cells);

    std::vector<Entry> entries_;  ///< by cell
    std::vector<glm::dvec3> positions_;
};

}  // namespace haustra::contouring
