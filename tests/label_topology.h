// The topology of labelled voxels, counted in the plainest way.
#pragma once

#include "core/flood_fill.h"
#include "core/volume.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace haustra::tests {

/// χ of the solid whose voxels are 6-connected in an 18-connected background, from counts of
/// elements alone: voxels − edges + squares − cubes, and one more disc for each cube that is
/// outside at two opposite corners alone, which 18-connectivity keeps apart.
inline long solidEuler(const Volume<std::uint8_t>& labels) {
    const glm::ivec3 size = labels.grid().size;
    auto inside = [&](glm::ivec3 v) { return labels.grid().contains(v) && labels.at(v) != 0; };
    long euler = 0;
    for (int k = -1; k < size.z; ++k) {
        for (int j = -1; j < size.y; ++j) {
            for (int i = -1; i < size.x; ++i) {
                unsigned block = 0;
                for (int corner = 0; corner < 8; ++corner)
                    block |= unsigned(inside(glm::ivec3(i, j, k) +
                                             glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2)))
                             << corner;
                auto all = [&](unsigned mask) { return (block & mask) == mask; };
                euler += all(0x01);
                euler -= all(0x03) + all(0x05) + all(0x11);
                euler += all(0x0f) + all(0x33) + all(0x55);
                euler -= all(0xff);
                for (unsigned corner = 0; corner < 4; ++corner)
                    euler += block == (0xffu & ~(1u << corner | 1u << (7 - corner)));
            }
        }
    }
    return euler;
}

/// Components of the voxels that are (or are not) labelled, joined to neighbours at a squared
/// distance of at most `reach`; beyond the grid lies one ring of background.
inline long componentCount(const Volume<std::uint8_t>& labels, bool ofObject, int reach) {
    const glm::ivec3 size = labels.grid().size + 2;
    const Grid ring = axisAlignedGrid(size, glm::dvec3(1.0));
    auto member = [&](glm::ivec3 v) {
        const bool object = labels.grid().contains(v - 1) && labels.at(v - 1) != 0;
        return ring.contains(v) && object == ofObject;
    };
    std::vector<char> seen(ring.voxelCount(), 0);
    long count = 0;
    for (std::size_t start = 0; start < seen.size(); ++start) {
        if (seen[start] || !member(ring.voxelAt(start))) continue;
        ++count;
        std::vector<glm::ivec3> front{ring.voxelAt(start)};
        seen[start] = 1;
        const auto neighbours = [&](glm::ivec3 v, const auto& visit) {
            for (int n = 0; n < 27; ++n) {
                const glm::ivec3 d = cornerStep(n);
                if (d.x * d.x + d.y * d.y + d.z * d.z <= reach) visit(v + d);
            }
        };
        floodFill(front, neighbours, [&](glm::ivec3 v) {
            if (!member(v) || seen[ring.index(v)]) return false;
            seen[ring.index(v)] = 1;
            return true;
        });
    }
    return count;
}

/// Sizes, in voxels, of the 26-connected pieces of the voxels for which `in(index)` holds, largest
/// first.
template <class In>
std::vector<std::size_t> pieceSizes(const Grid& grid, const In& in) {
    std::vector<char> seen(grid.voxelCount(), 0);
    std::vector<std::size_t> sizes, piece;
    const auto take = [&](std::size_t n) {
        if (seen[n] || !in(n)) return false;
        seen[n] = 1;
        return true;
    };
    for (std::size_t start = 0; start < seen.size(); ++start) {
        if (!take(start)) continue;
        piece.assign(1, start);
        floodFill(piece, cornerNeighbours(grid), take);
        sizes.push_back(piece.size());
    }
    std::sort(sizes.rbegin(), sizes.rend());
    return sizes;
}

}  // namespace haustra::tests
