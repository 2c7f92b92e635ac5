#include "simplification/mesh.h"

#include <algorithm>

namespace haustra::simplification {

int CornerMesh::cornerOfEdge(int a, int b) const {
    int found = -1;
    aroundVertex(a, [&](int corner) {
        if (vertex[next(corner)] == b) found = corner;
    });
    return found;
}

void CornerMesh::join(int cornerA, int cornerB) {
    opposite[cornerA] = cornerB;
    opposite[cornerB] = cornerA;
}

void CornerMesh::collapse(int cornerAtA) {
    const int cornerAtB = next(cornerAtA), facing = previous(cornerAtA);
    const int across = opposite[facing];
    const int a = vertex[cornerAtA], b = vertex[cornerAtB];
    const int c = vertex[facing], d = vertex[across];
    aroundVertex(b, [&](int corner) { vertex[corner] = a; });

    // What lay beyond the two removed triangles' outer edges now lies edge to edge.
    const int beyondBC = opposite[cornerAtA], beyondCA = opposite[cornerAtB];
    const int beyondAD = opposite[next(across)], beyondDB = opposite[previous(across)];
    join(beyondBC, beyondCA);
    join(beyondAD, beyondDB);
    for (const int triangle : {cornerAtA / 3, across / 3})
        std::fill_n(vertex.begin() + 3 * triangle, 3, -1);

    cornerOf[b] = -1;
    cornerOf[c] = next(beyondBC);
    cornerOf[a] = previous(beyondBC);
    cornerOf[d] = previous(beyondDB);
    valence[a] += valence[b] - 4;
    --valence[c];
    --valence[d];
}

void CornerMesh::flip(int corner) {
    // Triangles (c, a, b) and (d, b, a) become (c, a, d) and (d, b, c).
    const int c = corner, a = next(c), b = previous(c);
    const int d = opposite[c], b2 = next(d), a2 = previous(d);
    const int vertexA = vertex[a], vertexB = vertex[b], vertexC = vertex[c], vertexD = vertex[d];
    const int beyondA = opposite[a], beyondB2 = opposite[b2];
    vertex[b] = vertexD;
    vertex[a2] = vertexC;
    join(c, beyondB2);
    join(d, beyondA);
    join(a, b2);
    cornerOf[vertexA] = a;
    cornerOf[vertexB] = b2;
    cornerOf[vertexC] = c;
    cornerOf[vertexD] = d;
    --valence[vertexA];
    --valence[vertexB];
    ++valence[vertexC];
    ++valence[vertexD];
}

Result<CornerMesh> cornerMesh(const TriMesh& mesh) {
    const char* const place = "simplification";
    CornerMesh result;
    result.position = mesh.vertices;
    result.cornerOf.assign(mesh.vertices.size(), -1);
    result.valence.assign(mesh.vertices.size(), 0);
    result.vertex.reserve(3 * mesh.triangles.size());
    for (const glm::ivec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            if (t[k] < 0 || t[k] >= int(mesh.vertices.size()))
                return fail(ErrorKind::badInput, "a triangle names no vertex", place);
            if (t[k] == t[(k + 1) % 3])
                return fail(ErrorKind::badInput, "a triangle has a corner twice", place);
            result.cornerOf[t[k]] = int(result.vertex.size());
            ++result.valence[t[k]];
            result.vertex.push_back(t[k]);
        }
    }

    // Corners by the lower vertex of the edge that they face, so that the two of an edge meet.
    const int corners = int(result.vertex.size());
    result.opposite.assign(corners, -1);
    const auto edgeOf = [&](int corner) {
        return std::minmax(result.vertex[CornerMesh::next(corner)],
                           result.vertex[CornerMesh::previous(corner)]);
    };
    std::vector<int> start(mesh.vertices.size() + 1, 0), sorted(corners);
    for (int c = 0; c < corners; ++c) {
        const auto [low, high] = edgeOf(c);
        ++start[low + 1];
    }
    for (std::size_t v = 1; v < start.size(); ++v)
        start[v] += start[v - 1];
    std::vector<int> fill(start.begin(), start.end() - 1);
    for (int c = 0; c < corners; ++c) {
        const auto [low, high] = edgeOf(c);
        sorted[fill[low]++] = c;
    }
    for (std::size_t v = 0; v + 1 < start.size(); ++v) {
        for (int i = start[v]; i < start[v + 1]; ++i) {
            for (int j = i + 1; j < start[v + 1]; ++j) {
                const int c = sorted[i], d = sorted[j];
                if (edgeOf(c).second != edgeOf(d).second) continue;
                const bool sameWay =
                    result.vertex[CornerMesh::next(c)] == result.vertex[CornerMesh::next(d)];
                if (sameWay || result.opposite[c] >= 0 || result.opposite[d] >= 0)
                    return fail(ErrorKind::badInput, "the mesh is not manifold", place);
                result.opposite[c] = d;
                result.opposite[d] = c;
            }
            if (result.opposite[sorted[i]] < 0)
                return fail(ErrorKind::badInput, "the mesh is not closed", place);
        }
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (result.cornerOf[v] < 0) continue;
        int fan = 0;
        result.aroundVertex(int(v), [&](int) { ++fan; });
        if (fan != result.valence[v])
            return fail(ErrorKind::badInput, "the mesh is not manifold at a vertex", place);
    }
    return result;
}

TriMesh triMesh(const CornerMesh& mesh) {
    TriMesh result;
    std::vector<int> index(mesh.position.size(), -1);
    for (std::size_t v = 0; v < mesh.position.size(); ++v) {
        if (mesh.cornerOf[v] < 0) continue;
        index[v] = int(result.vertices.size());
        result.vertices.push_back(mesh.position[v]);
    }
    for (int t = 0; t < mesh.triangleCount(); ++t) {
        if (!mesh.alive(t)) continue;
        const int* v = &mesh.vertex[3 * t];
        result.triangles.push_back({index[v[0]], index[v[1]], index[v[2]]});
    }
    return result;
}

}  // namespace haustra::simplification
