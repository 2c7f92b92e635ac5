#include "handles/covering_space.h"

#include "handles/loop_front.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace haustra::handles {
namespace {

/// The disc's boundary, counter-clockwise, from the start of a side on.
std::vector<int> boundaryWalk(const mesh::HalfedgeMesh& mesh, const std::vector<char>& cut,
                              const std::vector<int>& degree) {
    std::vector<int> walk;
    int start = 0;
    while (start < mesh.halfedgeCount() && !(cut[start] && degree[mesh.origin(start)] > 2))
        ++start;
    if (start == mesh.halfedgeCount()) return walk;
    int h = start;
    do {
        walk.push_back(h);
        h = mesh::HalfedgeMesh::next(h);
        while (!cut[h])
            h = mesh::HalfedgeMesh::next(mesh.opposite(h));
    } while (h != start);
    return walk;
}

}  // namespace

int FundamentalDomain::nextCorner(int side) const {
    return (partner[side] + 1) % int(sides.size());
}

FundamentalDomain slice(const mesh::HalfedgeMesh& mesh, const mesh::CutGraph& graph) {
    std::vector<int> degree(mesh.vertexCount(), 0);
    for (int h = 0; h < mesh.halfedgeCount(); ++h)
        degree[mesh.origin(h)] += graph.cut[h];
    FundamentalDomain domain;
    domain.sideOf.assign(mesh.halfedgeCount(), -1);
    for (const int h : boundaryWalk(mesh, graph.cut, degree)) {
        if (degree[mesh.origin(h)] > 2) domain.sides.emplace_back();
        domain.sides.back().push_back(h);
        domain.sideOf[h] = int(domain.sides.size()) - 1;
    }
    for (const auto& side : domain.sides) {
        domain.partner.push_back(domain.sideOf[mesh.opposite(side.front())]);
        domain.ring.push_back(degree[mesh.origin(side.front())]);
    }
    return domain;
}

CoveringSpace::CoveringSpace(const mesh::HalfedgeMesh& mesh, const FundamentalDomain& domain)
    : mesh_(mesh), domain_(domain), turning_(std::size_t(mesh.halfedgeCount())) {
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        const int first = mesh.outgoing(v);
        if (first < 0) continue;
        for (int h = first; mesh.turnLeft(h) != first; h = mesh.turnLeft(h)) {
            const int left = mesh.turnLeft(h),
                      side = domain.sideOf[mesh::HalfedgeMesh::previous(h)];
            turning_[left] = turning_[h];
            if (side >= 0) turning_[left].push_back(side);
        }
    }
    addCopy();
}

int CoveringSpace::addCopy() {
    neighbours_.resize(neighbours_.size() + domain_.sides.size(), -1);
    return copies() - 1;
}

int CoveringSpace::across(int copy, int side) {
    if (neighbour(copy, side) < 0) glue(copy, side, addCopy());
    return neighbour(copy, side);
}

void CoveringSpace::glue(int copy, int side, int other) {
    const int partner = domain_.partner[side];
    neighbours_[slot(copy, side)] = other;
    neighbours_[slot(other, partner)] = copy;
    closeRing(copy, side);
    closeRing(other, partner);
}

void CoveringSpace::closeRing(int copy, int corner) {
    const int sides = int(domain_.sides.size());
    int count = 1, endCopy = copy, endCorner = corner;
    while (neighbour(endCopy, endCorner) >= 0) {
        const int next = neighbour(endCopy, endCorner);
        endCorner = domain_.nextCorner(endCorner);
        endCopy = next;
        if (endCopy == copy && endCorner == corner) return;  // closed already
        ++count;
    }
    int startCopy = copy, startCorner = corner;
    for (int before = (corner + sides - 1) % sides; neighbour(startCopy, before) >= 0;
         before = (startCorner + sides - 1) % sides) {
        const int next = neighbour(startCopy, before);
        startCorner = domain_.partner[before];
        startCopy = next;
        ++count;
    }
    if (count == domain_.ring[corner]) glue(endCopy, endCorner, startCopy);
}

int CoveringSpace::along(int copy, int h) {
    for (const int side : turning_[h])
        copy = across(copy, side);
    const auto& back = turning_[mesh::HalfedgeMesh::next(h)];
    for (std::size_t i = back.size(); i-- > 0;)
        copy = across(copy, domain_.partner[back[i]]);
    return copy;
}

std::vector<mesh::Loop> coveringLoops(const mesh::HalfedgeMesh& mesh,
                                      const std::vector<std::uint64_t>& marks, double slack) {
    std::vector<mesh::Loop> loops;
    int root = 0;
    while (root < mesh.vertexCount() && mesh.outgoing(root) < 0)
        ++root;
    if (root == mesh.vertexCount()) return loops;
    const mesh::CutGraph graph = mesh::makeCutGraph(mesh, root);
    if (graph.basis.empty()) return loops;
    const FundamentalDomain domain = slice(mesh, graph);
    CoveringSpace cover(mesh, domain);

    struct Lift {
        int copy = 0;
        std::uint64_t marks = 0;
    };
    std::vector<Lift> lifts(std::size_t(mesh.vertexCount()));
    LoopFront front(mesh);
    double shortestMm = std::numeric_limits<double>::infinity();
    for (int base = 0; base < mesh.vertexCount(); ++base) {
        int h = mesh.outgoing(base);
        if (h < 0) continue;
        do {
            h = mesh.turnLeft(h);
        } while (!graph.cut[h] && h != mesh.outgoing(base));
        if (!graph.cut[h]) continue;

        lifts[base] = {};
        const auto reach = [&](int into) {
            const Lift& from = lifts[mesh.origin(into)];
            lifts[mesh.target(into)] = {cover.along(from.copy, into), from.marks ^ marks[into]};
        };
        const auto closes = [&](int over) {
            const Lift &from = lifts[mesh.origin(over)], &to = lifts[mesh.target(over)];
            return cover.along(from.copy, over) != to.copy &&
                   (from.marks ^ marks[over]) != to.marks;
        };
        const int closing = front.run(base, slack * shortestMm, reach, closes);
        if (closing < 0) continue;
        loops.push_back(front.loopOver(closing));
        shortestMm = std::min(shortestMm, loops.back().lengthMm);
    }
    std::stable_sort(loops.begin(), loops.end(), [](const mesh::Loop& a, const mesh::Loop& b) {
        return a.lengthMm < b.lengthMm;
    });
    return loops;
}

}  // namespace haustra::handles
