#include "core/connected_labels.h"

#include "core/disjoint_sets.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <unordered_map>
#include <vector>

namespace haustra {
namespace {

constexpr std::int32_t none = -1;

/// The 6-connected bodies of labels, numbered by their first voxels: runs along the rows, of which
/// there are far fewer than voxels.
class Bodies {
public:
    Bodies(const Grid& grid, std::span<const std::uint8_t> labels) : grid_(grid) {
        const std::size_t rows = std::size_t(grid.size.y) * std::size_t(grid.size.z),
                          length = std::size_t(grid.size.x);
        firstOfRow_.reserve(rows + 1);
        firstOfRow_.push_back(0);
        for (std::size_t row = 0; row < rows; ++row) {
            appendRuns(labels.subspan(row * length, length));
            firstOfRow_.push_back(std::uint32_t(runs_.size()));
            if (row % std::size_t(grid.size.y) != 0) uniteRows(row, row - 1);
            if (row >= std::size_t(grid.size.y)) uniteRows(row, row - std::size_t(grid.size.y));
        }
        // A run's body is from now on its number, not the run that stands for it.
        for (std::uint32_t r = 0; r < runs_.size(); ++r) {
            Run& run = runs_[r];
            if (run.body == std::int32_t(r)) {
                run.body = std::int32_t(sizes.size());
                sizes.push_back(0);
            } else {
                run.body = runs_[std::size_t(run.body)].body;  // one before, so numbered already
            }
            sizes[std::size_t(run.body)] += std::size_t(run.end - run.begin);
        }
    }

    std::vector<std::size_t> sizes;

    /// The body of a voxel, or none.
    std::int32_t at(std::size_t index) const {
        const std::size_t row = index / std::size_t(grid_.size.x);
        const auto i = std::int32_t(index % std::size_t(grid_.size.x));
        const auto first = runs_.begin() + firstOfRow_[row],
                   last = runs_.begin() + firstOfRow_[row + 1];
        const auto run = std::upper_bound(first, last, i,
                                          [](std::int32_t x, const Run& r) { return x < r.begin; });
        if (run != first && i < std::prev(run)->end) return std::prev(run)->body;
        const auto added = added_.find(index);
        return added == added_.end() ? none : added->second;
    }

    void add(std::size_t index, std::int32_t body) { added_[index] = body; }

    /// Calls visit(index) for the voxels of a body, but for those added, in memory order.
    template <class Visit>
    void visit(std::int32_t body, const Visit& visit) const {
        for (std::size_t row = 0; row + 1 < firstOfRow_.size(); ++row) {
            for (std::size_t r = firstOfRow_[row]; r < firstOfRow_[row + 1]; ++r) {
                if (runs_[r].body != body) continue;
                for (std::int32_t i = runs_[r].begin; i < runs_[r].end; ++i)
                    visit(row * std::size_t(grid_.size.x) + std::size_t(i));
            }
        }
    }

private:
    struct Run {
        std::int32_t begin, end, body;
    };

    void appendRuns(std::span<const std::uint8_t> row) {
        const auto isSet = [](std::uint8_t label) { return label != 0; };
        for (auto at = row.begin(); (at = std::find_if(at, row.end(), isSet)) != row.end();) {
            const auto end = std::find(at, row.end(), std::uint8_t(0));
            runs_.push_back({std::int32_t(at - row.begin()), std::int32_t(end - row.begin()),
                             std::int32_t(runs_.size())});
            at = end;
        }
    }

    /// The first of the runs that are known to be one body.
    std::int32_t rootOf(std::int32_t run) {
        return haustra::rootOf(
            [&](std::int32_t n) -> std::int32_t& { return runs_[std::size_t(n)].body; }, run);
    }

