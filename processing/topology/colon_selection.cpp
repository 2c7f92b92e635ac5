#include "topology/colon_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <unordered_map>

namespace haustra::topology {
namespace {

constexpr double cellMm = 4.0;  // of the coarse grid that lengths are measured on

int rootOf(std::vector<int>& parent, int n) {
    while (parent[n] != n)
        n = parent[n] = parent[parent[n]];
    return n;
}
void unite(std::vector<int>& parent, int a, int b) {
    a = rootOf(parent, a), b = rootOf(parent, b);
    parent[std::max(a, b)] = std::min(a, b);
}

// Air components first, then pools, joined through the levels.
std::vector<int> joinedParts(int airCount, const std::vector<Level>& levels,
                             const std::vector<Pool>& pools) {
    std::vector<int> parent(airCount + pools.size());
    std::iota(parent.begin(), parent.end(), 0);
    for (std::size_t p = 0; p < pools.size(); ++p) {
        for (int touched : pools[p].touches)
            unite(parent, airCount + int(p), airCount + touched);
        for (int l : pools[p].levels) {
            std::map<int, std::size_t> columns;
            for (const LevelColumn& c : levels[l].columns)
                ++columns[c.air];
            for (const auto& [component, count] : columns) {
                if (10 * count >= levels[l].columns.size())
                    unite(parent, component, airCount + int(p));
            }
        }
    }
    for (std::size_t n = 0; n < parent.size(); ++n)
        parent[n] = rootOf(parent, int(n));
    return parent;
}

// A piece on a coarse grid: cells that it fills by at least a third.
struct CoarsePiece {
    std::unordered_map<std::size_t, int> fill;
};

// Shortest paths from one cell to all that it reaches; returns the farthest cell and its distance.
struct Farthest {
    std::size_t cell = 0;
    double distanceMm = 0.0;
    std::size_t reached = 0;
};
Farthest farthestFrom(std::size_t start, const std::unordered_map<std::size_t, int>& cells,
                      glm::ivec3 size, glm::dvec3 spacingMm) {
    std::unordered_map<std::size_t, double> distance;
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[start] = 0.0;
    queue.push({0.0, start});
    Farthest far{start, 0.0, 0};
    while (!queue.empty()) {
        const auto [d, cell] = queue.top();
        queue.pop();
        if (d > distance[cell]) continue;
        ++far.reached;
        if (d > far.distanceMm || (d == far.distanceMm && cell < far.cell))
            far.cell = cell, far.distanceMm = d;
        const glm::ivec3 c(int(cell % size.x), int(cell / size.x % size.y),
                           int(cell / size.x / size.y));
        for (int n = 0; n < 27; ++n) {
            const glm::ivec3 step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            const glm::ivec3 next = c + step;
            if (n == 13 || glm::any(glm::lessThan(next, glm::ivec3(0))) ||
                glm::any(glm::greaterThanEqual(next, size)))
                continue;
            const std::size_t index =
                std::size_t(next.x) +
                std::size_t(size.x) *
                    (std::size_t(next.y) + std::size_t(size.y) * std::size_t(next.z));
            if (!cells.count(index)) continue;
            const double there = d + glm::length(glm::dvec3(step) * spacingMm);
            const auto [known, isNew] = distance.try_emplace(index, there);
            if (isNew || there < known->second) known->second = there, queue.push({there, index});
        }
    }
    return far;
}

double gapMm(const BowelPiece& a, const BowelPiece& b) {
    double nearest = std::numeric_limits<double>::max();
    for (glm::dvec3 p : a.endMm) {
        for (glm::dvec3 q : b.endMm)
            nearest = std::min(nearest, glm::distance(p, q));
    }
    return nearest;
}

}  // namespace

double BowelPiece::calibreMm() const {
    return lengthMm > 0.0 ? std::sqrt(4.0 * 1000.0 * volumeMl() / (M_PI * lengthMm)) : 0.0;
}

std::vector<BowelPiece> bowelPieces(const Volume<std::int16_t>& hu, const RunComponents& air,
                                    const std::vector<char>& bowelAir,
                                    const std::vector<Level>& levels,
                                    const std::vector<Pool>& pools, double smallestMl) {
    const Grid& grid = hu.grid();
    const double voxelMl = grid.voxelVolumeMm3() / 1000.0;
    const int airCount = int(air.components().size());
    const std::vector<int> part = joinedParts(airCount, levels, pools);

    std::vector<double> partMl(part.size(), 0.0);
    for (int c = 0; c < airCount; ++c) {
        if (bowelAir[c]) partMl[part[c]] += double(air.components()[c].voxels) * voxelMl;
    }
    for (std::size_t p = 0; p < pools.size(); ++p)
        partMl[part[airCount + p]] += double(pools[p].voxels.size()) * voxelMl;

    std::vector<int> pieceOf(part.size(), -1);
    std::vector<BowelPiece> pieces;
    for (std::size_t n = 0; n < part.size(); ++n) {
        if (partMl[part[n]] < smallestMl || (int(n) < airCount && !bowelAir[n])) continue;
        int& piece = pieceOf[part[n]];
        if (piece < 0) piece = int(pieces.size()), pieces.emplace_back();
        if (int(n) < airCount) {
            pieces[piece].air.push_back(int(n));
            pieces[piece].airMl += double(air.components()[n].voxels) * voxelMl;
        } else {
            pieces[piece].pools.push_back(int(n) - airCount);
            pieces[piece].taggedMl += double(pools[n - airCount].voxels.size()) * voxelMl;
        }
    }

    const glm::dvec3 spacing = grid.spacingMm();
    const glm::ivec3 block = glm::max(glm::ivec3(1), glm::ivec3(glm::round(cellMm / spacing)));
    const glm::ivec3 coarse = (grid.size + block - 1) / block;
    auto cellOf = [&](glm::ivec3 v) {
        const glm::ivec3 c = v / block;
        return std::size_t(c.x) + std::size_t(coarse.x) *
                                      (std::size_t(c.y) + std::size_t(coarse.y) * std::size_t(c.z));
    };
    std::vector<CoarsePiece> fills(pieces.size());
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j < grid.size.y; ++j) {
            for (const Run& run : air.row(j, k)) {
                const int piece = pieceOf[part[run.component]];
                if (piece < 0 || !bowelAir[run.component]) continue;
                for (int i = run.begin; i < run.end;) {
                    const int end = std::min(run.end, (i / block.x + 1) * block.x);
                    fills[piece].fill[cellOf({i, j, k})] += end - i;
                    i = end;
                }
            }
        }
    }
    for (std::size_t p = 0; p < pools.size(); ++p) {
        const int piece = pieceOf[part[airCount + p]];
        if (piece < 0) continue;
        for (std::uint32_t index : pools[p].voxels)
            ++fills[piece].fill[cellOf(grid.voxelAt(index))];
    }

    const glm::dvec3 coarseSpacing = glm::dvec3(block) * spacing;
    const int third = std::max(1, block.x * block.y * block.z / 3);
    auto pointOf = [&](std::size_t cell) {
        const glm::ivec3 c(int(cell % coarse.x), int(cell / coarse.x % coarse.y),
                           int(cell / coarse.x / coarse.y));
        return grid.patientFromVoxelPoint((glm::dvec3(c) + 0.5) * glm::dvec3(block) - 0.5);
    };
    for (std::size_t n = 0; n < pieces.size(); ++n) {
        BowelPiece& piece = pieces[n];
        auto& fill = fills[n].fill;
        std::unordered_map<std::size_t, int> cells;
        for (const auto& [cell, count] : fill) {
            if (count >= third) cells.emplace(cell, count);
        }
        if (cells.empty()) cells = fill;
        std::vector<std::size_t> ordered;
        for (const auto& [cell, count] : cells)
            ordered.push_back(cell);
        std::sort(ordered.begin(), ordered.end());
        double sum = 0.0;
        piece.lowestMm = std::numeric_limits<double>::max(), piece.highestMm = -piece.lowestMm;
        for (std::size_t cell : ordered) {
            const glm::dvec3 p = pointOf(cell);
            piece.centroidMm += p * double(cells[cell]), sum += cells[cell];
            piece.lowestMm = std::min(piece.lowestMm, p.z),
            piece.highestMm = std::max(piece.highestMm, p.z);
        }
        piece.centroidMm /= sum;
        // Two sweeps, from the largest connected part: the ends of a tube.
        Farthest first;
        for (std::size_t tried = 0; tried < ordered.size() && tried < 4; ++tried) {
            const Farthest f =
                farthestFrom(ordered[tried * ordered.size() / 4], cells, coarse, coarseSpacing);
            if (f.reached > first.reached) first = f;
        }
        const Farthest second = farthestFrom(first.cell, cells, coarse, coarseSpacing);
        piece.endMm[0] = pointOf(first.cell), piece.endMm[1] = pointOf(second.cell);
        piece.lengthMm = second.distanceMm + cellMm;
    }
    return pieces;
}

