#include "centerline/graph.h"

#include "core/flood_fill.h"
#include "core/parallel.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>
#include <utility>

namespace haustra::centerline {
namespace {

/// A block's voxels at its lower end along each axis.
constexpr std::array<std::uint8_t, 3> lowSide{0x55, 0x33, 0x0f};

/// The 6-connected body of `inside` that holds its first voxel.
constexpr std::uint8_t firstBody(std::uint8_t inside) {
    unsigned body = inside & (~unsigned(inside) + 1u);
    for (unsigned before = 0; before != body;) {
        before = body;
        for (unsigned axis = 0; axis < 3; ++axis) {
            const unsigned step = 1u << axis, low = lowSide[axis];
            body |= (((body & low) << step) | ((body & ~low) >> step)) & inside;
        }
    }
    return std::uint8_t(body);
}

/// The first voxel along i and the end of those inside in a row of voxels; both 0 where there are
/// none.
std::pair<int, int> insideOf(const Volume<std::uint8_t>& labels, int j, int k) {
    const Grid& grid = labels.grid();
    const auto row = labels.voxels().subspan(grid.index(0, j, k), std::size_t(grid.size.x));
    const auto isInside = [](std::uint8_t label) { return label != 0; };
    const auto first = std::find_if(row.begin(), row.end(), isInside);
    if (first == row.end()) return {0, 0};
    const auto end = std::find_if(row.rbegin(), row.rend(), isInside).base();
    return {int(first - row.begin()), int(end - row.begin())};
}

/// The same of the rows of voxels that a row of blocks is made of.
std::pair<int, int> insideOfBlocks(const BlockGraph& graph, const Volume<std::uint8_t>& labels,
                                   int blockY, int blockZ) {
    int first = graph.grid.size.x, end = 0;
    for (int child = 0; child < 8; child += 2) {
        const glm::ivec3 v = graph.childVoxel({0, blockY, blockZ}, child);
        if (!graph.grid.contains({0, v.y, v.z})) continue;
        const auto [rowFirst, rowEnd] = insideOf(labels, v.y, v.z);
        if (rowEnd == 0) continue;
        first = std::min(first, rowFirst);
        end = std::max(end, rowEnd);
    }
    return {std::min(first, end), end};
}

/// The lower corner of the box around the lumen; 0 where there is none.
glm::ivec3 lowCorner(const Volume<std::uint8_t>& labels, int threads) {
    const glm::ivec3 size = labels.grid().size;
    std::vector<glm::ivec3> slices(std::size_t(size.z), size);
    parallelFor(slices.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (int j = 0; j < size.y; ++j) {
                const auto [first, rowEnd] = insideOf(labels, j, int(k));
                if (rowEnd > 0) slices[k] = glm::min(slices[k], glm::ivec3(first, j, int(k)));
            }
        }
    });
    glm::ivec3 low = size;
    for (const glm::ivec3 slice : slices)
        low = glm::min(low, slice);
    return low == size ? glm::ivec3(0) : low;
}

/// The nodes of one layer of blocks.
std::vector<BlockGraph::Node> layerNodes(const BlockGraph& graph,
                                         const Volume<std::uint8_t>& labels,
                                         const Volume<float>& distanceMm, int layer) {
    const Grid& grid = labels.grid();
    std::vector<BlockGraph::Node> nodes;
    for (int by = 0; by < graph.blocks.y; ++by) {
        const auto [first, end] = insideOfBlocks(graph, labels, by, layer);
        for (int bx = (first + graph.shift.x) / 2; 2 * bx < end + graph.shift.x; ++bx) {
            const auto voxelAt = [&](int child) {
                return graph.childVoxel({bx, by, layer}, child);
            };
            unsigned inside = 0;
            for (int child = 0; child < 8; ++child) {
                const glm::ivec3 v = voxelAt(child);
                if (grid.contains(v) && labels[grid.index(v)] != 0) inside |= 1u << child;
            }
            while (inside != 0) {
                BlockGraph::Node node{glm::ivec3(0), -1.0f, -1, firstBody(std::uint8_t(inside))};
                inside &= ~unsigned(node.inside);
                for (int child = 0; child < 8; ++child) {
                    if (!(node.inside >> child & 1)) continue;
                    const glm::ivec3 v = voxelAt(child);
                    const float mm = distanceMm[grid.index(v)];
                    if (mm > node.radiusMm) node.radiusMm = mm, node.voxel = v;
                }
                nodes.push_back(node);
            }
        }
    }
    return nodes;
}

