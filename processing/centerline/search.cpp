#include "centerline/search.h"

#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace haustra::centerline {
namespace {

using CheapestFirst =
    std::priority_queue<std::pair<double, std::int32_t>,
                        std::vector<std::pair<double, std::int32_t>>, std::greater<>>;

// The part of the inscribed balls that the line may pass.
constexpr double innerPart = 0.8;

/// The voxels near a route, numbered block by block.
class Corridor {
public:
    Corridor(const BlockGraph& graph, const std::vector<std::int32_t>& route, int reach)
        : graph_(graph), numberOf_(graph.nodes.size(), -1) {
        for (const std::int32_t node : route) {
            const glm::ivec3 center = graph.blockOf(node);
            const glm::ivec3 lo = glm::max(center - reach, glm::ivec3(0));
            const glm::ivec3 hi = glm::min(center + reach, graph.blocks - 1);
            visitBox(lo, hi, [&](glm::ivec3 block) {
                graph.visitNodesOf(block, [&](std::int32_t near) { add(near); });
            });
        }
    }
    std::size_t size() const { return nodes_.size() * 8; }
    /// −1 for a voxel that is outside the lumen or the corridor.
    std::int32_t numberOf(glm::ivec3 voxel) const {
        if (!graph_.grid.contains(voxel)) return -1;
        const int child = graph_.childAt(voxel);
        std::int32_t number = -1;
        graph_.visitNodesOf(graph_.blockAt(voxel), [&](std::int32_t node) {
            if (numberOf_[std::size_t(node)] >= 0 &&
                (graph_.nodes[std::size_t(node)].inside >> child & 1))
                number = numberOf_[std::size_t(node)] * 8 + child;
        });
        return number;
    }
    /// Numbers of the 27 voxels around one; −1 as of numberOf.
    std::array<std::int32_t, 27> around(glm::ivec3 voxel) const {
        std::array<std::int32_t, 27> numbers;
        for (int n = 0; n < 27; ++n)
            numbers[std::size_t(n)] = numberOf(voxel + cornerStep(n));
        return numbers;
    }
    /// Whether voxels lead face by face from the middle of `numbers`, once at `at`, by `step`.
    static bool leads(const std::array<std::int32_t, 27>& numbers, glm::ivec3 at, glm::ivec3 step) {
        if (step == glm::ivec3(0)) return true;
        for (int axis = 0; axis < 3; ++axis) {
            if (step[axis] == 0) continue;
            glm::ivec3 first(0);
            first[axis] = step[axis];
            const glm::ivec3 next = at + first;
            if (numbers[std::size_t(next.x + 1 + 3 * (next.y + 1) + 9 * (next.z + 1))] >= 0 &&
                leads(numbers, next, step - first))
                return true;
        }
        return false;
    }
    glm::ivec3 voxelOf(std::int32_t number) const {
        return graph_.childVoxel(graph_.blockOf(nodes_[std::size_t(number / 8)]), number % 8);
    }

private:
    void add(std::int32_t node) {
        if (node < 0 || numberOf_[std::size_t(node)] >= 0) return;
        numberOf_[std::size_t(node)] = std::int32_t(nodes_.size());
        nodes_.push_back(node);
    }
    const BlockGraph& graph_;
    std::vector<std::int32_t> numberOf_;
    std::vector<std::int32_t> nodes_;
};

double costPerMm(float radiusMm) {
    return 1.0 / std::max(double(radiusMm), 1e-3);
}

double stepMm(const BlockGraph& graph, std::int32_t a, std::int32_t b) {
    return glm::length(graph.spacingMm * glm::dvec3(graph.voxelOf(a) - graph.voxelOf(b)));
}

}  // namespace

PathTree growWidestTree(const BlockGraph& graph, std::int32_t source) {
    const std::size_t count = graph.nodes.size();
    PathTree tree{std::vector<std::int32_t>(count, -1), std::vector<float>(count, -1.0f), {source}};
    // The deepest first; of equals, the first node.
    std::priority_queue<std::pair<float, std::int32_t>> frontier;
    tree.lengthMm[std::size_t(source)] = 0.0f;
    frontier.emplace(graph.nodes[std::size_t(source)].radiusMm, -source);
    while (!frontier.empty()) {
        const std::int32_t at = -frontier.top().second;
        frontier.pop();
        for (const std::int32_t next : graph.neighbours(at)) {
            if (tree.lengthMm[std::size_t(next)] >= 0.0f) continue;
            tree.parent[std::size_t(next)] = at;
            tree.lengthMm[std::size_t(next)] =
                tree.lengthMm[std::size_t(at)] + float(stepMm(graph, at, next));
            tree.order.push_back(next);
            frontier.emplace(graph.nodes[std::size_t(next)].radiusMm, -next);
        }
    }
    return tree;
}

PathTree rerooted(PathTree widest, std::int32_t source) {
    std::vector<std::int32_t> turned;  // from the new source to the old one
    for (std::int32_t at = source; at >= 0; at = widest.parent[std::size_t(at)])
        turned.push_back(at);
    std::vector<float> stepMm(widest.parent.size(), 0.0f);  // to the parent
    for (const std::int32_t node : widest.order) {
        const std::int32_t parent = widest.parent[std::size_t(node)];
        if (parent >= 0) {
            stepMm[std::size_t(node)] =
                widest.lengthMm[std::size_t(node)] - widest.lengthMm[std::size_t(parent)];
        }
    }
    for (std::size_t n = turned.size(); n-- > 1;) {
        widest.parent[std::size_t(turned[n])] = turned[n - 1];
        stepMm[std::size_t(turned[n])] = stepMm[std::size_t(turned[n - 1])];
    }
    widest.parent[std::size_t(source)] = -1;
    std::vector<bool> isTurned(widest.parent.size(), false);
    for (const std::int32_t node : turned)
        isTurned[std::size_t(node)] = true;
    std::vector<std::int32_t> order = turned;
    for (const std::int32_t node : widest.order) {
        if (!isTurned[std::size_t(node)]) order.push_back(node);
    }
    widest.lengthMm[std::size_t(source)] = 0.0f;
    for (std::size_t n = 1; n < order.size(); ++n) {
        const auto node = std::size_t(order[n]);
        widest.lengthMm[node] = widest.lengthMm[std::size_t(widest.parent[node])] + stepMm[node];
    }
    widest.order = std::move(order);
    return widest;
}

