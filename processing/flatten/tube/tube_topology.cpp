#include "flatten/tube/tube_topology.h"

#include <algorithm>
#include <string>
#include <utility>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

/// The boundary loops, in the order of their lowest half-edges.
std::vector<std::vector<int>> boundaryLoops(const HalfedgeMesh& mesh) {
    std::vector<std::vector<int>> loops;
    std::vector<char> seen(std::size_t(mesh.vertexCount()), 0);
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        if (mesh.opposite(h) >= 0 || seen[std::size_t(mesh.origin(h))]) continue;
        loops.emplace_back();
        // A rim vertex's first outgoing half-edge is the one along the rim.
        for (int v = mesh.origin(h); !seen[std::size_t(v)]; v = mesh.target(mesh.outgoing(v))) {
            seen[std::size_t(v)] = 1;
            loops.back().push_back(v);
        }
    }
    return loops;
}

/// Calls visit(w, h) for each neighbour w of v; h is the half-edge between them, either way.
template <class Visit>
void forNeighbours(const HalfedgeMesh& mesh, int v, const Visit& visit) {
    const int first = mesh.outgoing(v);
    int h = first;
    do {
        visit(mesh.target(h));
        const int left = mesh.turnLeft(h);
        if (left < 0) visit(mesh.origin(HalfedgeMesh::previous(h)));
        h = left;
    } while (h >= 0 && h != first);
}

struct BreadthFirst {
    std::vector<int> order;
    std::vector<int> from;  ///< per vertex: the one it was reached from, or itself
    std::vector<int> levelStart;
};

BreadthFirst breadthFirst(const HalfedgeMesh& mesh, const std::vector<int>& start) {
    BreadthFirst found{start, std::vector<int>(std::size_t(mesh.vertexCount()), -1), {0}};
    found.order.reserve(std::size_t(mesh.vertexCount()));
    for (const int v : start)
        found.from[std::size_t(v)] = v;
    std::size_t levelEnd = start.size();
    for (std::size_t n = 0; n < found.order.size(); ++n) {
        if (n == levelEnd) {
            found.levelStart.push_back(int(n));
            levelEnd = found.order.size();
        }
        const int v = found.order[n];
        forNeighbours(mesh, v, [&](int w) {
            if (found.from[std::size_t(w)] >= 0) return;
            found.from[std::size_t(w)] = v;
            found.order.push_back(w);
        });
    }
    found.levelStart.push_back(int(found.order.size()));
    return found;
}

/// The half-edge from a to b, or −1 where only b's triangle has it.
int halfedgeBetween(const HalfedgeMesh& mesh, int a, int b) {
    const int first = mesh.outgoing(a);
    int h = first;
    do {
        if (mesh.target(h) == b) return h;
        h = mesh.turnLeft(h);
    } while (h >= 0 && h != first);
    return -1;
}

/// `path` leads from one rim to the other and touches them with its ends alone, so each of its
/// edges has two triangles.
std::vector<std::int8_t> turnsLeftOf(const HalfedgeMesh& mesh, const std::vector<int>& path) {
    std::vector<std::int8_t> turns(std::size_t(mesh.halfedgeCount()), 0);
    int cameAlong = -1;
    for (std::size_t n = 0; n + 1 < path.size(); ++n) {
        const int along = halfedgeBetween(mesh, path[n], path[n + 1]);
        const int back = cameAlong < 0 ? -1 : mesh.opposite(cameAlong);
        for (int h = along; h >= 0 && h != back; h = mesh.turnLeft(h))
            turns[std::size_t(h)] = 1;
        cameAlong = along;
    }
    // At the far rim the triangles to the left are those clockwise of the way back.
    for (int h = cameAlong; h >= 0; h = mesh.opposite(HalfedgeMesh::next(h)))
        turns[std::size_t(HalfedgeMesh::next(h))] = 1;
    return turns;
}

}  // namespace

Result<TubeTopology> tubeTopology(const HalfedgeMesh& mesh, int firstRim) {
    std::vector<std::vector<int>> loops = boundaryLoops(mesh);
    long vertices = 0, rimEdges = 0;
    for (int v = 0; v < mesh.vertexCount(); ++v)
        vertices += mesh.outgoing(v) >= 0;
    for (const auto& loop : loops)
        rimEdges += long(loop.size());
    const long edges = (mesh.halfedgeCount() + rimEdges) / 2, faces = mesh.halfedgeCount() / 3;
    const long euler = vertices - edges + faces;
    if (loops.size() != 2 || euler != 0) {
        const long genus = (2 - long(loops.size()) - euler) / 2;
        return fail(ErrorKind::badInput,
                    "the surface is not a tube: it has " + std::to_string(loops.size()) +
                        " boundary loops and, if it is one piece, genus " + std::to_string(genus) +
                        ", where two loops and genus 0 are needed");
    }
    const auto has = [&](const std::vector<int>& loop) {
        return std::find(loop.begin(), loop.end(), firstRim) != loop.end();
    };
    const auto lowest = [](const std::vector<int>& loop) {
        return *std::min_element(loop.begin(), loop.end());
    };
    if (firstRim >= 0 && !has(loops[0]) && !has(loops[1]))
        return fail(ErrorKind::badInput,
                    "the vertex that names the tube's first rim is on neither");
    const bool second = firstRim >= 0 ? has(loops[1]) : lowest(loops[1]) < lowest(loops[0]);
    if (second) std::swap(loops[0], loops[1]);

    BreadthFirst reached = breadthFirst(mesh, loops[0]);
    if (long(reached.order.size()) != vertices)
        return fail(ErrorKind::badInput, "the surface is not a tube: it has several pieces");

    std::vector<char> far(std::size_t(mesh.vertexCount()), 0);
    for (const int v : loops[1])
        far[std::size_t(v)] = 1;
    const auto end = std::find_if(reached.order.begin(), reached.order.end(),
                                  [&](int v) { return far[std::size_t(v)] != 0; });
    std::vector<int> path{*end};
    while (reached.from[std::size_t(path.back())] != path.back())
        path.push_back(reached.from[std::size_t(path.back())]);
    std::reverse(path.begin(), path.end());

    TubeTopology topology;
    topology.cornerTurns = turnsLeftOf(mesh, path);
    topology.rims[0] = std::move(loops[0]);
    topology.rims[1] = std::move(loops[1]);
    topology.breadthFirst = std::move(reached.order);
    topology.levelStart = std::move(reached.levelStart);
    return topology;
}

}  // namespace haustra::flatten
