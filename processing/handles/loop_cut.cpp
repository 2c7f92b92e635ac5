#include "handles/loop_cut.h"

#include "handles/hole_fill.h"

#include <algorithm>
#include <cmath>

namespace haustra::handles {
namespace {

/// How far a lip is drawn back, of the least height of the triangles that it moves.
constexpr double lipShare = 0.2;

/// One side of the loop: for each of its vertices, the half-edges round it on that side, from one
/// loop edge to the other.
struct Lip {
    std::vector<std::vector<int>>
        fans;  // outgoing half-edges, counter-clockwise, without the last edge
};

Lip lipOf(const mesh::HalfedgeMesh& halves, const mesh::Loop& loop, bool left) {
    Lip lip;
    const std::size_t n = loop.halfedges.size();
    for (std::size_t i = 0; i < n; ++i) {
        const int out = loop.halfedges[i], in = halves.opposite(loop.halfedges[(i + n - 1) % n]);
        std::vector<int>& fan = lip.fans.emplace_back();
        for (int h = left ? out : in; h != (left ? in : out); h = halves.turnLeft(h))
            fan.push_back(h);
    }
    return lip;
}

/// How each vertex of a lip moves away from the loop, over the surface.
std::vector<glm::dvec3> drawBack(const TriMesh& mesh, const mesh::HalfedgeMesh& halves,
                                 const Lip& lip) {
    const std::size_t n = lip.fans.size();
    std::vector<glm::dvec3> direction(n);
    std::vector<double> reach(n);
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 here = mesh.vertices[halves.origin(lip.fans[i][0])];
        glm::dvec3 towards(0.0);
        double height = glm::distance(here, mesh.vertices[halves.target(lip.fans[i][0])]);
        for (const int h : lip.fans[i]) {
            const glm::dvec3 &b = mesh.vertices[halves.target(h)],
                             &c = mesh.vertices[halves.target(mesh::HalfedgeMesh::next(h))];
            const glm::dvec3 normal = glm::cross(b - here, c - here);
            const double opposite = glm::distance(b, c);
            // Weighted by angle, each triangle pulls towards the middle of its far edge.
            const double angle = std::atan2(glm::length(normal), glm::dot(b - here, c - here));
            towards += angle * glm::normalize(0.5 * (b + c) - here);
            if (opposite > 0.0) height = std::min(height, glm::length(normal) / opposite);
        }
        direction[i] = glm::length(towards) > 0.0 ? glm::normalize(towards) : glm::dvec3(0.0);
        reach[i] = lipShare * height;
    }
    std::vector<glm::dvec3> moves(n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
        moves[i] = std::min({reach[before], reach[i], reach[after]}) * direction[i];
    }
    return moves;
}

/// Adds a disc over the `rim` vertices, which have moved by `moves`.
void addDisc(TriMesh& mesh, const LoopDisc& disc, const std::vector<int>& rim,
             const std::vector<glm::dvec3>& moves, bool reversed) {
    const int inner = int(mesh.vertices.size());
    const auto inside = extendInside(disc, moves);
    for (std::size_t i = 0; i < inside.size(); ++i)
        mesh.vertices.push_back(disc.interior[i] + inside[i]);
    const auto numberOf = [&](int v) {
        return v < disc.corners ? rim[std::size_t(v)] : inner + v - disc.corners;
    };
    for (glm::ivec3 t : disc.triangles) {
        if (reversed) std::swap(t.y, t.z);
        mesh.triangles.push_back({numberOf(t.x), numberOf(t.y), numberOf(t.z)});
    }
}

}  // namespace

LoopCut cutAlong(const TriMesh& mesh, const mesh::HalfedgeMesh& halves, const mesh::Loop& loop) {
    LoopCut cut{mesh, 0.0, mesh.triangles.size()};
    const std::size_t n = loop.halfedges.size();
    std::vector<glm::dvec3> polygon;
    std::vector<int> leftRim, rightRim;
    for (std::size_t i = 0; i < n; ++i) {
        leftRim.push_back(halves.origin(loop.halfedges[i]));
        rightRim.push_back(int(mesh.vertices.size() + i));
        polygon.push_back(mesh.vertices[leftRim[i]]);
    }
    const Lip left = lipOf(halves, loop, true), right = lipOf(halves, loop, false);
    const auto leftMoves = drawBack(mesh, halves, left), rightMoves = drawBack(mesh, halves, right);
    for (std::size_t i = 0; i < n; ++i) {
        cut.mesh.vertices[leftRim[i]] = polygon[i] + leftMoves[i];
        cut.mesh.vertices.push_back(polygon[i] + rightMoves[i]);
        for (const int h : right.fans[i])
            cut.mesh.triangles[h / 3][h % 3] = rightRim[i];
    }
    const LoopDisc disc = spanLoop(polygon);
    addDisc(cut.mesh, disc, leftRim, leftMoves, true);
    addDisc(cut.mesh, disc, rightRim, rightMoves, false);
    for (std::size_t t = cut.firstFilled; t < cut.mesh.triangles.size(); ++t)
        cut.filledAreaMm2 += triangleAreaMm2(cut.mesh, cut.mesh.triangles[t]);
    return cut;
}

}  // namespace haustra::handles
