#include "coverage/fine_wall.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace haustra::coverage {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;

Edge edgeOf(glm::ivec3 t, int side) {
    return std::minmax(t[side], t[(side + 1) % 3]);
}

/// One round: edges that are too long get a vertex in their middle, and triangles are cut there.
bool halveLongEdges(FineWall& wall, double mostMm) {
    auto& vertices = wall.mesh.vertices;
    const auto isLong = [&](Edge edge) {
        return glm::distance(vertices[std::size_t(edge.first)],
                             vertices[std::size_t(edge.second)]) > mostMm;
    };
    std::vector<Edge> edges;
    for (const glm::ivec3& t : wall.mesh.triangles)
        for (int side = 0; side < 3; ++side)
            if (const Edge edge = edgeOf(t, side); isLong(edge)) edges.push_back(edge);
    if (edges.empty()) return false;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const auto first = std::int32_t(vertices.size());
    for (const auto& [a, b] : edges)
        vertices.push_back(0.5 * (vertices[std::size_t(a)] + vertices[std::size_t(b)]));
    const auto middleOf = [&](Edge edge) {
        const auto found = std::lower_bound(edges.begin(), edges.end(), edge);
        return found != edges.end() && *found == edge ? first + std::int32_t(found - edges.begin())
                                                      : -1;
    };

    std::vector<glm::ivec3> cut;
    std::vector<std::int32_t> source;
    for (std::size_t n = 0; n < wall.mesh.triangles.size(); ++n) {
        const glm::ivec3 t = wall.mesh.triangles[n];
        const glm::ivec3 m(middleOf(edgeOf(t, 0)), middleOf(edgeOf(t, 1)), middleOf(edgeOf(t, 2)));
        const auto add = [&](int a, int b, int c) {
            cut.push_back({a, b, c});
            source.push_back(wall.sourceTriangle[n]);
        };
        const int halved = (m.x >= 0) + (m.y >= 0) + (m.z >= 0);
        if (halved == 0) {
            add(t.x, t.y, t.z);
        } else if (halved == 3) {
            add(t.x, m.x, m.z), add(m.x, t.y, m.y), add(m.z, m.y, t.z), add(m.x, m.y, m.z);
        } else {
            // Turned so that the first edge is halved and, of two, the second.
            int k = 0;
            while (m[k] < 0 || (halved == 2 && m[(k + 1) % 3] < 0))
                ++k;
            const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], ab = m[k],
                      bc = m[(k + 1) % 3];
            if (halved == 1) {
                add(a, ab, c), add(ab, b, c);
            } else {
                add(ab, b, bc);
                const double fromA =
                                 glm::distance(vertices[std::size_t(a)], vertices[std::size_t(bc)]),
                             fromC =
                                 glm::distance(vertices[std::size_t(c)], vertices[std::size_t(ab)]);
                if (fromA <= fromC)
                    add(a, ab, bc), add(a, bc, c);
                else
                    add(a, ab, c), add(ab, bc, c);
            }
        }
    }
    wall.mesh.triangles = std::move(cut);
    wall.sourceTriangle = std::move(source);
    return true;
}

}  // namespace

FineWall fineWall(const TriMesh& wall, double mostMm) {
    FineWall fine{wall, std::vector<std::int32_t>(wall.triangles.size())};
    std::iota(fine.sourceTriangle.begin(), fine.sourceTriangle.end(), 0);
    while (halveLongEdges(fine, mostMm)) {
    }
    return fine;
}

}  // namespace haustra::coverage
