#include "segmentation/collapse_paths.h"

#include "core/parallel.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <queue>

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
    std::size_t index(glm::ivec3 c) const { return grid.index(c); }
};

CellGrid makeCellGrid(const Volume<std::int16_t>& hu, const BowelContents& contents,
                      const TubePieces& cut, const std::vector<std::int32_t>& nodeOf, int threads) {
    const Grid& fine = hu.grid();
    CellGrid cells;
    cells.block = glm::max(glm::ivec3(1), glm::ivec3(glm::round(pathCellMm / fine.spacingMm())));
    cells.grid.size = (fine.size + cells.block - 1) / cells.block;
    cells.grid.patientFromVoxel = fine.patientFromVoxel;
    for (int axis = 0; axis < 3; ++axis)
        cells.grid.patientFromVoxel[axis] *= double(cells.block[axis]);
    cells.grid.patientFromVoxel[3] =
        glm::dvec4(fine.patientFromVoxelPoint(0.5 * glm::dvec3(cells.block - 1)), 1.0);
    const std::size_t count = cells.grid.voxelCount();
    cells.costPerMm.assign(count, blocked);
    cells.node.assign(count, -1);
    Volume<std::uint8_t> soft(cells.grid, std::uint8_t(0));
    const auto softOut = soft.writable();
    parallelFor(
        std::size_t(cells.grid.size.z), 1, threads, [&](std::size_t first, std::size_t last) {
            for (std::size_t z = first; z < last; ++z) {
                for (int y = 0; y < cells.grid.size.y; ++y) {
                    for (int x = 0; x < cells.grid.size.x; ++x) {
                        const glm::ivec3 c(x, y, int(z));
                        const glm::ivec3 lo = c * cells.block,
                                         hi = glm::min(lo + cells.block, fine.size);
                        int voxels = 0, barred = 0, content = 0;
                        double sum = 0.0;
                        std::int32_t node = -1;
                        for (int k = lo.z; k < hi.z; ++k) {
                            for (int j = lo.y; j < hi.y; ++j) {
                                for (int i = lo.x; i < hi.x; ++i) {
                                    const std::size_t n = fine.index(i, j, k);
                                    ++voxels;
                                    const Content what = Content(contents.content[n]);
                                    if (what == Content::tissue) {
                                        sum += hu[n];
                                        continue;
                                    }
                                    const std::int32_t piece = cut.pieceAt[n];
                                    const std::int32_t of =
                                        piece >= 0 ? nodeOf[std::size_t(piece)] : -1;
                                    // Specks of gas or stool lie in collapsed bowel too.
                                    if (of >= 0)
                                        ++content, node = std::max(node, of);
                                    else if (what == Content::outside || what == Content::lung ||
                                             (piece >= 0 &&
                                              cut.pieces[std::size_t(piece)].volumeMl > 1.0))
                                        ++barred;
                                    else
                                        sum += 20.0;
                                }
                            }
                        }
                        const std::size_t at = cells.index(c);
                        const int tissue = voxels - barred - content;
                        if (2 * content >= voxels) cells.node[at] = node;
                        if (3 * (barred + content) > voxels || tissue == 0) continue;
                        const double mean = sum / tissue;
                        const double fat =
                            std::clamp((softFromHu - mean) / (softFromHu - fatHu), 0.0, 1.0);
                        cells.costPerMm[at] = float(1.0 + (fatCost - 1.0) * fat);
                        softOut[at] = fat < 0.5;
                    }
                }
            }
        });
    const Volume<float> depthMm = topology::distanceToBoundaryMm(soft, threads);
    // Between the axis of a closed colon and another lumen lie its own wall and the other's.
    const auto isBesideLumen = [&](glm::ivec3 c) {
        for (int s = 0; s < 27; ++s) {
            const glm::ivec3 by = c + cornerStep(s);
            if (cells.grid.contains(by) && cells.node[cells.index(by)] >= 0) return true;
        }
        return false;
    };
    parallelFor(count, 4096, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n) {
            if (cells.costPerMm[n] == blocked) continue;
            if (depthMm[n] > deepMm) cells.costPerMm[n] += float((depthMm[n] - deepMm) / deeperMm);
            if (isBesideLumen(cells.grid.voxelAt(n))) cells.costPerMm[n] += besideLumenCost;
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
            const std::uint32_t next = std::uint32_t(cells.index(c + step.by));
            if (cells.node[next] != node) continue;
            const float there = d + float(step.lengthMm);
            const auto [known, isNew] = distance.try_emplace(next, there);
            if (isNew || there < known->second) known->second = there, queue.emplace(there, next);
        }
    }
    return distance;
}

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

