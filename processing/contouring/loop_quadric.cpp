#include "contouring/loop_quadric.h"

#include <array>
#include <utility>

namespace haustra::contouring {

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

}  // namespace haustra::contouring
