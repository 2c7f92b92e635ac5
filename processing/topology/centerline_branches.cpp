#include "topology/centerline_branches.h"

#include <algorithm>
#include <cmath>

namespace haustra::topology {
namespace {

// What lies within these many radii of a route belongs to it: a round section has corners.
constexpr double coveringPart = 1.25;

/// Marks the nodes in the balls inscribed along a route, somewhat larger.
void cover(const BlockGraph& graph, const std::vector<std::int32_t>& route,
           std::vector<bool>& covered) {
    const glm::dvec3 spacing = graph.spacingMm;
    const double blockMm = 2.0 * glm::length(spacing);
    for (const std::int32_t node : route) {
        const glm::ivec3 centre = graph.voxelOf(node);
        const double radiusMm =
            coveringPart * double(graph.nodes[std::size_t(node)].radiusMm) + 0.5 * blockMm;
        if (!std::isfinite(radiusMm)) continue;
        const glm::ivec3 reach = glm::ivec3(radiusMm / (2.0 * spacing)) + 1;
        const glm::ivec3 lo = glm::max(centre / 2 - reach, glm::ivec3(0));
        const glm::ivec3 hi = glm::min(centre / 2 + reach, graph.blocks - 1);
        for (int z = lo.z; z <= hi.z; ++z) {
            for (int y = lo.y; y <= hi.y; ++y) {
                for (int x = lo.x; x <= hi.x; ++x) {
                    const std::int32_t other = graph.nodeAt[graph.blockIndex({x, y, z})];
                    if (other < 0 || covered[std::size_t(other)]) continue;
                    const glm::dvec3 away = spacing * glm::dvec3(graph.voxelOf(other) - centre);
                    if (glm::dot(away, away) <= radiusMm * radiusMm)
                        covered[std::size_t(other)] = true;
                }
            }
        }
    }
}

/// A part of the tree that leaves another, followed to its farthest tip.
struct Chain {
    std::int32_t tip;
    float lengthMm;
};

/// The tree cut into chains, each the longest way on from where it leaves another or the main
/// route; the longest chain first, none shorter than `shortestMm`.
std::vector<Chain> longChains(const PathTree& widest, const std::vector<bool>& onRoute,
                              double shortestMm) {
    const auto lengthMm = [&](std::int32_t node) { return widest.lengthMm[std::size_t(node)]; };
    std::vector<std::int32_t> farthest(widest.parent.size(), -1);  // tip below each node
    std::vector<Chain> chains;
    const auto end = [&](std::int32_t tip, std::int32_t parent) {
        const float chainMm = lengthMm(tip) - lengthMm(parent);
        if (double(chainMm) >= shortestMm) chains.push_back({tip, chainMm});
    };
    for (std::size_t n = widest.order.size(); n-- > 1;) {
        const std::int32_t node = widest.order[n], parent = widest.parent[std::size_t(node)];
        if (onRoute[std::size_t(node)]) continue;
        const std::int32_t own = farthest[std::size_t(node)];
        const std::int32_t tip = own >= 0 ? own : node;
        if (onRoute[std::size_t(parent)]) {
            end(tip, parent);
            continue;
        }
        std::int32_t& best = farthest[std::size_t(parent)];
        if (best < 0 || lengthMm(tip) > lengthMm(best)) {
            if (best >= 0) end(best, parent);
            best = tip;
        } else {
            end(tip, parent);
        }
    }
    std::sort(chains.begin(), chains.end(), [](const Chain& a, const Chain& b) {
        return a.lengthMm != b.lengthMm ? a.lengthMm > b.lengthMm : a.tip < b.tip;
    });
    return chains;
}

}  // namespace

std::vector<std::vector<std::int32_t>> sideBranches(const BlockGraph& graph, const PathTree& widest,
                                                    const std::vector<std::int32_t>& mainRoute,
                                                    double shortestMm) {
    std::vector<bool> onRoute(graph.nodes.size(), false), covered(graph.nodes.size(), false);
    const auto accept = [&](const std::vector<std::int32_t>& route) {
        for (const std::int32_t node : route)
            onRoute[std::size_t(node)] = true;
        cover(graph, route, covered);
    };
    accept(mainRoute);
    std::vector<std::vector<std::int32_t>> branches;
    for (const Chain& chain : longChains(widest, onRoute, shortestMm)) {
        std::vector<std::int32_t> route{chain.tip};
        std::int32_t leaves = -1;  // the first covered node on the way back
        while (!onRoute[std::size_t(route.back())]) {
            if (leaves < 0 && covered[std::size_t(route.back())]) leaves = route.back();
            route.push_back(widest.parent[std::size_t(route.back())]);
        }
        if (leaves < 0) leaves = route.back();
        const float outsideMm =
            widest.lengthMm[std::size_t(chain.tip)] - widest.lengthMm[std::size_t(leaves)];
        if (double(outsideMm) < shortestMm) continue;
        std::reverse(route.begin(), route.end());
        accept(route);
        branches.push_back(std::move(route));
    }
    return branches;
}

}  // namespace haustra::topology
