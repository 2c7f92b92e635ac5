#include "contouring/face_vertices.h"

#include "core/parallel.h"

#include <utility>

namespace haustra::contouring {
namespace {

bool hasArc(CellCase inside, int axis) {
    // Corners of the low face: those without the axis's bit.
    const unsigned face = axis == 0 ? 0x55 : axis == 1 ? 0x33 : 0x0f;
    const unsigned there = inside & face;
    return there != 0 && there != face;
}

}  // namespace

std::uint8_t FaceVertices::arcsOf(const BoundaryCell& cell, glm::ivec3 place, const LayerPair& pair,
                                  const BoundaryCells& cells) {
    const bool severalHere = cellLoops(cell.inside).count > 1;
    std::uint8_t arcs = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (ambiguousLowFace(cell.inside, axis)) {
            arcs |= std::uint8_t(3u << 2 * axis);
        } else if (hasArc(cell.inside, axis)) {
            glm::ivec2 beside(place);
            if (axis < 2) --beside[axis];
            const std::int32_t other = pair.find(beside.x, beside.y, axis == 2);
            if (severalHere || cellLoops(cells.cells()[std::size_t(other)].inside).count > 1)
                arcs |= std::uint8_t(1u << 2 * axis);
        }
    }
    return arcs;
}

FaceVertices::FaceVertices(const BoundaryCells& cells, const BoundaryCrossings& crossings,
                           int threads)
    : entries_(cells.cells().size()) {
    const std::size_t layers = std::size_t(cells.layers());
    parallelFor(layers, 16, threads, [&](std::size_t begin, std::size_t end) {
        LayerPair pair(cells);
        for (std::size_t n = begin; n < end; ++n) {
            pair.moveTo(int(n));
            std::size_t index = cells.layerBegin(int(n));
            for (const BoundaryCell& cell : cells.layer(int(n))) {
                const glm::ivec3 place(cell.i, cell.j, BoundaryCells::kOfLayer(int(n)));
                entries_[index++].arcs = arcsOf(cell, place, pair, cells);
            }
        }
    });
    std::int32_t count = 0;
    for (Entry& entry : entries_) {
        entry.first = count;
        count += __builtin_popcount(entry.arcs);
    }
    positions_.resize(std::size_t(count));
    for (std::size_t n = 0; n < layers; ++n) {
        std::size_t index = cells.layerBegin(int(n));
        for (const BoundaryCell& cell : cells.layer(int(n))) {
            const Entry& entry = entries_[index];
            const glm::ivec3 origin(cell.i, cell.j, BoundaryCells::kOfLayer(int(n)));
            for (int edge = 0; edge < cellEdges && entry.arcs != 0; ++edge) {
                int in = lowerCorner(edge), out = upperCorner(edge);
                if (!((cell.inside >> in ^ cell.inside >> out) & 1)) continue;
                if (!(cell.inside >> in & 1)) std::swap(in, out);
                for (int axis = 0; axis < 3; ++axis) {
                    if (axis == edge / 4 || (in >> axis & 1) != 0) continue;
                    const std::int32_t vertex = find(std::int32_t(index), cell.inside, axis, in);
                    if (vertex < 0) continue;
                    positions_[std::size_t(vertex)] +=
                        0.5 *
                        crossings.between(origin + cornerOffset(in), origin + cornerOffset(out))
                            .onEdge;
                }
            }
            ++index;
        }
    }
}

}  // namespace haustra::contouring
