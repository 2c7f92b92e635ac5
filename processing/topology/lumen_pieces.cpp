#include "topology/lumen_pieces.h"

#include "centerline/graph.h"
#include "centerline/order.h"
#include "centerline/search.h"
#include "centerline/segments.h"
#include "core/flood_fill.h"
#include "core/parallel.h"
#include "core/printed_text.h"
#include "core/voxel_sweep.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace haustra::topology {
namespace {

constexpr std::size_t mostPieces = 12;  // that orderSegments takes

using Path = std::vector<glm::ivec3>;

void setRun(BitMask& mask, const MaskRun& run) {
    for (int i = run.begin; i < run.end; ++i)
        mask.set({i, run.j, run.k});
}

/// The large pieces of a mask, each a mask of its own, the largest first.
std::vector<BitMask> largePieces(const BitMask& mask, const Grid& grid, double smallestMl,
                                 std::vector<std::string>& notes) {
    const MaskComponents all = objectComponents(mask);
    std::vector<std::int32_t> bySize(all.voxels.size());
    std::iota(bySize.begin(), bySize.end(), 0);
    const auto voxels = [&](std::int32_t c) { return all.voxels[std::size_t(c)]; };
    std::stable_sort(bySize.begin(), bySize.end(),
                     [&](std::int32_t a, std::int32_t b) { return voxels(a) > voxels(b); });
    const double voxelMl = grid.voxelVolumeMm3() / 1000.0;
    std::vector<std::int32_t> pieceOf(all.voxels.size(), -1);
    std::size_t kept = 0;
    double leftOutMl = 0.0;
    for (const std::int32_t c : bySize) {
        const double volumeMl = double(voxels(c)) * voxelMl;
        if (kept == 0 || (volumeMl >= smallestMl && kept < mostPieces))
            pieceOf[std::size_t(c)] = std::int32_t(kept++);
        else
            leftOutMl += volumeMl;
    }
    if (kept < bySize.size()) {
        notes.push_back(printed(
            "%.0f pieces of the lumen left out, %s, %.2f ml in all", double(bySize.size() - kept),
            kept == mostPieces ? "all but the largest" : "which are small", leftOutMl));
    }
    std::vector<BitMask> pieces(kept, BitMask(mask.size()));
    for (const MaskRun& run : all.runs) {
        if (const std::int32_t piece = pieceOf[std::size_t(run.component)]; piece >= 0)
            setRun(pieces[std::size_t(piece)], run);
    }
    return pieces;
}

/// Ties or fills the domain's islands; path, bridges and the sure way stay.
void settleIslands(JoinedLumen& joined, const Grid& grid, const LumenJoinOptions& options) {
    BitMask kept = joined.bridges;
    if (options.sureWay) kept.add(*options.sureWay);
    for (const glm::ivec3 v : joined.path)
        kept.set(v);
    Islands islands = tieOrFillIslands(joined.domain, kept, grid, options.traces);
    joined.cavitiesFilled = islands.filled, joined.islandsTied = islands.tied;
    joined.notes.insert(joined.notes.end(), islands.notes.begin(), islands.notes.end());
}

Volume<std::uint8_t> labelsOf(const BitMask& mask, const Grid& grid, int threads) {
    Volume<std::uint8_t> labels(grid);
    parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (int k = int(begin); k < int(end); ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                std::uint8_t* row = labels.writable().data() + grid.index(0, j, k);
                const std::uint64_t* bits = mask.row(j, k);
                for (int i = 0; i < grid.size.x; ++i)
                    row[i] = bits[std::size_t(i + 1) / 64] >> ((i + 1) % 64) & 1u;
            }
        }
    });
    return labels;
}

/// distanceToBoundaryMm of a piece; voxels of the sure way are the deepest, and what tapers towards
/// it, within 8 mm from face to face, is 4 mm deep at least.
Volume<float> depthOf(const Volume<std::uint8_t>& labels, const LumenJoinOptions& options) {
    constexpr float taperReachMm = 8.0f, taperMm = 4.0f;
    Volume<float> mm = distanceToBoundaryMm(labels, options.threads);
    if (!options.sureWay) return mm;
    const auto out = mm.writable();
    const float deepest = *std::max_element(out.begin(), out.end());
    const Grid& grid = labels.grid();
    std::vector<std::pair<std::uint32_t, float>> front;  // voxel, way from the sure one
    std::vector<bool> seen(out.size(), false);
    for (std::size_t n = 0; n < out.size(); ++n) {
        if (labels[n] == 0 || !options.sureWay->test(grid.voxelAt(n))) continue;
        out[n] = deepest, seen[n] = true;
        front.emplace_back(std::uint32_t(n), 0.0f);
    }
    const auto neighbours = [&](std::pair<std::uint32_t, float> from, const auto& visit) {
        visitFaces(grid, from.first, [&](std::size_t m, int axis) {
            visit(std::pair(std::uint32_t(m), from.second + float(grid.spacingMm()[axis])));
        });
    };
    floodFill(front, neighbours, [&](std::pair<std::uint32_t, float> next) {
        const auto [m, wayMm] = next;
        if (labels[m] == 0 || seen[m] || wayMm > taperReachMm) return false;
        out[m] = std::max(out[m], std::min(taperMm, deepest)), seen[m] = true;
        return true;
    });
    return mm;
}

