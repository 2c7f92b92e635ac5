// The cases of a cell, the search for boundary cells, and the envelopes of edges.
#include "contouring/boundary_cells.h"
#include "contouring/cell_cases.h"
#include "contouring/edge_polygon.h"

#include <array>
#include <bit>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace haustra::contouring {
namespace {

bool isInside(unsigned inside, int corner) {
    return inside >> corner & 1;
}

/// Components of a cell's corners of one kind, joined across edges (reach 1) or faces too (2).
int cornerComponents(unsigned inside, bool ofInside, int reach) {
    std::array<int, 8> component;
    std::iota(component.begin(), component.end(), 0);
    for (int sweep = 0; sweep < 8; ++sweep) {
        for (int a = 0; a < 8; ++a) {
            for (int b = 0; b < 8; ++b) {
                if (isInside(inside, a) == ofInside && isInside(inside, b) == ofInside &&
                    std::popcount(unsigned(a ^ b)) <= reach)
                    component[a] = component[b] = std::min(component[a], component[b]);
            }
        }
    }
    int count = 0;
    for (int a = 0; a < 8; ++a)
        count += isInside(inside, a) == ofInside && component[a] == a;
    return count;
}

TEST(DualContouringCells, EdgesAndCornersAgree) {
    for (int edge = 0; edge < cellEdges; ++edge) {
        EXPECT_EQ(cellEdge(edge / 4, lowerCorner(edge)), edge);
        EXPECT_EQ(upperCorner(edge) - lowerCorner(edge), 1 << edge / 4);
    }
}

/// The cell's discs part its components from each other: a tree, as on a sphere.
TEST(DualContouringCells, HaveOneDiscBetweenTwoComponents) {
    EXPECT_EQ(cellLoops(0).count, 0);
    EXPECT_EQ(cellLoops(255).count, 0);
    for (unsigned inside = 1; inside < 255; ++inside) {
        const int discs =
            cornerComponents(inside, true, 1) + cornerComponents(inside, false, 2) - 1;
        EXPECT_EQ(cellLoops(CellCase(inside)).count, discs) << inside;
    }
}

TEST(DualContouringCells, GiveEachCrossedEdgeALoop) {
    for (unsigned inside = 0; inside < 256; ++inside) {
        const CellLoops& loops = cellLoops(CellCase(inside));
        for (int edge = 0; edge < cellEdges; ++edge) {
            const bool crossed =
                isInside(inside, lowerCorner(edge)) != isInside(inside, upperCorner(edge));
            EXPECT_EQ(loops.loopOfEdge[edge] >= 0, crossed);
            EXPECT_LT(loops.loopOfEdge[edge], loops.count);
        }
    }
}

TEST(DualContouringCells, AreFoundAsByLookingAtEachCell) {
    std::mt19937 random(1);
    for (int repeat = 0; repeat < 60; ++repeat) {
        const Grid grid =
            axisAlignedGrid({1 + random() % 70, 1 + random() % 6, 1 + random() % 6}, glm::dvec3(1));
        Volume<std::uint8_t> lumen(grid, 0);
        // Long runs of any non-zero label, with a few odd voxels.
        const unsigned odd = 1 + random() % 40;
        std::uint8_t label = 0;
        for (std::uint8_t& voxel : lumen.writable()) {
            if (random() % 30 == 0) label = label ? 0 : std::uint8_t(1 + random() % 255);
            voxel = random() % odd == 1 ? std::uint8_t(random() % 2) : label;
        }
        const BoundaryCells cells(lumen, 2);
        std::size_t at = 0;
        std::int32_t vertices = 0;
        for (int k = -1; k < grid.size.z; ++k) {
            for (int j = -1; j < grid.size.y; ++j) {
                for (int i = -1; i < grid.size.x; ++i) {
                    unsigned inside = 0;
                    for (int corner = 0; corner < 8; ++corner) {
                        const glm::ivec3 v = glm::ivec3(i, j, k) + cornerOffset(corner);
                        inside |= unsigned(grid.contains(v) && lumen.at(v) != 0) << corner;
                    }
                    if (inside == 0 || inside == 255) continue;
                    ASSERT_LT(at, cells.cells().size());
                    const BoundaryCell& cell = cells.cells()[at++];
                    ASSERT_EQ(glm::ivec2(cell.i, cell.j), glm::ivec2(i, j));
                    ASSERT_EQ(unsigned(cell.inside), inside);
                    ASSERT_EQ(cell.firstVertex, vertices);
                    vertices += cellLoops(cell.inside).count;
                }
            }
        }
        ASSERT_EQ(at, cells.cells().size());
        ASSERT_EQ(std::size_t(vertices), cells.vertexCount());
    }
}

TEST(DualContouringCells, AreFoundAgainInTwoLayers) {
    std::mt19937 random(2);
    Volume<std::uint8_t> lumen(axisAlignedGrid({13, 9, 11}, glm::dvec3(1)));
    for (std::uint8_t& voxel : lumen.writable())
        voxel = random() % 2;
    const BoundaryCells cells(lumen, 1);
    LayerPair pair(cells);
    for (int layer : {0, 1, 2, 3, 7, 8, 4, 3, 11}) {
        pair.moveTo(layer);
        for (bool below : {false, true}) {
            if (below && layer == 0) continue;
            const int n = below ? layer - 1 : layer;
            std::size_t found = 0;
            for (int j = -1; j < 9; ++j) {
                for (int i = -1; i < 13; ++i) {
                    const std::int32_t cell = pair.find(i, j, below);
                    if (cell < 0) continue;
                    ++found;
                    ASSERT_GE(std::size_t(cell), cells.layerBegin(n));
                    ASSERT_LT(std::size_t(cell), cells.layerBegin(n) + cells.layer(n).size());
                    ASSERT_EQ(cells.cells()[std::size_t(cell)].i, i);
                    ASSERT_EQ(cells.cells()[std::size_t(cell)].j, j);
                }
            }
            ASSERT_EQ(found, cells.layer(n).size());
        }
    }
}

std::optional<int> diagonalOf(const std::array<glm::dvec3, 4>& corners) {
    return envelopeDiagonal(corners, corners);
}

TEST(EdgePolygon, CutsAnOrdinaryPolygonAlongItsRounderDiagonal) {
    // A flat rhombus: its short diagonal makes the rounder triangles.
    EXPECT_EQ(
        diagonalOf({{{0.5, 0.9, 0.9}, {0.5, -0.4, 0.4}, {0.5, -0.9, -0.9}, {0.5, 0.4, -0.4}}}), 1);
    EXPECT_EQ(
        diagonalOf({{{0.5, 0.4, 0.4}, {0.5, -0.9, 0.9}, {0.5, -0.4, -0.4}, {0.5, 0.9, -0.9}}}), 0);
}

TEST(EdgePolygon, CutsNoPolygonThatWouldLeaveItsEnvelope) {
    // 1–3 passes outside the corner 0, so only 0–2 will do.
    EXPECT_EQ(
        diagonalOf({{{0.5, 0.1, 0.1}, {0.5, -0.2, 0.9}, {0.5, -0.5, -0.5}, {0.5, 0.9, -0.2}}}), 0);
    // A saddle so steep that the edge misses both of its triangulations.
    EXPECT_EQ(
        diagonalOf(
            {{{0.05, 0.05, 0.9}, {0.95, -0.9, 0.05}, {0.05, -0.9, -0.05}, {0.95, 0.05, -0.9}}}),
        std::nullopt);
}

}  // namespace
}  // namespace haustra::contouring
