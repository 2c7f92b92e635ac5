#include "surface/vertex_placement.h"

#include "core/parallel.h"

namespace haustra::surface {
namespace {

// The cell is shrunk by this on each side: vertices of neighbouring cells never meet.
constexpr double cellMargin = 0.05;
// λ as a share of the number of crossings: holds the position where normals leave it free.
constexpr double regularisation = 0.1;

struct Loop {
    int crossings = 0, seen = 0;
    glm::dvec3 onEdgeSum{0.0}, pointSum{0.0};
    glm::dmat3 normalMatrix{0.0};
    glm::dvec3 normalVector{0.0};
};

}  // namespace

std::vector<glm::dvec3> placeVertices(const BoundaryCells& cells,
                                      const BoundaryCrossings& crossings, int threads) {
    std::vector<glm::dvec3> positions(cells.vertexCount());
    const glm::dmat3 mmFromVoxel = crossings.mmFromVoxel();
    const glm::dmat3 voxelFromMm = glm::inverse(mmFromVoxel);

    parallelFor(std::size_t(cells.layers()), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            for (const BoundaryCell& cell : cells.layer(int(n))) {
                const CellLoops& loops = cellLoops(cell.inside);
                const glm::ivec3 origin(cell.i, cell.j, BoundaryCells::kOfLayer(int(n)));
                std::array<Loop, 4> sums;
                for (int edge = 0; edge < cellEdges; ++edge) {
                    if (loops.loopOfEdge[edge] < 0) continue;
                    int in = lowerCorner(edge), out = upperCorner(edge);
                    if (!(cell.inside >> in & 1)) std::swap(in, out);
                    const Crossing crossing =
                        crossings.between(origin + cornerOffset(in), origin + cornerOffset(out));
                    Loop& loop = sums[std::size_t(loops.loopOfEdge[edge])];
                    ++loop.crossings;
                    loop.onEdgeSum += crossing.onEdge - glm::dvec3(origin);
                    const glm::dvec3 point = crossing.point - glm::dvec3(origin);
                    loop.pointSum += point;
                    if (!crossing.seen()) continue;
                    ++loop.seen;
                    loop.normalMatrix += glm::outerProduct(crossing.normal, crossing.normal);
                    loop.normalVector +=
                        crossing.normal * glm::dot(crossing.normal, mmFromVoxel * point);
                }
                for (int l = 0; l < loops.count; ++l) {
                    const Loop& loop = sums[std::size_t(l)];
                    glm::dvec3 local = loop.onEdgeSum / double(loop.crossings);
                    if (loops.count == 1 && loop.seen > 0) {
                        const glm::dvec3 meanMm =
                            mmFromVoxel * (loop.pointSum / double(loop.crossings));
                        const double weight = regularisation * double(loop.crossings);
                        const glm::dmat3 system = loop.normalMatrix + glm::dmat3(weight);
                        const glm::dvec3 positionMm =
                            glm::inverse(system) * (loop.normalVector + weight * meanMm);
                        local = voxelFromMm * positionMm;
                        local =
                            glm::clamp(local, glm::dvec3(cellMargin), glm::dvec3(1.0 - cellMargin));
                    }
                    positions[std::size_t(cell.firstVertex) + std::size_t(l)] =
                        glm::dvec3(origin) + local;
                }
            }
        }
    });
    return positions;
}

}  // namespace haustra::surface
