#include "segmentation/collapse_paths.h"

#include "core/voxel_sweep.h"
#include "segmentation/working_scan.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <queue>
#include <tuple>

namespace haustra::segmentation {
namespace {

constexpr double pathCellMm = 2.5;
constexpr double fatCost = 6.0, softFromHu = -30.0, fatHu = -70.0;
constexpr double deepMm = 10.0, deeperMm = 5.0;
constexpr float besideLumenCost = 1.0f;
constexpr float blocked = std::numeric_limits<float>::infinity();

/// The scan in cells of about 2.5 mm.
struct CellGrid {
    Grid grid;
    glm::ivec3 block{1};
    std::vector<float> costPerMm;    ///< infinite: no way
    std::vector<std::int32_t> node;  ///< candidate that fills most of the cell's contents, or −1
};

/// What lies in one cell.
struct CellContents {
    int voxels = 0;
    int barred = 0;         ///< voxels through which no bowel goes
    int content = 0;        ///< voxels of candidates
    double tissueHu = 0.0;  ///< sum over the other voxels
    std::int32_t node = -1;

    int tissue() const { return voxels - barred - content; }
    /// Infinite where there is no way.
    float costPerMm() const {
        if (3 * (barred + content) > voxels || tissue() == 0) return blocked;
        return float(1.0 + (fatCost - 1.0) * fatShare());
    }
    double fatShare() const {
        return std::clamp((softFromHu - tissueHu / tissue()) / (softFromHu - fatHu), 0.0, 1.0);
    }
};

/// The scan as the cells are made from it.
struct PiecesOfScan {
    const Volume<std::int16_t>& hu;
    const Volume<std::uint8_t>& content;
    const TubePieces& cut;
    const std::vector<std::int32_t>& nodeOf;  ///< of each piece

    void add(std::size_t n, CellContents& cell) const {
        ++cell.voxels;
        const Content what = Content(content[n]);
        if (what == Content::tissue) {
            cell.tissueHu += hu[n];
            return;
        }
        const std::int32_t piece = cut.pieceAt[n];
        const std::int32_t node = piece >= 0 ? nodeOf[std::size_t(piece)] : -1;
        // Specks of gas or stool lie in collapsed bowel too.
        if (node >= 0)
            ++cell.content, cell.node = std::max(cell.node, node);
        else if (what == Content::outside || what == Content::lung || what == Content::beyond ||
                 (piece >= 0 && cut.pieces[std::size_t(piece)].volumeMl > 1.0))
            ++cell.barred;
        else
            cell.tissueHu += 20.0;
    }

    CellContents cell(glm::ivec3 lo, glm::ivec3 hi) const {
        CellContents cell;
        visitBox(lo, hi - 1, [&](glm::ivec3 v) { add(hu.grid().index(v), cell); });
        return cell;
    }
};

/// Sets the cells' nodes and what a way through them costs by what they hold;
/// returns the cells that are mostly soft tissue.
Volume<std::uint8_t> fillCells(const PiecesOfScan& scan, CellGrid& cells, int threads) {
    Volume<std::uint8_t> soft(cells.grid, std::uint8_t(0));
    const auto softOut = soft.writable();
    forVoxels(cells.grid, threads, [&](std::size_t at, glm::ivec3 c) {
        const glm::ivec3 lo = c * cells.block, hi = glm::min(lo + cells.block, scan.hu.grid().size);
        const CellContents cell = scan.cell(lo, hi);
        if (2 * cell.content >= cell.voxels) cells.node[at] = cell.node;
        cells.costPerMm[at] = cell.costPerMm();
        softOut[at] = cells.costPerMm[at] != blocked && cell.fatShare() < 0.5;
    });
    return soft;
}

CellGrid makeCellGrid(const PiecesOfScan& scan, int threads) {
    const Grid& fine = scan.hu.grid();
    CellGrid cells;
    cells.block = glm::max(glm::ivec3(1), glm::ivec3(glm::round(pathCellMm / fine.spacingMm())));
    cells.grid = binned(fine, cells.block);
    const std::size_t count = cells.grid.voxelCount();
    cells.costPerMm.assign(count, blocked);
    cells.node.assign(count, -1);
    const Volume<float> depthMm =
        topology::distanceToBoundaryMm(fillCells(scan, cells, threads), threads);
    parallelFor(count, 4096, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            if (cells.costPerMm[n] == blocked) continue;
            if (depthMm[n] > deepMm) cells.costPerMm[n] += float((depthMm[n] - deepMm) / deeperMm);
            // Between the axis of a closed colon and another lumen lie its own wall
            // and the other's.
            bool besideLumen = cells.node[n] >= 0;
            visitCorners(cells.grid, n,
                         [&](std::size_t by) { besideLumen = besideLumen || cells.node[by] >= 0; });
            if (besideLumen) cells.costPerMm[n] += besideLumenCost;
        }
    });
    return cells;
}

