#include "topology/centerline_graph.h"

#include "core/parallel.h"

#include <bit>
#include <limits>

namespace haustra::topology {
namespace {

// The voxels of a block that lie on its side towards `step` (−1, 0 or 1 along each axis).
constexpr std::uint8_t sideTowards(int sx, int sy, int sz) {
    std::uint8_t side = 0;
    for (int child = 0; child < 8; ++child) {
        const int x = child & 1, y = child >> 1 & 1, z = child >> 2;
        if ((sx == 0 || x == (sx > 0)) && (sy == 0 || y == (sy > 0)) &&
            (sz == 0 || z == (sz > 0))) {
            side = std::uint8_t(side | 1 << child);
        }
    }
    return side;
}

struct Neighbour {
    glm::ivec3 step;
    std::uint8_t ownSide, itsSide;
};

const std::array<Neighbour, 26>& neighbourSteps() {
    static const auto steps = [] {
        std::array<Neighbour, 26> all;
        int n = 0;
        for (int z = -1; z <= 1; ++z) {
            for (int y = -1; y <= 1; ++y) {
                for (int x = -1; x <= 1; ++x) {
                    if (x == 0 && y == 0 && z == 0) continue;
                    all[std::size_t(n++)] = {
                        {x, y, z}, sideTowards(x, y, z), sideTowards(-x, -y, -z)};
                }
            }
        }
        return all;
    }();
    return steps;
}

/// The nodes of one layer of blocks.
std::vector<BlockGraph::Node> layerNodes(const Volume<std::uint8_t>& labels,
                                         const Volume<float>& distanceMm, glm::ivec3 blocks,
                                         int layer) {
    const Grid& grid = labels.grid();
    std::vector<BlockGraph::Node> nodes;
    for (int by = 0; by < blocks.y; ++by) {
        for (int bx = 0; bx < blocks.x; ++bx) {
            BlockGraph::Node node{glm::ivec3(0), -1.0f, -1, 0, 0};
            for (int child = 0; child < 8; ++child) {
                const glm::ivec3 v(2 * bx + (child & 1), 2 * by + (child >> 1 & 1),
                                   2 * layer + (child >> 2));
                if (!grid.contains(v)) continue;
                const std::size_t at = grid.index(v);
                if (labels[at] == 0) continue;
                node.inside = std::uint8_t(node.inside | 1 << child);
                if (distanceMm[at] > node.radiusMm) {
                    node.radiusMm = distanceMm[at];
                    node.voxel = v;
                }
            }
            if (node.inside) nodes.push_back(node);
        }
    }
    return nodes;
}

std::uint32_t neighbourBits(const BlockGraph& graph, const BlockGraph::Node& node) {
    std::uint32_t bits = 0;
    for (std::size_t n = 0; n < 26; ++n) {
        const Neighbour& neighbour = neighbourSteps()[n];
        if (!(node.inside & neighbour.ownSide)) continue;
        const glm::ivec3 b = node.voxel / 2 + neighbour.step;
        if (b.x < 0 || b.y < 0 || b.z < 0 || b.x >= graph.blocks.x || b.y >= graph.blocks.y ||
            b.z >= graph.blocks.z) {
            continue;
        }
        const std::int32_t other = graph.nodeAt[graph.blockIndex(b)];
        if (other >= 0 && (graph.nodes[std::size_t(other)].inside & neighbour.itsSide))
            bits |= 1u << n;
    }
    return bits;
}

void labelComponents(BlockGraph& graph) {
    std::array<std::int32_t, 26> around;
    std::vector<std::int32_t> front;
    for (std::size_t first = 0; first < graph.nodes.size(); ++first) {
        if (graph.nodes[first].component >= 0) continue;
        const auto number = std::int32_t(graph.components.size());
        BlockGraph::Component component{std::int32_t(first), 0};
        graph.nodes[first].component = number;
        front.assign(1, std::int32_t(first));
        while (!front.empty()) {
            const std::int32_t at = front.back();
            front.pop_back();
            const BlockGraph::Node& node = graph.nodes[std::size_t(at)];
            component.voxels += std::size_t(std::popcount(node.inside));
            const float deepest = graph.nodes[std::size_t(component.deepest)].radiusMm;
            if (node.radiusMm > deepest || (node.radiusMm == deepest && at < component.deepest)) {
                component.deepest = at;
            }
            const int count = graph.neighbours(at, around);
            for (int n = 0; n < count; ++n) {
                BlockGraph::Node& next = graph.nodes[std::size_t(around[std::size_t(n)])];
                if (next.component >= 0) continue;
                next.component = number;
                front.push_back(around[std::size_t(n)]);
            }
        }
        graph.components.push_back(component);
    }
}

}  // namespace

int BlockGraph::neighbours(std::int32_t node, std::array<std::int32_t, 26>& found) const {
    const std::int32_t* here = nodeAt.data() + blockIndex(blockOf(node));
    int count = 0;
    for (std::uint32_t bits = nodes[std::size_t(node)].neighbours; bits; bits &= bits - 1) {
        found[std::size_t(count++)] = here[offsets[std::size_t(std::countr_zero(bits))]];
    }
    return count;
}

std::int32_t BlockGraph::nearest(glm::dvec3 patientMm) const {
    std::int32_t best = 0;
    double bestSquared = std::numeric_limits<double>::max();
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const glm::dvec3 d = positionMm(std::int32_t(n)) - patientMm;
        if (glm::dot(d, d) < bestSquared) bestSquared = glm::dot(d, d), best = std::int32_t(n);
    }
    return best;
}