/// A few nodes, each once: a block has four bodies at most.
struct FewNodes {
    std::array<std::int32_t, 4> at{};
    int count = 0;
    void add(std::int32_t node) {
        if (std::find(at.begin(), at.begin() + count, node) == at.begin() + count)
            at[std::size_t(count++)] = node;
    }
};

/// Adds what joints lead to from `node` across its block's face.
void addAcross(const BlockGraph& graph, std::int32_t node, int axis, int sign, FewNodes& found) {
    glm::ivec3 block = graph.blockOf(node);
    block[axis] += sign;
    if (block[axis] < 0 || block[axis] >= graph.blocks[axis]) return;
    const unsigned low = lowSide[std::size_t(axis)], own = graph.nodes[std::size_t(node)].inside;
    const unsigned facing = sign > 0 ? (own & ~low) >> (1 << axis) : (own & low) << (1 << axis);
    if (facing == 0) return;
    graph.visitNodesOf(block, [&](std::int32_t other) {
        if (graph.nodes[std::size_t(other)].inside & facing) found.add(other);
    });
}

/// The nodes of the 26 blocks around a node's where all 27 are full of lumen, as most are: joints
/// lead to every one of them. Else nothing is added, and false returned.
bool appendFullNeighbours(const BlockGraph& graph, std::int32_t node,
                          std::vector<std::int32_t>& neighbours) {
    constexpr std::uint8_t full = 0xff;
    const glm::ivec3 block = graph.blockOf(node);
    if (graph.nodes[std::size_t(node)].inside != full ||
        glm::any(glm::equal(block, glm::ivec3(0))) || glm::any(glm::equal(block, graph.blocks - 1)))
        return false;
    std::array<std::int32_t, 27> around;
    for (int n = 0; n < 27; ++n) {
        const glm::ivec3 step = cornerStep(n);
        const std::int32_t other = graph.nodeAt(block + step);
        if (other < 0 || graph.nodes[std::size_t(other)].inside != full) return false;
        around[std::size_t(n)] = other;
    }
    neighbours.insert(neighbours.end(), around.begin(), around.begin() + 13);
    neighbours.insert(neighbours.end(), around.begin() + 14, around.end());
    return true;
}

/// The nodes in the 26 blocks around a node's that joints lead straight to.
void appendNeighbours(const BlockGraph& graph, std::int32_t node,
                      std::vector<std::int32_t>& neighbours) {
    if (appendFullNeighbours(graph, node, neighbours)) return;
    // By the step (−1, 0 or 1 along each axis) to their block; those with fewer axes come first.
    std::array<FewNodes, 27> reached;
    const auto place = [](glm::ivec3 s) { return std::size_t(13 + s.x + 3 * s.y + 9 * s.z); };
    reached[place(glm::ivec3(0))].add(node);
    for (int axes = 1; axes <= 3; ++axes) {
        for (int n = 0; n < 27; ++n) {
            const glm::ivec3 step = cornerStep(n);
            if (std::abs(step.x) + std::abs(step.y) + std::abs(step.z) != axes) continue;
            FewNodes& found = reached[place(step)];
            for (int axis = 0; axis < 3; ++axis) {
                if (step[axis] == 0) continue;
                glm::ivec3 before = step;
                before[axis] = 0;
                const FewNodes& from = reached[place(before)];
                for (int f = 0; f < from.count; ++f)
                    addAcross(graph, from.at[std::size_t(f)], axis, step[axis], found);
            }
        }
    }
    for (int n = 0; n < 27; ++n) {
        if (n == 13) continue;
        for (int f = 0; f < reached[std::size_t(n)].count; ++f)
            neighbours.push_back(reached[std::size_t(n)].at[std::size_t(f)]);
    }
}