struct Step {
    glm::ivec3 by;
    double lengthMm;
};
std::array<Step, 26> stepsOf(const Grid& grid) {
    std::array<Step, 26> steps;
    std::size_t count = 0;
    for (int n = 0; n < 27; ++n) {
        if (n == 13) continue;
        const glm::ivec3 by = cornerStep(n);
        steps[count++] = {by, glm::length(grid.spacingMm() * glm::dvec3(by))};
    }
    return steps;
}

using Queue = std::priority_queue<std::pair<float, std::uint32_t>,
                                  std::vector<std::pair<float, std::uint32_t>>, std::greater<>>;

/// Way lengths within a node's cells from some of them.
std::map<std::uint32_t, float> distancesWithin(const CellGrid& cells, std::int32_t node,
                                               const std::vector<std::uint32_t>& from) {
    const auto steps = stepsOf(cells.grid);
    std::map<std::uint32_t, float> distance;
    Queue queue;
    for (const std::uint32_t n : from)
        distance[n] = 0.0f, queue.emplace(0.0f, n);
    while (!queue.empty()) {
        const auto [d, n] = queue.top();
        queue.pop();
        if (d > distance[n]) continue;
        const glm::ivec3 c = cells.grid.voxelAt(n);
        for (const Step& step : steps) {
            if (!cells.grid.contains(c + step.by)) continue;
            const std::uint32_t next = std::uint32_t(cells.grid.index(c + step.by));
            if (cells.node[next] != node) continue;
            const float there = d + float(step.lengthMm);
            const auto [known, isNew] = distance.try_emplace(next, there);
            if (isNew || there < known->second) known->second = there, queue.emplace(there, next);
        }
    }
    return distance;
}

/// Where a piece ends blindly.
struct Cap {
    std::int32_t node;
    std::vector<std::uint32_t> cells;  ///< the last stretch before the tip
    glm::dvec3 outwards{0.0};  ///< unit, mm: along the bowel's axis; zero where it is not known
};

glm::dvec3 meanMm(const CellGrid& cells, const std::vector<std::uint32_t>& of) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t n : of)
        sum += cells.grid.patientFromVoxelPoint(cells.grid.voxelAt(n));
    return sum / double(std::max<std::size_t>(1, of.size()));
}

/// (1 − cos) of the angle between a direction and where a path goes in its
/// first 15 mm.
double turnOf(const std::vector<glm::dvec3>& pathMm, glm::dvec3 outwards) {
    constexpr double chordMm = 15.0;
    if (outwards == glm::dvec3(0.0) || pathMm.size() < 2) return 0.5;
    std::size_t n = 1;
    while (n + 1 < pathMm.size() && glm::distance(pathMm[n], pathMm[0]) < chordMm)
        ++n;
    const glm::dvec3 chord = pathMm[n] - pathMm[0];
    return glm::length(chord) > 0.0 ? 1.0 - glm::dot(glm::normalize(chord), outwards) : 0.5;
}

std::pair<std::uint32_t, float> farthest(const std::map<std::uint32_t, float>& distance) {
    std::pair<std::uint32_t, float> best{distance.begin()->first, -1.0f};
    for (const auto& [at, d] : distance) {
        if (d > best.second) best = {at, d};
    }
    return best;
}

/// The blind ends of one node: farthest from its doors, or the two ends of what
/// has none.
class NodeCaps {
public:
    NodeCaps(const CellGrid& cells, std::int32_t node, const std::vector<std::uint32_t>& own,
             double radiusMm)
        : cells_(cells), node_(node), own_(own), radiusMm_(radiusMm) {}

