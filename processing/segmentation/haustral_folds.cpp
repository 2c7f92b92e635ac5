#include "segmentation/haustral_folds.h"

#include "core/crop.h"
#include "topology/distance_field.h"

#include <cmath>
#include <span>

namespace haustra::segmentation {
namespace {

constexpr double thickestMm = 4.5, leastDepthMm = 2.5, leastMl = 3.0, leastGas = 0.2;

/// The smallest box of each piece's voxels.
std::vector<VoxelBox> boxesOf(const TubePieces& cut, int threads) {
    const Grid& grid = cut.pieceAt.grid();
    struct Corners {
        glm::ivec3 lo, hi;
    };
    const Corners empty{grid.size, glm::ivec3(-1)};
    constexpr std::size_t slab = 8;
    const std::size_t slabs = (std::size_t(grid.size.z) + slab - 1) / slab;
    std::vector<std::vector<Corners>> ofSlab(slabs);
    parallelFor(slabs, 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            std::vector<Corners>& corners = ofSlab[s];
            corners.assign(cut.pieces.size(), empty);
            const int last = std::min(grid.size.z, int((s + 1) * slab));
            for (int k = int(s * slab); k < last; ++k) {
                for (int j = 0; j < grid.size.y; ++j) {
                    const std::int32_t* row = &cut.pieceAt.voxels()[grid.index(0, j, k)];
                    for (int i = 0; i < grid.size.x; ++i) {
                        if (row[i] < 0) continue;
                        auto& [lo, hi] = corners[std::size_t(row[i])];
                        lo = glm::min(lo, glm::ivec3(i, j, k)),
                        hi = glm::max(hi, glm::ivec3(i, j, k));
                    }
                }
            }
        }
    });
    std::vector<VoxelBox> boxes;
    for (std::size_t p = 0; p < cut.pieces.size(); ++p) {
        auto [lo, hi] = empty;
        for (const std::vector<Corners>& corners : ofSlab)
            lo = glm::min(lo, corners[p].lo), hi = glm::max(hi, corners[p].hi);
        boxes.push_back(boxWithin(grid, lo, hi, glm::dvec3(thickestMm)));
    }
    return boxes;
}

/// Marks in `filled` what lies between voxels of `lumen` along `step`, `most` voxels at most.
void fillBetween(const Volume<std::uint8_t>& lumen, glm::ivec3 step, int most,
                 std::span<std::uint8_t> filled) {
    const Grid& grid = lumen.grid();
    for (std::size_t n = 0; n < lumen.voxels().size(); ++n) {
        if (lumen[n] == 0) continue;
        const glm::ivec3 v = grid.voxelAt(n);
        glm::ivec3 w = v + step;
        if (!grid.contains(w) || lumen.at(w) != 0) continue;
        for (int gap = 1; gap <= most; ++gap) {
            w += step;
            if (!grid.contains(w)) break;
            if (lumen.at(w) == 0) continue;
            for (glm::ivec3 between = v + step; between != w; between += step)
                filled[grid.index(between)] = 1;
            break;
        }
    }
}

double foldDensityOf(const TubePieces& cut, std::int32_t piece, const VoxelBox& box,
                     const Volume<std::uint8_t>& thinWalls) {
    const Volume<std::int32_t> pieceAt = croppedCopy(cut.pieceAt, box, 1);
    const Volume<std::uint8_t> walls = croppedCopy(thinWalls, box, 1);
    const Grid& grid = pieceAt.grid();
    Volume<std::uint8_t> lumen(grid, std::uint8_t(0)), filled(grid, std::uint8_t(0));
    const auto own = lumen.writable(), with = filled.writable();
    double wallMm2 = 0.0;
    const glm::dvec3 spacing = grid.spacingMm(), faceMm2 = grid.voxelVolumeMm3() / spacing;
    for (std::size_t n = 0; n < own.size(); ++n) {
        own[n] = pieceAt[n] == piece && !walls[n];
        with[n] = pieceAt[n] >= 0 && !walls[n];
        if (pieceAt[n] != piece) continue;
        visitFaces(grid, n, [&](std::size_t m, int axis) {
            if (pieceAt[m] < 0) wallMm2 += faceMm2[axis];
        });
    }
    if (wallMm2 == 0.0) return -1.0;
    Volume<std::uint8_t> folds(grid, std::uint8_t(0));
    const auto fold = folds.writable();
    for (int d = 14; d < 27; ++d) {  // one of each two opposite neighbours
        const glm::ivec3 step(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
        const int most = int(std::floor(thickestMm / glm::length(spacing * glm::dvec3(step))));
        fillBetween(lumen, step, most, fold);
    }
    for (std::size_t n = 0; n < with.size(); ++n) {
        fold[n] = fold[n] && !with[n];  // not another piece's lumen
        with[n] = with[n] || fold[n];
    }
    const Volume<float> depthMm = topology::distanceToBoundaryMm(filled, 1);
    std::size_t voxels = 0;
    for (std::size_t n = 0; n < fold.size(); ++n)
        voxels += fold[n] && !(depthMm[n] < float(leastDepthMm));
    return double(voxels) * grid.voxelVolumeMm3() / wallMm2;
}

}  // namespace

std::vector<double> foldDensityMm(const TubePieces& cut, const Volume<std::uint8_t>& thinWalls,
                                  int threads) {
    const std::vector<VoxelBox> boxes = boxesOf(cut, threads);
    std::vector<double> densities(cut.pieces.size(), -1.0);
    parallelFor(cut.pieces.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const TubePiece& piece = cut.pieces[p];
            if (double(piece.gasVoxels) > leastGas * double(piece.voxels) &&
                piece.volumeMl >= leastMl)
                densities[p] = foldDensityOf(cut, std::int32_t(p), boxes[p], thinWalls);
        }
    });
    return densities;
}

}  // namespace haustra::segmentation