std::vector<int> selectColon(const std::vector<BowelPiece>& pieces,
                             const std::vector<int>& chosen) {
    constexpr double wideMm = 15.0, tubeElongation = 3.5, tubeMl = 12.0, bigMl = 40.0;
    std::vector<char> colon(pieces.size(), 0);
    int longest = -1;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
        const BowelPiece& p = pieces[n];
        if (p.calibreMm() < wideMm || p.elongation() < tubeElongation) continue;
        if (longest < 0 ||
            p.volumeMl() * p.lengthMm > pieces[longest].volumeMl() * pieces[longest].lengthMm)
            longest = int(n);
    }
    if (longest < 0) {  // nothing like a tube: the largest piece
        for (std::size_t n = 0; n < pieces.size(); ++n) {
            if (longest < 0 || pieces[n].volumeMl() > pieces[longest].volumeMl()) longest = int(n);
        }
    }
    if (longest >= 0) colon[longest] = 1;
    for (int n : chosen)
        colon[n] = 1;
    if (longest < 0) return chosen;

    // Wide tubes and large pieces that reach below the middle of the abdomen's bowel.
    double low = std::numeric_limits<double>::max(), high = -low;
    for (const BowelPiece& p : pieces) {
        if (p.volumeMl() < tubeMl) continue;
        low = std::min(low, p.lowestMm), high = std::max(high, p.highestMm);
    }
    const double middle = 0.5 * (low + high);
    for (std::size_t n = 0; n < pieces.size(); ++n) {
        const BowelPiece& p = pieces[n];
        const bool tube =
            p.airMl >= tubeMl && p.calibreMm() >= wideMm && p.elongation() >= tubeElongation;
        if ((tube || p.airMl >= bigMl) && p.lowestMm < middle) colon[n] = 1;
    }

    // What lies between two ends that are near each other: islands of a collapsed segment, and
    // upper segments that both their ends continue.
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t n = 0; n < pieces.size(); ++n) {
            if (colon[n]) continue;
            const BowelPiece& p = pieces[n];
            for (std::size_t a = 0; a < pieces.size() && !colon[n]; ++a) {
                for (std::size_t b = a + 1; b < pieces.size() && !colon[n]; ++b) {
                    if (!colon[a] || !colon[b]) continue;
                    const double across = gapMm(pieces[a], pieces[b]);
                    const double through = gapMm(pieces[a], p) + gapMm(p, pieces[b]) + p.lengthMm;
                    const bool island =
                        p.volumeMl() >= 1.0 && across < 120.0 && through < 1.5 * across + 15.0;
                    const bool segment = p.elongation() >= tubeElongation &&
                                         p.calibreMm() >= wideMm && gapMm(pieces[a], p) < 60.0 &&
                                         gapMm(p, pieces[b]) < 60.0 && across > 100.0;
                    if (island || segment) colon[n] = 1, changed = true;
                }
            }
        }
    }
    std::vector<int> selected;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
        if (colon[n]) selected.push_back(int(n));
    }
    std::stable_sort(selected.begin(), selected.end(),
                     [&](int a, int b) { return pieces[a].volumeMl() > pieces[b].volumeMl(); });
    return selected;
}

}  // namespace haustra::topology