    std::vector<Cap> find(const std::vector<glm::ivec3>& doors, glm::ivec3 center) const {
        std::vector<std::uint32_t> from;
        for (const glm::ivec3 door : doors)
            from.push_back(nearestCell(door));
        if (from.empty()) {
            const auto first = distances({nearestCell(center)});
            const auto second = distances({farthest(first).first});
            return {capOf(second), capOf(distances({farthest(second).first}))};
        }
        const auto distance = distances(from);
        if (farthest(distance).second > (from.size() > 1 ? 1.6 : 1.0) * radiusMm_)
            return {capOf(distance)};
        return {};
    }

private:
    std::map<std::uint32_t, float> distances(const std::vector<std::uint32_t>& from) const {
        return distancesWithin(cells_, node_, from);
    }

    std::uint32_t nearestCell(glm::ivec3 voxel) const {
        const glm::dvec3 c = glm::dvec3(voxel) / glm::dvec3(cells_.block);
        std::uint32_t best = own_.front();
        double least = 1e30;
        for (const std::uint32_t at : own_) {
            const glm::dvec3 d = glm::dvec3(cells_.grid.voxelAt(at)) + 0.5 - c;
            if (glm::dot(d, d) < least) least = glm::dot(d, d), best = at;
        }
        return best;
    }

    Cap capOf(const std::map<std::uint32_t, float>& distance) const {
        const float most = farthest(distance).second;
        const float lengthMm = float(std::max(radiusMm_, 6.0));
        Cap cap{node_, {}, {}};
        std::vector<std::uint32_t> before;
        for (const auto& [at, d] : distance) {
            if (d >= most - lengthMm)
                cap.cells.push_back(at);
            else if (d >= most - 2.5f * lengthMm)
                before.push_back(at);
        }
        const glm::dvec3 axis =
            before.empty() ? glm::dvec3(0.0) : meanMm(cells_, cap.cells) - meanMm(cells_, before);
        if (glm::length(axis) > 0.0) cap.outwards = glm::normalize(axis);
        return cap;
    }

    const CellGrid& cells_;
    const std::int32_t node_;
    const std::vector<std::uint32_t>& own_;
    const double radiusMm_;
};

/// Blind ends of all nodes, in order.
std::vector<Cap> findCaps(const CellGrid& cells, const TubePieces& cut,
                          const std::vector<std::int32_t>& candidates,
                          const std::vector<std::vector<glm::ivec3>>& doors, int threads) {
    std::vector<std::vector<std::uint32_t>> cellsOf(candidates.size());
    for (std::size_t n = 0; n < cells.node.size(); ++n) {
        if (cells.node[n] >= 0) cellsOf[std::size_t(cells.node[n])].push_back(std::uint32_t(n));
    }
    std::vector<std::vector<Cap>> capsOf(candidates.size());
    parallelFor(candidates.size(), 1, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            if (cellsOf[n].empty()) continue;
            const TubePiece& piece = cut.pieces[std::size_t(candidates[n])];
            capsOf[n] = NodeCaps(cells, std::int32_t(n), cellsOf[n], piece.radiusMm)
                            .find(doors[n], piece.center);
        }
    });
    std::vector<Cap> caps;
    for (auto& own : capsOf)
        std::move(own.begin(), own.end(), std::back_inserter(caps));
    return caps;
}

/// The cheapest ways from a cap to the other nodes. Its arrays are large: one
/// search serves many caps, one after another.
class PathSearch {
public:
    /// `capAt` has the cap of each cell, or −1.
    PathSearch(const CellGrid& cells, const std::vector<Cap>& caps,
               const std::vector<std::int32_t>& capAt, double mostCostMm)
        : cells_(cells),
          caps_(caps),
          capAt_(capAt),
          mostCostMm_(float(mostCostMm)),
          steps_(stepsOf(cells.grid)),
          cost_(cells.node.size(), blocked),
          cameBy_(cells.node.size(), noStep) {
        // A step costs at least a cell's size, so what lies in one bucket is final
        // when its turn comes.
        const glm::dvec3 sizeMm = cells.grid.spacingMm();
        bucketMm_ = 0.5f * float(std::min({sizeMm.x, sizeMm.y, sizeMm.z}));
        buckets_.resize(bucketOf(mostCostMm_) + 1);
    }

