#include "centerline/tip.h"

#include <algorithm>

namespace haustra::centerline {
namespace {

// How long the last stretch is, in the colon's radii.
constexpr float stretchInRadii = 4.0f;
// How far the lumen may lie from the path and still belong to it, in the same radii.
constexpr float aroundInRadii = 3.0f;
// The last wide and the last narrow place have at least these parts of the stretch's greatest
// radius; the tip may lie so far from their centres, in their own radii.
constexpr float wideWidth = 0.6f, narrowWidth = 0.2f;
constexpr double wideReach = 0.9, narrowReach = 1.25;
// A narrow place no farther from the last wide place's centre, in its radii, is a corner of it.
constexpr double bluntReach = 1.5;

/// The end of a path from which on the colon's end is looked for.
struct LastStretch {
    std::size_t start = 0;  ///< index in the path
    float widestMm = 0.0f;
};

LastStretch lastStretch(const BlockGraph& graph, const PathTree& tree,
                        const std::vector<std::int32_t>& path) {
    const auto radiusMm = [&](std::size_t n) { return graph.nodes[std::size_t(path[n])].radiusMm; };
    double meanMm = 0.0;
    for (std::size_t n = 0; n < path.size(); ++n)
        meanMm += double(radiusMm(n)) / double(path.size());
    // A narrow side branch may lead to the tip: count from the colon's last place of mean width.
    std::size_t wide = path.size() - 1;
    while (wide > 0 && double(radiusMm(wide)) < meanMm)
        --wide;
    LastStretch stretch{wide, radiusMm(wide)};
    const float lengthMm = tree.lengthMm[std::size_t(path[wide])];
    for (; stretch.start > 0; --stretch.start) {
        stretch.widestMm = std::max(stretch.widestMm, radiusMm(stretch.start));
        if (lengthMm - tree.lengthMm[std::size_t(path[stretch.start])] >=
            stretchInRadii * stretch.widestMm)
            break;
    }
    return stretch;
}

/// The nodes nearer to the last stretch than to the path before it, without what a leak leads to.
std::vector<bool> lumenAround(const BlockGraph& graph, const PathTree& tree,
                              const std::vector<std::int32_t>& path, const LastStretch& stretch) {
    const float fromMm = tree.lengthMm[std::size_t(path[stretch.start])];
    const float aroundMm = aroundInRadii * stretch.widestMm;
    std::size_t before = stretch.start;
    while (before > 0 && fromMm - tree.lengthMm[std::size_t(path[before])] < aroundMm)
        --before;
    const PathTree near =
        growCheapestTree(graph, std::span(path).subspan(before), StepCost::length, {}, aroundMm);
    std::vector<std::int32_t> placeOf(graph.nodes.size(), -1);
    for (std::size_t n = before; n < path.size(); ++n)
        placeOf[std::size_t(path[n])] = std::int32_t(n);
    std::vector<bool> within(graph.nodes.size(), false);
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
        if (near.lengthMm[n] < 0.0f || tree.lengthMm[n] < fromMm - aroundMm) continue;
        std::size_t root = n;
        while (near.parent[root] >= 0)
            root = std::size_t(near.parent[root]);
        within[n] = placeOf[root] >= std::int32_t(stretch.start);
    }
    return within;
}

/// The eligible node for which `measure` is greatest; `otherwise` where there is none.
template <class Eligible, class Measure>
std::int32_t greatest(const BlockGraph& graph, std::int32_t otherwise, const Eligible& eligible,
                      const Measure& measure) {
    std::int32_t best = otherwise;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
        const auto node = std::int32_t(n);
        if (!eligible(node)) continue;
        if (const double value = measure(node); value > most) most = value, best = node;
    }
    return best;
}

/// Unit direction in which the tree's path arrives at `node`, over about one radius.
glm::dvec3 arrival(const BlockGraph& graph, const PathTree& tree, std::int32_t node) {
    const float radiusMm = graph.nodes[std::size_t(node)].radiusMm;
    std::int32_t back = node;
    while (tree.parent[std::size_t(back)] >= 0 &&
           tree.lengthMm[std::size_t(node)] - tree.lengthMm[std::size_t(back)] < radiusMm) {
        back = tree.parent[std::size_t(back)];
    }
    const glm::dvec3 chord = graph.positionMm(node) - graph.positionMm(back);
    return glm::length(chord) > 0.0 ? glm::normalize(chord) : glm::dvec3(0.0);
}

}  // namespace

std::int32_t farthestTip(const BlockGraph& graph, const PathTree& widest, EndShape shape) {
    const std::vector<std::int32_t> path = pathTo(widest, longestPathEnd(widest));
    const LastStretch stretch = lastStretch(graph, widest, path);
    const std::int32_t start = path[stretch.start];
    const std::vector<bool> within = lumenAround(graph, widest, path, stretch);
    const PathTree cap = growCheapestTree(graph, std::span(&start, 1), StepCost::length, within);
    const auto reached = [&](std::int32_t node) { return cap.lengthMm[std::size_t(node)] >= 0.0f; };
    const auto lengthMm = [&](std::int32_t node) {
        return double(cap.lengthMm[std::size_t(node)]);
    };

    const auto lastPlace = [&](float width) {
        return greatest(
            graph, start,
            [&](std::int32_t node) {
                return reached(node) &&
                       graph.nodes[std::size_t(node)].radiusMm >= width * stretch.widestMm;
            },
            lengthMm);
    };
    const auto near = [&](std::int32_t place, double reach) {
        return [&, place, reachMm = reach * double(graph.nodes[std::size_t(place)].radiusMm)](
                   std::int32_t node) {
            return reached(node) &&
                   glm::distance(graph.positionMm(node), graph.positionMm(place)) <= reachMm;
        };
    };
    const std::int32_t wide = lastPlace(wideWidth);
    if (const std::int32_t narrow = lastPlace(narrowWidth);
        shape == EndShape::any && !near(wide, bluntReach)(narrow)) {
        return greatest(graph, narrow, near(narrow, narrowReach), lengthMm);
    }
    const glm::dvec3 onward = arrival(graph, cap, wide);
    return greatest(graph, wide, near(wide, wideReach),
                    [&](std::int32_t node) { return glm::dot(graph.positionMm(node), onward); });
}

}  // namespace haustra::centerline