/// Appends a 6-connected way from the path's last voxel to `target` within the two voxels' blocks
/// and the mask; where there is none, `target` alone.
void connect(Path& path, glm::ivec3 target, const BitMask& mask,
             const centerline::BlockGraph& graph) {
    constexpr int reach = 4;
    const glm::ivec3 source = path.back(), one = graph.blockAt(source),
                     other = graph.blockAt(target);
    // On the grid or one voxel before or behind, as far as a mask can be asked.
    const glm::ivec3 lo = graph.childVoxel(glm::min(one, other), 0);
    const glm::ivec3 hi = graph.childVoxel(glm::max(one, other), 7);
    const auto place = [&](glm::ivec3 v) {
        const glm::ivec3 d = v - lo;
        return std::size_t(d.x + reach * (d.y + reach * d.z));
    };
    std::array<std::int8_t, std::size_t(reach * reach * reach)> cameBy;
    cameBy.fill(-1);
    // From the target back, so that the way can be read off in order.
    std::vector<glm::ivec3> front{target};
    const auto step = [](int n) {
        glm::ivec3 s(0);
        s[n / 2] = n % 2 == 0 ? 1 : -1;
        return s;
    };
    cameBy[place(target)] = 6;
    const auto stepsBack = [&](glm::ivec3 from, const auto& visit) {
        for (int n = 0; n < 6; ++n)
            visit(from - step(n), n);
    };
    floodFill(front, stepsBack, [&](glm::ivec3 next, int n) {
        if (glm::any(glm::lessThan(next, lo)) || glm::any(glm::greaterThan(next, hi)) ||
            cameBy[place(next)] >= 0 || !mask.test(next))
            return false;
        cameBy[place(next)] = std::int8_t(n);
        return true;
    });
    if (cameBy[place(source)] < 0)
        path.push_back(target);
    else
        for (glm::ivec3 at = source; at != target;)
            path.push_back(at += step(cameBy[place(at)]));
}

/// The widest way between two nodes of a piece far apart: for a seed any such way will do; a bridge
/// has to begin at the very tip.
enum class SkeletonEnds { anywhere, tips };

Path skeletonOf(const BitMask& piece, const Volume<std::uint8_t>& labels,
                const Volume<float>& distanceMm, SkeletonEnds ends, int threads) {
    const centerline::BlockGraph graph = centerline::makeBlockGraph(labels, distanceMm, threads);
    std::vector<std::int32_t> route;
    if (ends == SkeletonEnds::tips) {
        std::vector<std::string> notes;  // a piece is one segment: there are none
        route = segmentsToVisit(graph, {}, centerline::EndRule::farthest, notes).front().route;
    } else {
        centerline::PathTree tree = growWidestTree(graph, graph.components.front().deepest);
        const std::int32_t oneEnd = longestPathEnd(tree);
        tree = rerooted(std::move(tree), oneEnd);
        route = pathTo(tree, longestPathEnd(tree));
    }
    Path path{graph.voxelOf(route.front())};
    for (const std::int32_t node : route)
        connect(path, graph.voxelOf(node), piece, graph);
    return path;
}

/// Sets the voxels within `radiusMm` of the straight line between two voxels, and appends to `path`
/// a 6-connected way along it.
void layBridge(BitMask& bridge, Path& path, glm::ivec3 from, glm::ivec3 to, const Grid& grid,
               double radiusMm) {
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::dvec3 a(from), d(to - from);
    const glm::ivec3 reach = glm::ivec3(radiusMm / spacing) + 1;
    const glm::ivec3 lo = glm::max(glm::min(from, to) - reach, glm::ivec3(0));
    const glm::ivec3 hi = glm::min(glm::max(from, to) + reach, grid.size - 1);
    const double squaredMm = std::max(1e-9, glm::dot(spacing * d, spacing * d));
    visitBox(lo, hi, [&](glm::ivec3 v) {
        const glm::dvec3 p = spacing * (glm::dvec3(v) - a);
        const double t = std::clamp(glm::dot(p, spacing * d) / squaredMm, 0.0, 1.0);
        if (glm::distance(p, t * spacing * d) <= radiusMm) bridge.set(v);
    });
    // One axis at a time: the one that lags most behind the line.
    for (glm::ivec3 at = from; at != to;) {
        int axis = 0;
        double most = -1.0;
        for (int n = 0; n < 3; ++n) {
            const double left = std::abs(double(to[n] - at[n])) / std::max(1.0, std::abs(d[n]));
            if (at[n] != to[n] && left > most) most = left, axis = n;
        }
        at[axis] += to[axis] > at[axis] ? 1 : -1;
        path.push_back(at);
        bridge.set(at);
    }
}

