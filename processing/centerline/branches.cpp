#include "centerline/branches.h"

#include <algorithm>
#include <cmath>

namespace haustra::centerline {
namespace {

// What lies within these many radii of a route belongs to it: a round section has corners.
constexpr double coveringPart = 1.25;

/// Marks the nodes in the balls inscribed along a route, somewhat larger.
void cover(const BlockGraph& graph, const std::vector<std::int32_t>& route,
           std::vector<bool>& covered) {
    const double blockMm = 2.0 * glm::length(graph.spacingMm);
    markAlong(graph, route, coveringPart, 0.5 * blockMm, covered);
}

/// The way from a tip back to what it leaves.
struct Chain {
    std::int32_t tip;
    float lengthMm;
};

/// A forest of shortest ways back to a route, cut into chains: each the longest way on from the
/// route or from where it leaves another chain. The longest first, none shorter than `shortestMm`.
std::vector<Chain> longChains(const PathTree& shortest, double shortestMm) {
    const auto lengthMm = [&](std::int32_t node) { return shortest.lengthMm[std::size_t(node)]; };
    std::vector<std::int32_t> farthestFirst;
    for (std::size_t n = 0; n < shortest.parent.size(); ++n) {
        if (shortest.parent[n] >= 0) farthestFirst.push_back(std::int32_t(n));
    }
    std::sort(farthestFirst.begin(), farthestFirst.end(), [&](std::int32_t a, std::int32_t b) {
        return lengthMm(a) != lengthMm(b) ? lengthMm(a) > lengthMm(b) : a < b;
    });
    std::vector<std::int32_t> tipBeyond(shortest.parent.size(), -1);
    std::vector<Chain> chains;
    // Children come before their parents, and the farthest tip reaches a node first.
    for (const std::int32_t node : farthestFirst) {
        std::int32_t& tip = tipBeyond[std::size_t(node)];
        if (tip < 0) tip = node;
        const std::int32_t parent = shortest.parent[std::size_t(node)];
        std::int32_t& beyondParent = tipBeyond[std::size_t(parent)];
        const bool onRoute = shortest.parent[std::size_t(parent)] < 0;
        std::int32_t ends = tip;  // the chain that ends at the parent
        if (!onRoute && (beyondParent < 0 || lengthMm(tip) > lengthMm(beyondParent)))
            std::swap(ends, beyondParent);
        if (ends < 0) continue;
        const float chainMm = lengthMm(ends) - lengthMm(parent);
        if (double(chainMm) >= shortestMm) chains.push_back({ends, chainMm});
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
    // Where branches end, the shortest ways tell: the widest tree's wind about. How to get there,
    // the widest tree tells: the shortest ways cut corners.
    const PathTree shortest = growCheapestTree(graph, mainRoute, StepCost::length);
    std::vector<std::vector<std::int32_t>> branches;
    for (const Chain& chain : longChains(shortest, shortestMm)) {
        std::int32_t leaves = chain.tip;
        while (!covered[std::size_t(leaves)])
            leaves = shortest.parent[std::size_t(leaves)];
        const float outsideMm =
            shortest.lengthMm[std::size_t(chain.tip)] - shortest.lengthMm[std::size_t(leaves)];
        if (double(outsideMm) < shortestMm) continue;
        std::vector<std::int32_t> route{chain.tip};
        while (!onRoute[std::size_t(route.back())])
            route.push_back(widest.parent[std::size_t(route.back())]);
        std::reverse(route.begin(), route.end());
        accept(route);
        branches.push_back(std::move(route));
    }
    return branches;
}

}  // namespace haustra::centerline