void joinNodes(BlockGraph& graph, int threads) {
    constexpr std::size_t chunk = 1 << 14;
    const std::size_t count = graph.nodes.size();
    std::vector<std::vector<std::int32_t>> found((count + chunk - 1) / chunk);
    graph.firstNeighbour.assign(count + 1, 0);
    parallelFor(found.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            for (std::size_t n = c * chunk; n < std::min(count, (c + 1) * chunk); ++n) {
                appendNeighbours(graph, std::int32_t(n), found[c]);
                graph.firstNeighbour[n + 1] = found[c].size();
            }
        }
    });
    std::size_t all = 0;
    for (const auto& some : found)
        all += some.size();
    graph.neighbourOf.reserve(all);
    for (std::size_t c = 0, before = 0; c < found.size(); ++c) {
        for (std::size_t n = c * chunk; n < std::min(count, (c + 1) * chunk); ++n)
            graph.firstNeighbour[n + 1] += before;
        before += found[c].size();
        graph.neighbourOf.insert(graph.neighbourOf.end(), found[c].begin(), found[c].end());
        found[c] = {};
    }
}

void labelComponents(BlockGraph& graph) {
    std::vector<std::int32_t> front;
    for (std::size_t first = 0; first < graph.nodes.size(); ++first) {
        if (graph.nodes[first].component >= 0) continue;
        const auto number = std::int32_t(graph.components.size());
        BlockGraph::Component component{std::int32_t(first), 0};
        graph.nodes[first].component = number;
        front.assign(1, std::int32_t(first));
        const auto neighbours = [&](std::int32_t node, const auto& visit) {
            for (const std::int32_t other : graph.neighbours(node))
                visit(other);
        };
        floodFill(front, neighbours, [&](std::int32_t other) {
            BlockGraph::Node& next = graph.nodes[std::size_t(other)];
            if (next.component >= 0) return false;
            next.component = number;
            return true;
        });
        for (const std::int32_t at : front) {
            const BlockGraph::Node& node = graph.nodes[std::size_t(at)];
            component.voxels += std::size_t(std::popcount(node.inside));
            const float deepest = graph.nodes[std::size_t(component.deepest)].radiusMm;
            if (node.radiusMm > deepest || (node.radiusMm == deepest && at < component.deepest))
                component.deepest = at;
        }
        graph.components.push_back(component);
    }
}

}  // namespace

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
    graph.shift = lowCorner(labels, threads) & 1;
    graph.blocks = (graph.grid.size + graph.shift + 1) / 2;
    std::vector<std::vector<BlockGraph::Node>> layers(std::size_t(graph.blocks.z));
    parallelFor(layers.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            layers[k] = layerNodes(graph, labels, distanceMm, int(k));
    });
    Grid blockGrid;
    blockGrid.size = graph.blocks;
    graph.firstNodeOf = Volume<std::int32_t>(blockGrid, 0);
    const auto firstNodeOf = graph.firstNodeOf.writable();
    std::size_t count = 0;
    for (const auto& layer : layers)
        count += layer.size();
    graph.nodes.reserve(count);
    for (auto& layer : layers) {
        for (const BlockGraph::Node& node : layer) {
            graph.nodes.push_back(node);
            std::int32_t& first = firstNodeOf[blockGrid.index(graph.blockAt(node.voxel))];
            if (first == 0) first = std::int32_t(graph.nodes.size());
        }
        layer = {};
    }
    joinNodes(graph, threads);
    labelComponents(graph);
    return graph;
}

void markAlong(const BlockGraph& graph, const std::vector<std::int32_t>& route, double part,
               double marginMm, std::vector<bool>& marked) {
    const glm::dvec3 spacing = graph.spacingMm;
    for (const std::int32_t node : route) {
        marked[std::size_t(node)] = true;
        const glm::ivec3 center = graph.voxelOf(node);
        const double radiusMm = part * double(graph.nodes[std::size_t(node)].radiusMm) + marginMm;
        if (!std::isfinite(radiusMm)) continue;
        const glm::ivec3 reach = glm::ivec3(radiusMm / (2.0 * spacing)) + 1;
        const glm::ivec3 block = graph.blockOf(node);
        const glm::ivec3 lo = glm::max(block - reach, glm::ivec3(0));
        const glm::ivec3 hi = glm::min(block + reach, graph.blocks - 1);
        visitBox(lo, hi, [&](glm::ivec3 near) {
            graph.visitNodesOf(near, [&](std::int32_t other) {
                const glm::dvec3 away = spacing * glm::dvec3(graph.voxelOf(other) - center);
                if (glm::dot(away, away) <= radiusMm * radiusMm) marked[std::size_t(other)] = true;
            });
        });
    }
}

}  // namespace haustra::centerline