BlockGraph makeBlockGraph(const Volume<std::uint8_t>& labels, const Volume<float>& distanceMm,
                          int threads) {
    BlockGraph graph;
    graph.grid = labels.grid();
    graph.spacingMm = graph.grid.spacingMm();
    graph.blocks = (graph.grid.size + 1) / 2;
    std::vector<std::vector<BlockGraph::Node>> layers(std::size_t(graph.blocks.z));
    parallelFor(layers.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            layers[k] = layerNodes(labels, distanceMm, graph.blocks, int(k));
    });
    graph.nodeAt.assign(
        std::size_t(graph.blocks.x) * std::size_t(graph.blocks.y) * std::size_t(graph.blocks.z),
        -1);
    for (auto& layer : layers) {
        for (const BlockGraph::Node& node : layer) {
            graph.nodeAt[graph.blockIndex(node.voxel / 2)] = std::int32_t(graph.nodes.size());
            graph.nodes.push_back(node);
        }
        layer = {};
    }
    for (std::size_t n = 0; n < 26; ++n) {
        const glm::ivec3 step = neighbourSteps()[n].step;
        graph.offsets[n] = step.x + std::ptrdiff_t(graph.blocks.x) *
                                        (step.y + std::ptrdiff_t(graph.blocks.y) * step.z);
    }
    parallelFor(graph.nodes.size(), 1 << 14, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            graph.nodes[n].neighbours = neighbourBits(graph, graph.nodes[n]);
    });
    labelComponents(graph);
    return graph;
}

void markAlong(const BlockGraph& graph, const std::vector<std::int32_t>& route, double part,
               double marginMm, std::vector<bool>& marked) {
    const glm::dvec3 spacing = graph.spacingMm;
    for (const std::int32_t node : route) {
        marked[std::size_t(node)] = true;
        const glm::ivec3 centre = graph.voxelOf(node);
        const double radiusMm = part * double(graph.nodes[std::size_t(node)].radiusMm) + marginMm;
        if (!std::isfinite(radiusMm)) continue;
        const glm::ivec3 reach = glm::ivec3(radiusMm / (2.0 * spacing)) + 1;
        const glm::ivec3 lo = glm::max(centre / 2 - reach, glm::ivec3(0));
        const glm::ivec3 hi = glm::min(centre / 2 + reach, graph.blocks - 1);
        for (int z = lo.z; z <= hi.z; ++z) {
            for (int y = lo.y; y <= hi.y; ++y) {
                for (int x = lo.x; x <= hi.x; ++x) {
                    const std::int32_t other = graph.nodeAt[graph.blockIndex({x, y, z})];
                    if (other < 0 || marked[std::size_t(other)]) continue;
                    const glm::dvec3 away = spacing * glm::dvec3(graph.voxelOf(other) - centre);
                    if (glm::dot(away, away) <= radiusMm * radiusMm)
                        marked[std::size_t(other)] = true;
                }
            }
        }
    }
}

}  // namespace haustra::topology