    std::vector<CollapsePath> from(const Cap& cap, const std::vector<std::int32_t>& candidates) {
        spread(cap);
        std::vector<CollapsePath> paths;
        for (const bool toTip : {false, true}) {
            std::vector<std::pair<std::int32_t, End>> ends(ends_[toTip].begin(),
                                                           ends_[toTip].end());
            std::stable_sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) {
                return a.second.first < b.second.first;
            });
            ends.resize(std::min<std::size_t>(ends.size(), toTip ? 40 : 4));
            for (const auto& [node, end] : ends) {
                CollapsePath path = pathTo(end, cap, toTip);
                path.from = candidates[std::size_t(cap.node)];
                path.to = candidates[std::size_t(node)];
                paths.push_back(std::move(path));
            }
        }
        forget();
        return paths;
    }

private:
    static constexpr std::uint8_t noStep = 255;
    using End = std::pair<float, std::uint32_t>;  ///< cost, cell

    std::size_t bucketOf(float costMm) const { return std::size_t(costMm / bucketMm_); }

    void spread(const Cap& cap) {
        for (const std::uint32_t n : cap.cells) {
            cost_[n] = 0.0f, cameBy_[n] = noStep, touched_.push_back(n);
            buckets_[0].emplace_back(0.0f, n);
        }
        for (auto& bucket : buckets_) {
            for (const auto& [d, n] : bucket)
                leave(d, n, cap.node);
            bucket.clear();
        }
    }

    /// Goes on from a cell to those around it.
    void leave(float d, std::uint32_t n, std::int32_t ownNode) {
        if (d > cost_[n]) return;
        const std::int32_t at = cells_.node[n];
        if (at >= 0 && at != ownNode) {
            const auto [known, isNew] = ends_[capAt_[n] >= 0].try_emplace(at, d, n);
            if (!isNew && End(d, n) < known->second) known->second = {d, n};
            return;  // no way on through another piece
        }
        if (at == ownNode && d > 0.0f) return;  // nor back
        const glm::ivec3 v = cells_.grid.voxelAt(n);
        const float here = at >= 0 ? 1.0f : cells_.costPerMm[n];
        // By pointers: the loop runs 26 times for each cell, and checked indices would make the
        // search take 40 % longer.
        const std::int32_t* const node = cells_.node.data();
        const float* const costPerMm = cells_.costPerMm.data();
        float* const cost = cost_.data();
        std::uint8_t* const cameBy = cameBy_.data();
        for (std::size_t s = 0; s < steps_.size(); ++s) {
            if (!cells_.grid.contains(v + steps_[s].by)) continue;
            const std::uint32_t next = std::uint32_t(cells_.grid.index(v + steps_[s].by));
            const float there = node[next] >= 0 ? here : costPerMm[next];
            if (there == blocked) continue;
            const float through = d + 0.5f * float(steps_[s].lengthMm) * (here + there);
            if (through > mostCostMm_ || through >= cost[next]) continue;
            if (cost[next] == blocked) touched_.push_back(next);
            cost[next] = through, cameBy[next] = std::uint8_t(s);
            buckets_[bucketOf(through)].emplace_back(through, next);
        }
    }

    CollapsePath pathTo(const End& end, const Cap& cap, bool toTip) const {
        CollapsePath path;
        path.costMm = end.first, path.toTip = toTip;
        for (std::uint32_t n = end.second;;) {
            const glm::ivec3 v = cells_.grid.voxelAt(n);
            path.pointsMm.push_back(cells_.grid.patientFromVoxelPoint(v));
            if (cameBy_[n] == noStep) break;
            n = std::uint32_t(cells_.grid.index(v - steps_[cameBy_[n]].by));
        }
        std::reverse(path.pointsMm.begin(), path.pointsMm.end());
        for (std::size_t p = 1; p < path.pointsMm.size(); ++p)
            path.lengthMm += glm::distance(path.pointsMm[p], path.pointsMm[p - 1]);
        path.turn = turnOf(path.pointsMm, cap.outwards);
        if (toTip) {
            const std::vector<glm::dvec3> back(path.pointsMm.rbegin(), path.pointsMm.rend());
            path.turn += turnOf(back, caps_[std::size_t(capAt_[end.second])].outwards);
        } else {
            path.turn += 1.0;
        }
        return path;
    }

    void forget() {
        for (const std::uint32_t n : touched_)
            cost_[n] = blocked, cameBy_[n] = noStep;
        touched_.clear();
        for (auto& ends : ends_)
            ends.clear();
    }

    const CellGrid& cells_;
    const std::vector<Cap>& caps_;
    const std::vector<std::int32_t>& capAt_;
    const float mostCostMm_;
    const std::array<Step, 26> steps_;
    float bucketMm_ = 0.0f;
    std::vector<std::vector<std::pair<float, std::uint32_t>>> buckets_;  ///< of cells by cost
    std::vector<float> cost_;
    std::vector<std::uint8_t> cameBy_;  ///< the step that led to each cell
    std::vector<std::uint32_t> touched_;
    std::map<std::int32_t, End> ends_[2];  ///< of each node reached: at a side, at a tip
};

