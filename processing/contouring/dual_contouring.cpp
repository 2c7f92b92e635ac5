#include "contouring/dual_contouring.h"

#include "contouring/boundary_cells.h"
#include "contouring/boundary_crossing.h"
#include "contouring/edge_polygon.h"
#include "contouring/vertex_placement.h"
#include "core/parallel.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace haustra::contouring {
namespace {

/// A vertex in the middle of each arc over an ambiguous face, and over a face of a cell with
/// several loops. Two cells that an ambiguous face parts may both join its two arcs in one loop;
/// straight from vertex to vertex both arcs would be one edge of four polygons, not manifold. And
/// from a cell with several loops the straight way may leave the hull of its loop's crossings.
class FaceVertices {
public:
    FaceVertices(const BoundaryCells& cells, const BoundaryCrossings& crossings, int threads);

    /// In voxels from the crossings' origin.
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

bool hasArc(CellCase inside, int axis) {
    // Corners of the low face: those without the axis's bit.
    const unsigned face = axis == 0 ? 0x55 : axis == 1 ? 0x33 : 0x0f;
    const unsigned there = inside & face;
    return there != 0 && there != face;
}

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
                const glm::ivec3 place(cell.i, cell.j, BoundaryCells::ofLayer(int(n)));
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
            const glm::ivec3 origin(cell.i, cell.j, BoundaryCells::ofLayer(int(n)));
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

/// Everything that the polygons are made from. Vertices are numbered: loops', faces', edges'.
struct DualVertices {
    const BoundaryCells& cells;
    const BoundaryCrossings& crossings;
    const FaceVertices& faceVertices;
    const std::vector<glm::dvec3>& loopVertices;  ///< in voxels from the crossings' origin
    std::int32_t edgeVerticesBegin() const {
        return std::int32_t(loopVertices.size() + faceVertices.positions().size());
    }
};

/// The triangles of the edges that one layer's cells own: those from their corner 0.
struct LayerSurface {
    std::vector<glm::dvec3> edgeVertices;  ///< in voxels from the crossings' origin
    /// Vertex numbers; −1 − n is the layer's edge vertex n.
    std::vector<glm::ivec3> triangles;
};

/// The polygon of one crossed edge, counter-clockwise seen from the edge's far end.
struct DualPolygon {
    std::array<std::int32_t, 4> corners;     ///< vertices of the cells around the edge
    std::array<std::int32_t, 4> afterwards;  ///< vertex on the arc to the next corner; −1: none
    bool plain() const { return afterwards == std::array<std::int32_t, 4>{-1, -1, -1, -1}; }
};

class LayerContourer {
public:
    LayerContourer(const DualVertices& dual, bool mirrored)
        : dual_(dual), mirrored_(mirrored), pair_(dual.cells) {}

    LayerSurface contour(int layer) {
        LayerSurface surface;
        pair_.moveTo(layer);
        const int k = BoundaryCells::ofLayer(layer);
        for (const BoundaryCell& cell : dual_.cells.layer(layer)) {
            for (int axis = 0; axis < 3; ++axis) {
                const bool insideHere = cell.inside & 1,
                           insideThere = cell.inside >> (1 << axis) & 1;
                if (insideHere != insideThere)
                    addPolygon(surface, {cell.i, cell.j, k}, axis, insideHere);
            }
        }
        return surface;
    }

private:
    DualPolygon polygonAround(glm::ivec3 voxel, int axis, bool insideHere) const {
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        const glm::ivec2 quadrants[4] = {{0, 0}, {-1, 0}, {-1, -1}, {0, -1}};
        DualPolygon polygon;
        std::array<std::int32_t, 4> around;
        for (int n = 0; n < 4; ++n) {
            glm::ivec3 place(0);
            place[b] = quadrants[n].x, place[c] = quadrants[n].y;
            around[n] = pair_.find(voxel.x + place.x, voxel.y + place.y, place.z < 0);
            const BoundaryCell& cell = dual_.cells.cells()[std::size_t(around[n])];
            const int edge = cellEdge(axis, cornerOf(-place));
            polygon.corners[n] = cell.firstVertex + cellLoops(cell.inside).loopOfEdge[edge];
        }
        // The face between cells n and n + 1 is the low one of that on the face's far side.
        const int farSide[4] = {0, 1, 3, 0}, faceAxis[4] = {b, c, b, c};
        for (int n = 0; n < 4; ++n) {
            const std::int32_t owner = around[farSide[n]];
            glm::ivec3 corner(0);
            corner[b] = -quadrants[farSide[n]].x, corner[c] = -quadrants[farSide[n]].y;
            corner[axis] = insideHere ? 0 : 1;
            const std::int32_t vertex =
                dual_.faceVertices.find(owner, dual_.cells.cells()[std::size_t(owner)].inside,
                                        faceAxis[n], cornerOf(corner));
            polygon.afterwards[n] =
                vertex < 0 ? -1 : vertex + std::int32_t(dual_.loopVertices.size());
        }
        return polygon;
    }

