// Which triangle of a flat map covers each pixel of a window, without a GPU.
#pragma once

#include "render/flat/flat_geometry.h"

#include <cstdint>
#include <vector>

namespace haustra::render {

/// Of one pixel: a triangle of the geometry and the copy of the strip that it is in, or −1.
struct FlatPixel {
    std::int32_t triangle = -1, copy = 0;
};

/// Rows [firstRow, firstRow + rows) of the picture, in order. The same triangles as
/// shaders/flat_triangles.vert gives a GPU: corners are snapped to 1/256 of the lattice's pixels,
/// then a pixel belongs to the triangle that holds its centre, exactly; a centre on an edge belongs
/// to the triangle on its right or below. Of several, the one drawn last. Any thread.
void coverRows(const FlatGeometry& geometry, const FlatLattice& lattice, int firstRow, int rows,
               std::vector<FlatPixel>& pixels);

}  // namespace haustra::render