/// (1 − cos) of the angle between a direction and where a path goes in its first 15 mm.
double turnOf(const std::vector<glm::dvec3>& pathMm, glm::dvec3 outwards) {
    constexpr double chordMm = 15.0;
    if (outwards == glm::dvec3(0.0) || pathMm.size() < 2) return 0.5;
    std::size_t n = 1;
    while (n + 1 < pathMm.size() && glm::distance(pathMm[n], pathMm[0]) < chordMm)
        ++n;
    const glm::dvec3 chord = pathMm[n] - pathMm[0];
    return glm::length(chord) > 0.0 ? 1.0 - glm::dot(glm::normalize(chord), outwards) : 0.5;
}

}  // namespace

std::vector<CollapsePath> findCollapsePaths(const Volume<std::int16_t>& hu,
                                            const BowelContents& contents, const TubePieces& cut,
                                            const std::vector<std::int32_t>& candidates,
                                            const std::vector<std::vector<glm::ivec3>>& doors,
                                            const CollapseOptions& options) {
    // Islands in collapsed bowel are passed, not counted.
    constexpr double leastRadiusMm = 5.0, leastMl = 1.0;
    std::vector<std::int32_t> nodeOf(cut.pieces.size(), -1);
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        const TubePiece& piece = cut.pieces[std::size_t(candidates[n])];
        if (piece.radiusMm >= leastRadiusMm && piece.volumeMl >= leastMl)
            nodeOf[std::size_t(candidates[n])] = std::int32_t(n);
    }
    const CellGrid cells = makeCellGrid(hu, contents, cut, nodeOf, options.threads);
    std::vector<std::vector<std::uint32_t>> cellsOf(candidates.size());
    for (std::size_t n = 0; n < cells.node.size(); ++n) {
        if (cells.node[n] >= 0) cellsOf[std::size_t(cells.node[n])].push_back(std::uint32_t(n));
    }
    // Blind ends: farthest from the doors, or the two ends of what has none.
    std::vector<std::vector<Cap>> capsOf(candidates.size());
    const auto findCaps = [&](std::size_t n) {
        if (cellsOf[n].empty()) return;
        const double radiusMm = cut.pieces[std::size_t(candidates[n])].radiusMm;
        const auto nearestCell = [&](glm::ivec3 voxel) {
            const glm::dvec3 c = glm::dvec3(voxel) / glm::dvec3(cells.block);
            std::uint32_t best = cellsOf[n].front();
            double least = 1e30;
            for (const std::uint32_t at : cellsOf[n]) {
                const glm::dvec3 d = glm::dvec3(cells.grid.voxelAt(at)) + 0.5 - c;
                if (glm::dot(d, d) < least) least = glm::dot(d, d), best = at;
            }
            return best;
        };
        const auto farthest = [](const std::map<std::uint32_t, float>& distance) {
            std::pair<std::uint32_t, float> best{distance.begin()->first, -1.0f};
            for (const auto& [at, d] : distance) {
                if (d > best.second) best = {at, d};
            }
            return best;
        };
        const auto addCap = [&](const std::map<std::uint32_t, float>& distance) {
            const float most = farthest(distance).second;
            const float deepMm = float(std::max(radiusMm, 6.0));
            Cap cap{std::int32_t(n), {}, {}};
            std::vector<std::uint32_t> before;
            for (const auto& [at, d] : distance) {
                if (d >= most - deepMm)
                    cap.cells.push_back(at);
                else if (d >= most - 2.5f * deepMm)
                    before.push_back(at);
            }
            const glm::dvec3 axis =
                before.empty() ? glm::dvec3(0.0) : meanMm(cells, cap.cells) - meanMm(cells, before);
            if (glm::length(axis) > 0.0) cap.outwards = glm::normalize(axis);
            capsOf[n].push_back(std::move(cap));
        };
        std::vector<std::uint32_t> from;
        for (const glm::ivec3 door : doors[n])
            from.push_back(nearestCell(door));
        if (from.empty()) {
            const auto first =
                distancesWithin(cells, std::int32_t(n),
                                {nearestCell(cut.pieces[std::size_t(candidates[n])].centre)});
            const std::uint32_t one = farthest(first).first;
            const auto second = distancesWithin(cells, std::int32_t(n), {one});
            addCap(second);
            addCap(distancesWithin(cells, std::int32_t(n), {farthest(second).first}));
            return;
        }
        const auto distance = distancesWithin(cells, std::int32_t(n), from);
        if (farthest(distance).second > (from.size() > 1 ? 1.6 : 1.0) * radiusMm) addCap(distance);
    };
    parallelFor(candidates.size(), 1, options.threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t n = first; n < last; ++n)
            findCaps(n);
    });
    std::vector<Cap> caps;
    std::vector<std::int32_t> capAt(cells.node.size(), -1);
    for (auto& own : capsOf) {
        for (Cap& cap : own) {
            for (const std::uint32_t at : cap.cells)
                capAt[at] = std::int32_t(caps.size());
            caps.push_back(std::move(cap));
        }
    }

    const auto steps = stepsOf(cells.grid);
    std::vector<std::vector<CollapsePath>> found(caps.size());
    // A step costs at least a cell's size, so what lies in one bucket is final when its turn comes.
    const glm::dvec3 cellSizeMm = cells.grid.spacingMm();
    const float bucketMm = 0.5f * float(std::min({cellSizeMm.x, cellSizeMm.y, cellSizeMm.z}));
    const auto bucketOf = [&](float costMm) { return std::size_t(costMm / bucketMm); };
    const std::size_t grain = std::max<std::size_t>(1, caps.size() / 16);
    parallelFor(caps.size(), grain, options.threads, [&](std::size_t first, std::size_t last) {
        std::vector<std::vector<std::pair<float, std::uint32_t>>> buckets(
            bucketOf(float(options.mostCostMm)) + 1);
        std::vector<float> cost(cells.node.size(), blocked);
        std::vector<std::uint8_t> from(cells.node.size(), 255);
        for (std::size_t c = first; c < last; ++c) {
            std::vector<std::uint32_t> touched;
            std::map<std::int32_t, std::pair<float, std::uint32_t>> best[2];
            for (const std::uint32_t n : caps[c].cells)
                cost[n] = 0.0f, from[n] = 255, touched.push_back(n),
                buckets[0].emplace_back(0.0f, n);
            const auto leave = [&](float d, std::uint32_t n) {
                if (d > cost[n]) return;
                const std::int32_t at = cells.node[n];
                if (at >= 0 && at != caps[c].node) {
                    const auto [known, isNew] = best[capAt[n] >= 0 ? 1 : 0].try_emplace(at, d, n);
                    if (!isNew && std::pair(d, n) < known->second) known->second = {d, n};
                    return;  // no way on through another piece
                }
                if (at == caps[c].node && d > 0.0f) return;  // nor back
                const glm::ivec3 v = cells.grid.voxelAt(n);
                const float here = at >= 0 ? 1.0f : cells.costPerMm[n];
                for (std::size_t s = 0; s < steps.size(); ++s) {
                    if (!cells.grid.contains(v + steps[s].by)) continue;
                    const std::uint32_t next = std::uint32_t(cells.index(v + steps[s].by));
                    const float there = cells.node[next] >= 0 ? here : cells.costPerMm[next];
                    if (there == blocked) continue;
                    const float through = d + 0.5f * float(steps[s].lengthMm) * (here + there);
                    if (through > float(options.mostCostMm) || through >= cost[next]) continue;
                    if (cost[next] == blocked) touched.push_back(next);
                    cost[next] = through, from[next] = std::uint8_t(s);
                    buckets[bucketOf(through)].emplace_back(through, next);
                }
            };
            for (auto& bucket : buckets) {
                for (const auto& [d, n] : bucket)
                    leave(d, n);
                bucket.clear();
            }
            for (int tip = 0; tip < 2; ++tip) {
                std::vector<std::pair<std::int32_t, std::pair<float, std::uint32_t>>> ends(
                    best[tip].begin(), best[tip].end());
                std::stable_sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) {
                    return a.second.first < b.second.first;
                });
                ends.resize(std::min<std::size_t>(ends.size(), tip == 1 ? 40 : 4));
                for (const auto& [node, end] : ends) {
                    CollapsePath path{candidates[std::size_t(caps[c].node)],
                                      candidates[std::size_t(node)],
                                      end.first,
                                      0.0,
                                      tip == 1,
                                      0.0,
                                      {}};
                    for (std::uint32_t n = end.second;;) {
                        path.pointsMm.push_back(
                            cells.grid.patientFromVoxelPoint(cells.grid.voxelAt(n)));
                        if (from[n] == 255) break;
                        n = std::uint32_t(cells.index(cells.grid.voxelAt(n) - steps[from[n]].by));
                    }
                    std::reverse(path.pointsMm.begin(), path.pointsMm.end());
                    for (std::size_t p = 1; p < path.pointsMm.size(); ++p)
                        path.lengthMm += glm::distance(path.pointsMm[p], path.pointsMm[p - 1]);
                    path.turn = turnOf(path.pointsMm, caps[c].outwards);
                    if (tip == 1) {
                        const std::vector<glm::dvec3> back(path.pointsMm.rbegin(),
                                                           path.pointsMm.rend());
                        path.turn += turnOf(back, caps[std::size_t(capAt[end.second])].outwards);
                    } else {
                        path.turn += 1.0;
                    }
                    found[c].push_back(std::move(path));
                }
            }
            for (const std::uint32_t n : touched)
                cost[n] = blocked, from[n] = 255;
        }
    });
    // Of each pair the cheapest to a tip and the cheapest to a side.
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

}  // namespace haustra::segmentation
