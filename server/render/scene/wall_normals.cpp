#include "render/scene/wall_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace haustra::render {

std::vector<glm::dvec3> inwardNormals(const TriMesh& mesh) {
    std::vector<glm::dvec3> normals(mesh.vertices.size(), glm::dvec3(0.0));
    for (const glm::ivec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 at = mesh.vertices[std::size_t(triangle[corner])];
            const glm::dvec3 a = mesh.vertices[std::size_t(triangle[(corner + 1) % 3])] - at;
            const glm::dvec3 b = mesh.vertices[std::size_t(triangle[(corner + 2) % 3])] - at;
            const glm::dvec3 cross = glm::cross(a, b);
            const double length = glm::length(cross);
            // Counter-clockwise seen from outside: the cross product points out of the lumen.
            if (length > 0.0)
                normals[std::size_t(triangle[corner])] -=
                    std::atan2(length, glm::dot(a, b)) / length * cross;
        }
    }
    std::vector<int> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto place = [&](int vertex) {
        const glm::dvec3& p = mesh.vertices[std::size_t(vertex)];
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::tuple(place(a), a) < std::tuple(place(b), b); });
    for (auto first = order.begin(); first != order.end();) {
        const auto last =
            std::find_if(first, order.end(), [&](int v) { return place(v) != place(*first); });
        glm::dvec3 sum(0.0);
        for (auto it = first; it != last; ++it)
            sum += normals[std::size_t(*it)];
        const double length = glm::length(sum);
        for (auto it = first; it != last; ++it)
            normals[std::size_t(*it)] = length > 0.0 ? sum / length : glm::dvec3(0.0, 0.0, 1.0);
        first = last;
    }
    return normals;
}

}  // namespace haustra::render