    void uniteRows(std::size_t row, std::size_t before) {
        std::size_t a = firstOfRow_[row], b = firstOfRow_[before];
        while (a < firstOfRow_[row + 1] && b < firstOfRow_[before + 1]) {
            const std::int32_t begin = std::max(runs_[a].begin, runs_[b].begin),
                               end = std::min(runs_[a].end, runs_[b].end);
            if (begin < end) {
                const std::int32_t one = rootOf(std::int32_t(a)), other = rootOf(std::int32_t(b));
                runs_[std::size_t(std::max(one, other))].body = std::min(one, other);
            }
            runs_[a].end < runs_[b].end ? ++a : ++b;
        }
    }

    Grid grid_;
    std::vector<Run> runs_;                  // in memory order
    std::vector<std::uint32_t> firstOfRow_;  // and the end
    std::unordered_map<std::size_t, std::int32_t> added_;
};

}  // namespace

double joinBodies(Volume<std::uint8_t>& labels, const std::function<bool(std::size_t)>& passable,
                  const std::function<std::uint8_t(std::size_t)>& labelOf,
                  const JoinBodiesOptions& options) {
    const Grid grid = labels.grid();
    const auto out = labels.writable();
    Bodies bodies(grid, out);
    if (bodies.sizes.size() < 2) return 0.0;
    const double voxelMl = grid.voxelVolumeMm3() / 1000.0;
    std::vector<bool> joined(bodies.sizes.size(), false);
    const auto isEdge = [&](std::size_t n) {
        bool edge = false;
        visitFaces(grid, n, [&](std::size_t m, int) {
            edge = edge || (out[m] == 0 && bodies.at(m) == none && passable(m));
        });
        return edge;
    };
    std::vector<std::size_t> edges;  // of what is joined, in memory order; some no longer
    const auto join = [&](std::int32_t body) {
        joined[std::size_t(body)] = true;
        bodies.visit(body, [&](std::size_t n) {
            if (isEdge(n)) edges.push_back(n);
        });
    };
    join(std::int32_t(std::max_element(bodies.sizes.begin(), bodies.sizes.end()) -
                      bodies.sizes.begin()));
    // Breadth first from what is joined; the first body that is met is joined by the way to it.
    for (bool more = true; more;) {
        more = false;
        std::unordered_map<std::size_t, std::size_t> cameFrom;
        std::vector<std::size_t> front;
        std::copy_if(edges.begin(), edges.end(), std::back_inserter(front), isEdge);
        for (std::size_t head = 0; head < front.size() && !more; ++head) {
            const std::size_t n = front[head];
            visitFaces(grid, n, [&](std::size_t m, int) {
                if (more) return;
                if (const std::int32_t met = bodies.at(m); met != none) {
                    if (joined[std::size_t(met)] ||
                        double(bodies.sizes[std::size_t(met)]) * voxelMl < options.leastMl)
                        return;
                    more = true;
                    for (std::size_t at = n; bodies.at(at) == none; at = cameFrom[at]) {
                        out[at] = labelOf(at);
                        bodies.add(at, met);
                        edges.push_back(at);
                    }
                    join(met);
                } else if (passable(m) && cameFrom.try_emplace(m, n).second) {
                    front.push_back(m);
                }
            });
        }
        std::sort(edges.begin(), edges.end());
    }
    double strandedMl = 0.0;
    for (std::size_t body = 0; body < joined.size(); ++body) {
        if (joined[body]) continue;
        strandedMl += double(bodies.sizes[body]) * voxelMl;
        if (options.dropOthers)
            bodies.visit(std::int32_t(body), [&](std::size_t n) { out[n] = 0; });
    }
    return strandedMl;
}

Neighbourhood labelledAround(const Volume<std::uint8_t>& labels, glm::ivec3 voxel) {
    Neighbourhood around = 0;
    for (int n = 0; n < 27; ++n) {
        const glm::ivec3 neighbour = voxel + cornerStep(n);
        if (labels.grid().contains(neighbour) && labels.at(neighbour) != 0) around |= 1u << n;
    }
    return around;
}

bool joinsNothing(const Volume<std::uint8_t>& labels, std::size_t index) {
    const Neighbourhood around = labelledAround(labels, labels.grid().voxelAt(index));
    return topologicalNumber6(around) == 1 && topologicalNumber18(around) <= 1;
}

}  // namespace haustra
