#include "segmentation/haustral_folds.h"

#include "core/crop.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace haustra::segmentation {
namespace {

constexpr double thickestMm = 4.5, leastDepthMm = 2.5, leastPieceMl = 3.0, leastGas = 0.2;

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
            const std::size_t last = std::min(std::size_t(grid.size.z), (s + 1) * slab);
            visitSlices(grid, s * slab, last, [&](std::size_t n, glm::ivec3 v) {
                const std::int32_t piece = cut.pieceAt[n];
                if (piece < 0) return;
                auto& [lo, hi] = corners[std::size_t(piece)];
                lo = glm::min(lo, v), hi = glm::max(hi, v);
            });
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
    const std::ptrdiff_t away =
        step.x + std::ptrdiff_t(grid.size.x) * (step.y + std::ptrdiff_t(grid.size.y) * step.z);
    const auto fillFrom = [&](glm::ivec3 v) {
        glm::ivec3 w = v + step;
        for (int gap = 1; gap <= most; ++gap) {
            w += step;
            if (!grid.contains(w)) return;
            if (lumen.at(w) == 0) continue;
            for (glm::ivec3 between = v + step; between != w; between += step)
                filled[grid.index(between)] = 1;
            return;
        }
    };
    // Of each row, what has a neighbour that is no lumen: few voxels of it.
    const int first = std::max(0, -step.x), last = grid.size.x - std::max(0, step.x);
    std::vector<std::uint8_t> atWall(std::size_t(grid.size.x), 0);
    for (int k = 0; k < grid.size.z - step.z; ++k) {
        for (int j = std::max(0, -step.y); j < grid.size.y - std::max(0, step.y); ++j) {
            const std::uint8_t* row = &lumen.voxels()[grid.index(0, j, k)];
            for (int i = first; i < last; ++i)
                atWall[std::size_t(i)] = row[i] & (row[i + away] ^ 1);
            for (auto at = atWall.begin();
                 (at = std::find(at, atWall.end(), std::uint8_t(1))) != atWall.end(); ++at)
                fillFrom({int(at - atWall.begin()), j, k});
        }
    }
}

/// Steps to what is nearer than `leastMm`, the nearest first; without the step of 0.
std::vector<glm::ivec3> stepsWithin(double leastMm, glm::dvec3 spacingMm) {
    const auto mm = [&](glm::ivec3 step) {  // single precision: what is `leastMm` off is no nearer
        return float(glm::length(spacingMm * glm::dvec3(step)));
    };
    const glm::ivec3 reach(glm::floor(leastMm / spacingMm));
    std::vector<glm::ivec3> steps;
    for (int k = -reach.z; k <= reach.z; ++k) {
        for (int j = -reach.y; j <= reach.y; ++j) {
            for (int i = -reach.x; i <= reach.x; ++i) {
                if ((i || j || k) && mm({i, j, k}) < float(leastMm)) steps.emplace_back(i, j, k);
            }
        }
    }
    std::stable_sort(steps.begin(), steps.end(),
                     [&](glm::ivec3 a, glm::ivec3 b) { return mm(a) < mm(b); });
    return steps;
}

double foldDensityOf(const TubePieces& cut, std::int32_t piece, const VoxelBox& box,
                     const Volume<std::uint8_t>& thinWalls) {
    const Volume<std::int32_t> pieceAt = croppedCopy(cut.pieceAt, box, 1);
    const Volume<std::uint8_t> walls = croppedCopy(thinWalls, box, 1);
    const Grid& grid = pieceAt.grid();
    Volume<std::uint8_t> lumen(grid), filled(grid), folds(grid, std::uint8_t(0));
    std::uint8_t *const own = lumen.writable().data(), *const with = filled.writable().data(),
                        *const fold = folds.writable().data();
    double wallMm2 = 0.0;
    const glm::dvec3 spacing = grid.spacingMm(), faceMm2 = grid.voxelVolumeMm3() / spacing;
    visitSlices(grid, 0, std::size_t(grid.size.z), [&](std::size_t n, glm::ivec3 v) {
        own[n] = pieceAt[n] == piece && !walls[n];
        with[n] = pieceAt[n] >= 0 && !walls[n];
        if (pieceAt[n] != piece) return;
        visitFaces(grid, n, v, [&](std::size_t m, int axis) {
            if (pieceAt[m] < 0) wallMm2 += faceMm2[axis];
        });
    });
    if (wallMm2 == 0.0) return -1.0;
    for (int d = 14; d < 27; ++d) {  // one of each two opposite neighbours
        const glm::ivec3 step = cornerStep(d);
        const int most = int(std::floor(thickestMm / glm::length(spacing * glm::dvec3(step))));
        fillBetween(lumen, step, most, folds.writable());
    }
    std::vector<std::size_t> between;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (!fold[n] || with[n]) continue;  // not another piece's lumen
        with[n] = 1;
        between.push_back(n);
    }
    const std::vector<glm::ivec3> nearer = stepsWithin(leastDepthMm, spacing);
    const auto isDeep = [&](std::size_t n) {
        const glm::ivec3 v = grid.voxelAt(n);
        return std::none_of(nearer.begin(), nearer.end(), [&](glm::ivec3 step) {
            return grid.contains(v + step) && filled.at(v + step) == 0;
        });
    };
    const auto voxels = std::count_if(between.begin(), between.end(), isDeep);
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
                piece.volumeMl >= leastPieceMl)
                densities[p] = foldDensityOf(cut, std::int32_t(p), boxes[p], thinWalls);
        }
    });
    return densities;
}

}  // namespace haustra::segmentation