double lengthMm(const Path& path, glm::dvec3 spacing) {
    double sum = 0.0;
    for (std::size_t n = 1; n < path.size(); ++n)
        sum += glm::length(spacing * glm::dvec3(path[n] - path[n - 1]));
    return sum;
}

/// The pieces' paths in the order of travel, each in its direction; those left out go to `notes`.
std::vector<std::size_t> orderPaths(std::vector<Path>& paths, const Grid& grid,
                                    std::vector<std::string>& notes) {
    std::vector<centerline::SegmentEnds> ends;
    glm::dvec3 lo(1e30), hi(-1e30);
    for (const Path& path : paths) {
        for (const glm::ivec3 v : path) {
            lo = glm::min(lo, grid.patientFromVoxelPoint(v));
            hi = glm::max(hi, grid.patientFromVoxelPoint(v));
        }
        ends.push_back({grid.patientFromVoxelPoint(path.front()),
                        grid.patientFromVoxelPoint(path.back()), lengthMm(path, grid.spacingMm())});
    }
    std::vector<std::size_t> order;
    for (const centerline::SegmentVisit visit : orderSegments(ends, 0.5 * (lo + hi))) {
        order.push_back(visit.segment);
        if (visit.reversed) std::reverse(paths[visit.segment].begin(), paths[visit.segment].end());
    }
    for (std::size_t n = 0; n < paths.size(); ++n) {
        if (std::find(order.begin(), order.end(), n) != order.end()) continue;
        const glm::dvec3 at = 0.5 * (ends[n].firstMm + ends[n].lastMm);
        notes.push_back(printed(
            "a piece of %.0f mm at (%.0f, %.0f, %.0f) mm lies too far off the way: left out",
            ends[n].lengthMm, at.x, at.y, at.z));
    }
    return order;
}

}  // namespace

JoinedLumen joinPieces(const BitMask& mask, const Grid& grid, const LumenJoinOptions& options) {
    JoinedLumen joined(mask.size());
    std::vector<BitMask> pieces = largePieces(mask, grid, options.smallestPieceMl, joined.notes);
    if (pieces.size() == 1) {
        joined.domain = std::move(pieces.front());
        settleIslands(joined, grid, options);
        const Volume<std::uint8_t> labels = labelsOf(joined.domain, grid, options.threads);
        joined.distanceMm = depthOf(labels, options);
        joined.path = skeletonOf(joined.domain, labels, joined.distanceMm, SkeletonEnds::anywhere,
                                 options.threads);
        return joined;
    }
    std::vector<Path> paths;
    for (const BitMask& piece : pieces) {
        const Volume<std::uint8_t> labels = labelsOf(piece, grid, options.threads);
        paths.push_back(skeletonOf(piece, labels, depthOf(labels, options), SkeletonEnds::tips,
                                   options.threads));
    }
    for (const std::size_t n : orderPaths(paths, grid, joined.notes)) {
        joined.domain.add(pieces[n]);
        if (!joined.path.empty()) {
            const glm::ivec3 from = joined.path.back(), to = paths[n].front();
            layBridge(joined.bridges, joined.path, from, to, grid, bridgeRadiusMm);
            const glm::dvec3 at = grid.patientFromVoxelPoint(0.5 * glm::dvec3(from + to));
            joined.notes.push_back(
                printed("a bridge of %.0f mm joins two pieces at (%.0f, %.0f, %.0f) mm",
                        glm::length(grid.spacingMm() * glm::dvec3(to - from)), at.x, at.y, at.z));
        }
        joined.path.insert(joined.path.end(), paths[n].begin(), paths[n].end());
    }
    joined.bridges.remove(joined.domain);
    joined.domain.add(joined.bridges);
    settleIslands(joined, grid, options);
    joined.distanceMm = depthOf(labelsOf(joined.domain, grid, options.threads), options);
    return joined;
}

}  // namespace haustra::topology