PathTree growCheapestTree(const BlockGraph& graph, std::span<const std::int32_t> sources,
                          StepCost cost, const std::vector<bool>& within, double longestMm) {
    const std::size_t count = graph.nodes.size();
    PathTree tree{std::vector<std::int32_t>(count, -1), std::vector<float>(count, -1.0f), {}};
    std::vector<double> best(count, std::numeric_limits<double>::infinity());
    std::vector<bool> done(count, false);
    CheapestFirst frontier;
    for (const std::int32_t source : sources) {
        best[std::size_t(source)] = 0.0;
        tree.lengthMm[std::size_t(source)] = 0.0f;
        frontier.emplace(0.0, source);
    }
    const auto perMm = [&](std::int32_t node) {
        return cost == StepCost::length ? 1.0 : costPerMm(graph.nodes[std::size_t(node)].radiusMm);
    };
    while (!frontier.empty()) {
        const std::int32_t at = frontier.top().second;
        frontier.pop();
        if (done[std::size_t(at)]) continue;
        done[std::size_t(at)] = true;
        const double perMmHere = perMm(at);
        for (const std::int32_t next : graph.neighbours(at)) {
            if (done[std::size_t(next)] || (!within.empty() && !within[std::size_t(next)]))
                continue;
            const double step = stepMm(graph, at, next);
            const double through = best[std::size_t(at)] + 0.5 * step * (perMmHere + perMm(next));
            const double lengthMm = double(tree.lengthMm[std::size_t(at)]) + step;
            if (through >= best[std::size_t(next)] || lengthMm > longestMm) continue;
            best[std::size_t(next)] = through;
            tree.parent[std::size_t(next)] = at;
            tree.lengthMm[std::size_t(next)] = float(lengthMm);
            frontier.emplace(through, next);
        }
    }
    return tree;
}

std::int32_t longestPathEnd(const PathTree& tree) {
    return std::int32_t(std::max_element(tree.lengthMm.begin(), tree.lengthMm.end()) -
                        tree.lengthMm.begin());
}

std::vector<std::int32_t> pathTo(const PathTree& tree, std::int32_t target) {
    std::vector<std::int32_t> path;
    for (std::int32_t at = target; at >= 0; at = tree.parent[std::size_t(at)])
        path.push_back(at);
    std::reverse(path.begin(), path.end());
    return path;
}

std::vector<std::int32_t> centerRoute(const BlockGraph& graph,
                                      const std::vector<std::int32_t>& route) {
    std::vector<bool> within(graph.nodes.size(), false);
    markAlong(graph, route, innerPart, 0.0, within);
    const PathTree tree =
        growCheapestTree(graph, std::span(route).first(1), StepCost::closeness, within);
    return pathTo(tree, route.back());
}

std::vector<glm::ivec3> refineToVoxels(const BlockGraph& graph, const Volume<float>& distanceMm,
                                       const std::vector<std::int32_t>& route, int reach) {
    const Corridor corridor(graph, route, reach);
    const std::int32_t source = corridor.numberOf(graph.voxelOf(route.front()));
    const std::int32_t target = corridor.numberOf(graph.voxelOf(route.back()));
    const glm::dvec3 spacing = graph.spacingMm;
    std::vector<double> cost(corridor.size(), std::numeric_limits<double>::infinity());
    std::vector<std::int32_t> parent(corridor.size(), -1);
    std::vector<bool> done(corridor.size(), false);
    CheapestFirst frontier;
    cost[std::size_t(source)] = 0.0;
    frontier.emplace(0.0, source);
    while (!frontier.empty() && !done[std::size_t(target)]) {
        const std::int32_t at = frontier.top().second;
        frontier.pop();
        if (done[std::size_t(at)]) continue;
        done[std::size_t(at)] = true;
        const glm::ivec3 here = corridor.voxelOf(at);
        const double costHere = costPerMm(distanceMm.at(here));
        const auto around = corridor.around(here);
        for (int n = 0; n < 27; ++n) {
            const glm::ivec3 step = cornerStep(n);
            const std::int32_t next = around[std::size_t(n)];
            if (n == 13 || next < 0 || done[std::size_t(next)]) continue;
            const double through =
                cost[std::size_t(at)] + 0.5 * glm::length(spacing * glm::dvec3(step)) *
                                            (costHere + costPerMm(distanceMm.at(here + step)));
            if (through >= cost[std::size_t(next)] || !Corridor::leads(around, glm::ivec3(0), step))
                continue;
            cost[std::size_t(next)] = through;
            parent[std::size_t(next)] = at;
            frontier.emplace(through, next);
        }
    }
    std::vector<glm::ivec3> path;
    for (std::int32_t at = target; at >= 0; at = parent[std::size_t(at)])
        path.push_back(corridor.voxelOf(at));
    std::reverse(path.begin(), path.end());
    return path;
}

}  // namespace haustra::centerline
