#include "geodesic_frame.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

namespace haustra::bench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Calls visit(half-edge to a neighbour, neighbour) around a vertex; on a rim the last neighbour,
/// which no half-edge leads to, is left out.
template <class Visit>
void forEachNeighbour(const mesh::HalfedgeMesh& edges, int v, const Visit& visit) {
    const int first = edges.outgoing(v);
    int h = first;
    do {
        visit(edges.target(h), edges.lengthMm(h));
        h = edges.turnLeft(h);
    } while (h >= 0 && h != first);
}

glm::dvec3 normalAt(const TriMesh& mesh, const mesh::HalfedgeMesh& edges, int v) {
    glm::dvec3 sum(0.0);
    const int first = edges.outgoing(v);
    int h = first;
    do {
        const glm::dvec3 at = mesh.vertices[std::size_t(v)];
        sum += glm::cross(mesh.vertices[std::size_t(edges.target(h))] - at,
                          mesh.vertices[std::size_t(edges.origin(edges.previous(h)))] - at);
        h = edges.turnLeft(h);
    } while (h >= 0 && h != first);
    return glm::normalize(sum);
}

/// `v` turned as the shortest turn takes unit `from` to unit `to`.
glm::dvec3 turned(glm::dvec3 v, glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double cosine = glm::dot(from, to);
    if (cosine < -0.999) return v;
    return v * cosine + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1.0 + cosine));
}

using Front = std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>,
                                  std::greater<>>;

}  // namespace

std::vector<glm::dvec2> unroll(const TriMesh& mesh, const mesh::HalfedgeMesh& edges,
                               const std::vector<char>& inPatch) {
    std::vector<glm::dvec2> place(mesh.vertices.size(), glm::dvec2(0.0));
    std::map<int, double> depth;
    Front front;
    for (std::size_t v = 0; v < inPatch.size(); ++v) {
        if (!inPatch[v]) continue;
        forEachNeighbour(edges, int(v), [&](int w, double) {
            if (!inPatch[std::size_t(w)] && depth.emplace(w, 0.0).second) front.push({0.0, w});
        });
    }
    int middle = -1;
    while (!front.empty()) {
        const auto [mm, v] = front.top();
        front.pop();
        if (mm > depth[v]) continue;
        if (inPatch[std::size_t(v)]) middle = v;
        forEachNeighbour(edges, v, [&](int w, double length) {
            if (!inPatch[std::size_t(w)]) return;
            const auto known = depth.find(w);
            if (known != depth.end() && known->second <= mm + length) return;
            depth[w] = mm + length;
            front.push({mm + length, w});
        });
    }
    if (middle < 0) return place;

    struct Frame {
        double mm = infinity;
        glm::dvec3 normal, x;  ///< the plane of the middle, as transported here
        bool done = false;
    };
    std::map<int, Frame> frames;
    const glm::dvec3 normal = normalAt(mesh, edges, middle);
    const glm::dvec3 aside = std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    frames[middle] = {0.0, normal, glm::normalize(glm::cross(normal, aside))};
    front.push({0.0, middle});
    while (!front.empty()) {
        const auto [mm, v] = front.top();
        front.pop();
        Frame& here = frames[v];
        if (here.done) continue;
        here.done = true;
        // What is just outside is reached, and not passed through.
        if (!inPatch[std::size_t(v)]) continue;
        forEachNeighbour(edges, v, [&](int w, double length) {
            Frame& there = frames[w];
            if (there.mm <= mm + length) return;
            const glm::dvec3 edge = mesh.vertices[std::size_t(w)] - mesh.vertices[std::size_t(v)];
            const glm::dvec3 y = glm::cross(here.normal, here.x);
            glm::dvec2 move(glm::dot(edge, here.x), glm::dot(edge, y));
            move *= glm::length(move) > 0.0 ? length / glm::length(move) : 0.0;
            place[std::size_t(w)] = place[std::size_t(v)] + move;
            there.mm = mm + length;
            there.normal = normalAt(mesh, edges, w);
            const glm::dvec3 x = turned(here.x, here.normal, there.normal);
            there.x = glm::normalize(x - glm::dot(x, there.normal) * there.normal);
            front.push({there.mm, w});
        });
    }
    return place;
}

}  // namespace haustra::bench
