#include "flatten/general/homology_basis.h"

#include "core/flood_fill.h"
#include "mesh/cut_graph.h"

#include <algorithm>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

int firstUsedVertex(const HalfedgeMesh& mesh) {
    int v = 0;
    while (v < mesh.vertexCount() && mesh.outgoing(v) < 0)
        ++v;
    return v;
}

bool connected(const HalfedgeMesh& mesh) {
    std::vector<char> seen(std::size_t(mesh.halfedgeCount() / 3), 0);
    std::vector<int> reached{0};
    seen[0] = 1;
    const auto beside = [&](int t, const auto& visit) {
        for (int h = 3 * t; h < 3 * t + 3; ++h)
            visit(mesh.opposite(h) / 3);
    };
    floodFill(reached, beside, [&](int t) {
        if (seen[t]) return false;
        seen[t] = 1;
        return true;
    });
    return reached.size() == seen.size();
}

/// Breadth first over the vertices of the cut graph: the half-edge by which each is reached, −1 for
/// the first and for those that are not on it.
std::vector<int> treeOfCutGraph(const HalfedgeMesh& mesh, const std::vector<char>& cut) {
    std::vector<int> into(mesh.vertexCount(), -1);
    const auto first = std::find(cut.begin(), cut.end(), 1);
    if (first == cut.end()) return into;
    const int root = mesh.origin(int(first - cut.begin()));
    std::vector<int> reached{root};
    const auto cutEdges = [&](int v, const auto& visit) {
        int h = mesh.outgoing(v);
        do {
            if (cut[h]) visit(mesh.target(h), h);
            h = mesh.turnLeft(h);
        } while (h != mesh.outgoing(v));
    };
    floodFill(reached, cutEdges, [&](int w, int h) {
        if (w == root || into[w] >= 0) return false;
        into[w] = h;
        return true;
    });
    return into;
}

/// Over `closing` and back to its origin along the tree.
mesh::Loop loopThrough(const HalfedgeMesh& mesh, const std::vector<int>& into, int closing) {
    const auto toRoot = [&](int v) {
        std::vector<int> path;
        for (; into[v] >= 0; v = mesh.origin(into[v]))
            path.push_back(into[v]);
        return path;
    };
    std::vector<int> down = toRoot(mesh.origin(closing)), up = toRoot(mesh.target(closing));
    while (!down.empty() && !up.empty() && down.back() == up.back()) {
        down.pop_back();
        up.pop_back();
    }
    mesh::Loop loop;
    loop.halfedges.push_back(closing);
    for (const int h : up)
        loop.halfedges.push_back(mesh.opposite(h));
    loop.halfedges.insert(loop.halfedges.end(), down.rbegin(), down.rend());
    for (const int h : loop.halfedges)
        loop.lengthMm += mesh.lengthMm(h);
    return loop;
}

/// Breadth first over the triangles of the disc: the half-edge by which each is left towards the
/// first, −1 there.
std::vector<int> treeOfDisc(const HalfedgeMesh& mesh, const std::vector<char>& cut) {
    std::vector<int> leaves(std::size_t(mesh.halfedgeCount() / 3), -1), reached{0};
    const auto beside = [&](int t, const auto& visit) {
        for (int h = 3 * t; h < 3 * t + 3; ++h) {
            if (!cut[h]) visit(mesh.opposite(h) / 3, mesh.opposite(h));
        }
    };
    floodFill(reached, beside, [&](int t, int back) {
        if (t == 0 || leaves[t] >= 0) return false;
        leaves[t] = back;
        return true;
    });
    return leaves;
}

/// Crossings of the closed curve that crosses `closing` from its left to its right.
std::vector<std::int8_t> crossings(const HalfedgeMesh& mesh, const std::vector<int>& leaves,
                                   int closing) {
    std::vector<std::int8_t> form(std::size_t(mesh.halfedgeCount()), 0);
    const auto cross = [&](int h, int sign) {
        form[h] = std::int8_t(form[h] + sign);
        form[mesh.opposite(h)] = std::int8_t(form[mesh.opposite(h)] - sign);
    };
    cross(closing, 1);
    for (int t = mesh.opposite(closing) / 3; leaves[t] >= 0; t = mesh.opposite(leaves[t]) / 3)
        cross(leaves[t], 1);
    for (int t = closing / 3; leaves[t] >= 0; t = mesh.opposite(leaves[t]) / 3)
        cross(leaves[t], -1);
    return form;
}

int wedgeOf(const std::vector<std::int8_t>& a, const std::vector<std::int8_t>& b) {
    int twice = 0;
    for (std::size_t h = 0; h < a.size(); h += 3)
        twice += a[h] * b[h + 1] - a[h + 1] * b[h];
    return twice / 2;
}

}  // namespace

Result<HomologyBasis> homologyBasis(const HalfedgeMesh& mesh) {
    if (mesh.halfedgeCount() == 0) return fail(ErrorKind::badInput, "the surface has no triangles");
    if (!mesh.closed())
        return fail(ErrorKind::badInput, "the surface is not closed: an edge has one triangle");
    if (!connected(mesh)) return fail(ErrorKind::badInput, "the surface is not in one piece");

    const std::vector<char> cut = mesh::makeCutGraph(mesh, firstUsedVertex(mesh)).cut;
    const std::vector<int> into = treeOfCutGraph(mesh, cut), leaves = treeOfDisc(mesh, cut);
    HomologyBasis basis;
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        const int other = mesh.opposite(h);
        if (!cut[h] || h > other || into[mesh.target(h)] == h || into[mesh.origin(h)] == other)
            continue;
        basis.loops.push_back(loopThrough(mesh, into, h));
        basis.dual.push_back(crossings(mesh, leaves, h));
    }
    const std::size_t count = basis.dual.size();
    basis.wedge.assign(count, std::vector<int>(count, 0));
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            basis.wedge[i][j] = wedgeOf(basis.dual[i], basis.dual[j]);
            basis.wedge[j][i] = -basis.wedge[i][j];
        }
    }
    return basis;
}

}  // namespace haustra::flatten
