#include "mesh/cut_graph.h"

#include "core/disjoint_sets.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>

namespace haustra::mesh {
namespace {

struct PathTree {
    std::vector<double> distanceMm;
    std::vector<int>
        into;  ///< the half-edge by which the path from the root arrives; −1 at the root
};

PathTree shortestPaths(const HalfedgeMesh& mesh, int root) {
    PathTree tree{std::vector<double>(mesh.vertexCount(), std::numeric_limits<double>::infinity()),
                  std::vector<int>(mesh.vertexCount(), -1)};
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    tree.distanceMm[root] = 0.0;
    queue.push({0.0, root});
    while (!queue.empty()) {
        const auto [distance, v] = queue.top();
        queue.pop();
        if (distance > tree.distanceMm[v]) continue;
        int h = mesh.outgoing(v);
        do {
            const int w = mesh.target(h);
            const double there = distance + mesh.lengthMm(h);
            if (there < tree.distanceMm[w]) {
                tree.distanceMm[w] = there;
                tree.into[w] = h;
                queue.push({there, w});
            }
            h = mesh.turnLeft(h);
        } while (h != mesh.outgoing(v));
    }
    return tree;
}

/// From the root along the tree, over `closing`, and back along the tree.
Loop treeLoop(const HalfedgeMesh& mesh, const PathTree& tree, int closing) {
    Loop loop;
    for (int v = mesh.origin(closing); tree.into[v] >= 0; v = mesh.origin(tree.into[v]))
        loop.halfedges.push_back(tree.into[v]);
    std::reverse(loop.halfedges.begin(), loop.halfedges.end());
    loop.halfedges.push_back(closing);
    for (int v = mesh.target(closing); tree.into[v] >= 0; v = mesh.origin(tree.into[v]))
        loop.halfedges.push_back(mesh.opposite(tree.into[v]));
    for (const int h : loop.halfedges)
        loop.lengthMm += mesh.lengthMm(h);
    return loop;
}

/// Takes away edges that end nowhere, which do not hold the disc's sides together.
void prune(const HalfedgeMesh& mesh, std::vector<char>& cut) {
    std::vector<int> degree(mesh.vertexCount(), 0), ends;
    for (int h = 0; h < mesh.halfedgeCount(); ++h)
        degree[mesh.origin(h)] += cut[h];
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        if (degree[v] == 1) ends.push_back(v);
    }
    while (!ends.empty()) {
        const int v = ends.back();
        ends.pop_back();
        if (degree[v] != 1) continue;
        int h = mesh.outgoing(v);
        while (!cut[h])
            h = mesh.turnLeft(h);
        cut[h] = cut[mesh.opposite(h)] = 0;
        degree[v] = 0;
        if (--degree[mesh.target(h)] == 1) ends.push_back(mesh.target(h));
    }
}

}  // namespace

CutGraph makeCutGraph(const HalfedgeMesh& mesh, int root) {
    const PathTree tree = shortestPaths(mesh, root);
    CutGraph graph;
    graph.cut.assign(mesh.halfedgeCount(), 0);
    for (const int h : tree.into) {
        if (h >= 0) graph.cut[h] = graph.cut[mesh.opposite(h)] = 1;
    }
    std::vector<std::pair<double, int>> others;
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        if (graph.cut[h] || h > mesh.opposite(h)) continue;
        others.push_back(
            {tree.distanceMm[mesh.origin(h)] + mesh.lengthMm(h) + tree.distanceMm[mesh.target(h)],
             h});
    }
    std::sort(others.begin(), others.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    std::vector<int> parent(mesh.halfedgeCount() / 3), closing;
    std::iota(parent.begin(), parent.end(), 0);
    for (const auto& [length, h] : others) {
        const int a = h / 3, b = mesh.opposite(h) / 3;
        if (rootOf(parent, a) != rootOf(parent, b)) {
            unite(parent, a, b);
        } else {
            closing.push_back(h);
        }
    }
    std::reverse(closing.begin(), closing.end());
    for (const int h : closing) {
        graph.cut[h] = graph.cut[mesh.opposite(h)] = 1;
        graph.basis.push_back(treeLoop(mesh, tree, h));
    }
    prune(mesh, graph.cut);
    return graph;
}

}  // namespace haustra::mesh