    std::optional<int> diagonalOf(const DualPolygon& polygon, glm::ivec3 voxel, int axis) const {
        std::array<glm::dvec3, 4> local, mm;
        for (int n = 0; n < 4; ++n) {
            const glm::dvec3 p = dual_.loopVertices[std::size_t(polygon.corners[n])] -
                                 glm::dvec3(voxel - dual_.crossings.origin());
            local[n] = {p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]};
            mm[n] = dual_.crossings.mmFromVoxel() * p;
        }
        return envelopeDiagonal(local, mm);
    }

    void addPolygon(LayerSurface& surface, glm::ivec3 voxel, int axis, bool insideHere) const {
        const DualPolygon polygon = polygonAround(voxel, axis, insideHere);
        const bool flip = insideHere == mirrored_;
        auto add = [&](std::int32_t p, std::int32_t q, std::int32_t r) {
            surface.triangles.push_back(flip ? glm::ivec3(p, r, q) : glm::ivec3(p, q, r));
        };
        const auto& corners = polygon.corners;
        const std::optional<int> diagonal =
            polygon.plain() ? diagonalOf(polygon, voxel, axis) : std::nullopt;
        if (diagonal) {
            const int d = *diagonal;
            add(corners[d], corners[d + 1], corners[d + 2]);
            add(corners[d], corners[d + 2], corners[(d + 3) % 4]);
            return;
        }
        glm::ivec3 inside = voxel, outside = voxel;
        (insideHere ? outside : inside)[axis] += 1;
        const std::int32_t center = -1 - std::int32_t(surface.edgeVertices.size());
        surface.edgeVertices.push_back(dual_.crossings.between(inside, outside).onEdge);
        for (int n = 0; n < 4; ++n) {
            std::int32_t from = corners[n];
            if (const std::int32_t middle = polygon.afterwards[n]; middle >= 0) {
                add(center, from, middle);
                from = middle;
            }
            add(center, from, corners[(n + 1) % 4]);
        }
    }

    static int cornerOf(glm::ivec3 offset) { return offset.x | offset.y << 1 | offset.z << 2; }

    const DualVertices& dual_;
    bool mirrored_;
    LayerPair pair_;
};

/// One mesh of all layers' triangles, vertices in patient mm, on a lattice about the origin.
TriMesh assemble(const DualVertices& dual, const std::vector<LayerSurface>& layers,
                 const Grid& grid, int threads) {
    const glm::dmat3& mmFromVoxel = dual.crossings.mmFromVoxel();
    const glm::dvec3 originMm = grid.patientFromVoxelPoint(glm::dvec3(dual.crossings.origin()));
    const auto place = [&](glm::dvec3 voxels) {
        return originMm + onMeshLattice(mmFromVoxel * voxels);
    };
    std::vector<std::size_t> vertexBegin{std::size_t(dual.edgeVerticesBegin())}, triangleBegin{0};
    for (const LayerSurface& layer : layers) {
        vertexBegin.push_back(vertexBegin.back() + layer.edgeVertices.size());
        triangleBegin.push_back(triangleBegin.back() + layer.triangles.size());
    }
    TriMesh mesh;
    mesh.vertices.resize(vertexBegin.back());
    mesh.triangles.resize(triangleBegin.back());
    const std::size_t loops = dual.loopVertices.size();
    const auto& facePositions = dual.faceVertices.positions();
    parallelFor(vertexBegin.front(), 1 << 16, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            mesh.vertices[v] = place(v < loops ? dual.loopVertices[v] : facePositions[v - loops]);
        }
    });
    parallelFor(layers.size(), 8, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            for (std::size_t v = 0; v < layers[n].edgeVertices.size(); ++v)
                mesh.vertices[vertexBegin[n] + v] = place(layers[n].edgeVertices[v]);
            for (std::size_t t = 0; t < layers[n].triangles.size(); ++t) {
                glm::ivec3 triangle = layers[n].triangles[t];
                for (int corner = 0; corner < 3; ++corner) {
                    if (triangle[corner] < 0)
                        triangle[corner] = int(vertexBegin[n]) - 1 - triangle[corner];
                }
                mesh.triangles[triangleBegin[n] + t] = triangle;
            }
        }
    });
    return mesh;
}

}  // namespace

Result<TriMesh> contourLumen(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& lumen,
                             double isoHu, const ContouringOptions& options) {
    if (!sameGrid(hu.grid(), lumen.grid()))
        return fail(ErrorKind::badInput, "the HU and the lumen are on different grids", "surface");
    const BoundaryCells cells(lumen, options.threads);
    if (cells.cells().empty())
        return fail(ErrorKind::noResult, "the lumen is empty: there is no surface", "surface");

    const BoundaryCrossings crossings(hu, isoHu, cells.low());
    const FaceVertices faceVertices(cells, crossings, options.threads);
    const std::vector<glm::dvec3> loopVertices = placeVertices(cells, crossings, options.threads);
    const DualVertices dual{cells, crossings, faceVertices, loopVertices};

    const bool mirrored = glm::determinant(crossings.mmFromVoxel()) < 0.0;
    std::vector<LayerSurface> layers{std::size_t(cells.layers())};
    parallelFor(layers.size(), 16, options.threads, [&](std::size_t begin, std::size_t end) {
        LayerContourer contourer(dual, mirrored);
        for (std::size_t n = begin; n < end; ++n)
            layers[n] = contourer.contour(int(n));
    });
    return assemble(dual, layers, hu.grid(), options.threads);
}

}  // namespace haustra::contouring