/// Of each pair the cheapest to a tip and the cheapest to a side.
std::vector<CollapsePath> cheapestOf(std::vector<std::vector<CollapsePath>> found) {
    std::map<std::tuple<std::int32_t, std::int32_t, bool>, CollapsePath> cheapest;
    for (auto& paths : found) {
        for (CollapsePath& path : paths) {
            const auto key = path.toTip ? std::tuple(std::min(path.from, path.to),
                                                     std::max(path.from, path.to), true)
                                        : std::tuple(path.from, path.to, false);
            const auto known = cheapest.find(key);
            if (known == cheapest.end())
                cheapest.emplace(key, std::move(path));
            else if (path.costMm < known->second.costMm)
                known->second = std::move(path);
        }
    }
    std::vector<CollapsePath> all;
    for (auto& [key, path] : cheapest)
        all.push_back(std::move(path));
    return all;
}

/// The node of each piece: its number among the candidates. Islands in
/// collapsed bowel are passed, not counted.
std::vector<std::int32_t> nodesOf(const TubePieces& cut,
                                  const std::vector<std::int32_t>& candidates) {
    constexpr double leastRadiusMm = 5.0, leastMl = 1.0;
    std::vector<std::int32_t> nodeOf(cut.pieces.size(), -1);
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        const TubePiece& piece = cut.pieces[std::size_t(candidates[n])];
        if (piece.radiusMm >= leastRadiusMm && piece.volumeMl >= leastMl)
            nodeOf[std::size_t(candidates[n])] = std::int32_t(n);
    }
    return nodeOf;
}

}  // namespace

std::vector<CollapsePath> findCollapsePaths(const Volume<std::int16_t>& hu,
                                            const BowelContents& contents, const TubePieces& cut,
                                            const std::vector<std::int32_t>& candidates,
                                            const std::vector<std::vector<glm::ivec3>>& doors,
                                            const CollapseOptions& options) {
    const std::vector<std::int32_t> nodeOf = nodesOf(cut, candidates);
    const CellGrid cells = makeCellGrid({hu, contents.content, cut, nodeOf}, options.threads);
    const std::vector<Cap> caps = findCaps(cells, cut, candidates, doors, options.threads);
    std::vector<std::int32_t> capAt(cells.node.size(), -1);
    for (std::size_t c = 0; c < caps.size(); ++c) {
        for (const std::uint32_t at : caps[c].cells)
            capAt[at] = std::int32_t(c);
    }
    std::vector<std::vector<CollapsePath>> found(caps.size());
    const std::size_t grain = std::max<std::size_t>(1, caps.size() / 16);
    parallelFor(caps.size(), grain, options.threads, [&](std::size_t first, std::size_t last) {
        PathSearch search(cells, caps, capAt, options.mostCostMm);
        for (std::size_t c = first; c < last; ++c)
            found[c] = search.from(caps[c], candidates);
    });
    return cheapestOf(std::move(found));
}

}  // namespace haustra::segmentation
