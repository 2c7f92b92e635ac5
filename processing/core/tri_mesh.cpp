#include "core/tri_mesh.h"

#include "core/disjoint_sets.h"

#include <algorithm>
#include <numeric>

namespace haustra {

MeshTopology meshTopology(const TriMesh& mesh) {
    struct Edge {
        int low, high;
        bool forward;
    };
    std::vector<Edge> edges;
    edges.reserve(mesh.triangles.size() * 3);
    std::vector<int> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0);
    std::vector<char> used(mesh.vertices.size(), 0);
    for (const glm::ivec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const int a = t[corner], b = t[(corner + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b});
            used[a] = 1;
            unite(parent, a, b);
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });

    MeshTopology topology;
    long edgeCount = 0;
    for (std::size_t first = 0, last; first < edges.size(); first = last) {
        int forward = 0;
        for (last = first; last < edges.size() && edges[last].low == edges[first].low &&
                           edges[last].high == edges[first].high;
             ++last) {
            forward += edges[last].forward;
        }
        const std::size_t sides = last - first;
        ++edgeCount;
        if (sides == 1) ++topology.boundaryEdges;
        if (sides > 2 || (sides == 2 && forward != 1)) ++topology.nonManifoldEdges;
    }
    long vertexCount = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (!used[v]) continue;
        ++vertexCount;
        if (rootOf(parent, int(v)) == int(v)) ++topology.components;
    }
    topology.eulerCharacteristic = vertexCount - edgeCount + long(mesh.triangles.size());
    return topology;
}

}  // namespace haustra
