#include "contouring/vertex_placement.h"

#include "core/parallel.h"

#include <array>
#include <utility>
#include <vector>

namespace haustra::contouring {
namespace {

// The cell is shrunk by this on each side: vertices of neighbouring cells never meet.
constexpr double cellMargin = 0.05;
// λ; a crossing's plane weighs 1. Draws a ball of 3 mm radius in by 0.01 mm.
constexpr double smoothness = 0.3;
constexpr int steps = 10;

/// Σ w (n · (x − p))² over the crossings p of one loop, normals n in mm: the quadric of dual
/// contouring (Ju et al., SIGGRAPH 2002). All in mm from the crossings' origin.
struct LoopQuadric {
    glm::dmat3 normals{0.0};  ///< Σ w n nᵀ
    glm::dvec3 planes{0.0};   ///< Σ w n (n · p)
    glm::dvec3 mean{0.0};     ///< of the crossings on their edges: inside the loop's hull
};

/// One for each loop, in the order of the vertices. w is 1 where the HU show the wall between the
/// two centres, falls to 0 half an edge beyond them, and is 0 where they show none.
std::vector<LoopQuadric> loopQuadrics(const BoundaryCells& cells,
                                      const BoundaryCrossings& crossings, int threads) {
    std::vector<LoopQuadric> quadrics(cells.vertexCount());
    const glm::dmat3 mmFromVoxel = crossings.mmFromVoxel();
    auto addCell = [&](const BoundaryCell& cell, int k) {
        const CellLoops& loops = cellLoops(cell.inside);
        const glm::ivec3 origin(cell.i, cell.j, k);
        LoopQuadric* const quadric = quadrics.data() + cell.firstVertex;
        std::array<int, 4> count{};
        for (int edge = 0; edge < cellEdges; ++edge) {
            const int loop = loops.loopOfEdge[edge];
            if (loop < 0) continue;
            int in = lowerCorner(edge), out = upperCorner(edge);
            if (!(cell.inside >> in & 1)) std::swap(in, out);
            const Crossing crossing =
                crossings.between(origin + cornerOffset(in), origin + cornerOffset(out));
            const glm::dvec3 weighted = crossing.weight * crossing.normal;
            quadric[loop].normals += glm::outerProduct(weighted, crossing.normal);
            quadric[loop].planes +=
                weighted * glm::dot(crossing.normal, mmFromVoxel * crossing.point);
            quadric[loop].mean += mmFromVoxel * crossing.onEdge;
            ++count[std::size_t(loop)];
        }
        for (int loop = 0; loop < loops.count; ++loop)
            quadric[loop].mean /= double(count[std::size_t(loop)]);
    };
    cells.forEach(threads, addCell);
    return quadrics;
}

/// The vertex across each of a cell's six faces (low x, high x, low y …); −1: none.
using Neighbours = std::array<std::int32_t, 6>;

/// Neighbours of each vertex. Of the two arcs over an ambiguous face, one stands for both.
std::vector<Neighbours> findNeighbours(const BoundaryCells& cells, int threads) {
    std::vector<Neighbours> neighbours(cells.vertexCount());
    for (Neighbours& around : neighbours)
        around.fill(-1);
    const auto joinAcrossLowFaces = [&](const BoundaryCell& cell, int edge, LayerPair& pair) {
        const int loop = cellLoops(cell.inside).loopOfEdge[edge];
        if (loop < 0) return;
        for (int axis = 0; axis < 3; ++axis) {
            // The edge must lie on the low face across the axis.
            if (axis == edge / 4 || (lowerCorner(edge) >> axis & 1)) continue;
            glm::ivec2 beside(cell.i, cell.j);
            if (axis < 2) --beside[axis];
            const BoundaryCell& other =
                cells.cells()[std::size_t(pair.find(beside.x, beside.y, axis == 2))];
            const int there = cellEdge(edge / 4, lowerCorner(edge) | 1 << axis);
            const std::int32_t here = cell.firstVertex + loop;
            const std::int32_t across =
                other.firstVertex + cellLoops(other.inside).loopOfEdge[there];
            neighbours[std::size_t(here)][2 * axis] = across;
            neighbours[std::size_t(across)][2 * axis + 1] = here;
        }
    };
    parallelFor(std::size_t(cells.layers()), 16, threads, [&](std::size_t begin, std::size_t end) {
        LayerPair pair(cells);
        for (std::size_t n = begin; n < end; ++n) {
            pair.moveTo(int(n));
            for (const BoundaryCell& cell : cells.layer(int(n))) {
                for (int edge = 0; edge < cellEdges; ++edge)
                    joinAcrossLowFaces(cell, edge, pair);
            }
        }
    });
    return neighbours;
}

glm::dvec3 meanOf(const Neighbours& around, const std::vector<glm::dvec3>& mm) {
    glm::dvec3 sum(0.0);
    int count = 0;
    for (std::int32_t vertex : around) {
        if (vertex < 0) continue;
        sum += mm[std::size_t(vertex)];
        ++count;
    }
    return sum / double(count);
}

}  // namespace

std::vector<glm::dvec3> placeVertices(const BoundaryCells& cells,
                                      const BoundaryCrossings& crossings, int threads) {
    const std::vector<LoopQuadric> quadrics = loopQuadrics(cells, crossings, threads);
    const std::vector<Neighbours> neighbours = findNeighbours(cells, threads);
    const glm::dmat3 mmFromVoxel = crossings.mmFromVoxel();
    const glm::dmat3 voxelFromMm = glm::inverse(mmFromVoxel);
    std::vector<glm::dvec3> mm(quadrics.size()), next(quadrics.size());
    for (std::size_t v = 0; v < quadrics.size(); ++v)
        mm[v] = quadrics[v].mean;

    auto relax = [&](const BoundaryCell& cell, int k) {
        const std::size_t v = std::size_t(cell.firstVertex);
        const int count = cellLoops(cell.inside).count;
        if (count > 1) {
            for (int loop = 0; loop < count; ++loop)
                next[v + std::size_t(loop)] = mm[v + std::size_t(loop)];
            return;
        }
        const LoopQuadric& quadric = quadrics[v];
        const glm::dvec3 target = quadric.planes + smoothness * meanOf(neighbours[v], mm);
        const glm::dvec3 free = glm::inverse(quadric.normals + glm::dmat3(smoothness)) * target;
        const glm::dvec3 low(glm::ivec3(cell.i, cell.j, k) - crossings.origin());
        next[v] = mmFromVoxel *
                  glm::clamp(voxelFromMm * free, low + cellMargin, low + (1.0 - cellMargin));
    };
    for (int step = 0; step < steps; ++step) {
        cells.forEach(threads, relax);
        mm.swap(next);
    }
    for (glm::dvec3& p : mm)
        p = voxelFromMm * p;
    return mm;
}

}  // namespace haustra::contouring
