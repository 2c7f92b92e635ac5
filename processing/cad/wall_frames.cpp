#include "cad/wall_frames.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace haustra::cad {
namespace {

// How the place moves as y grows on this triangle; zero where the map has no area.
glm::dvec3 alongStrip(const FlatMap& flat, const glm::ivec3& t) {
    const glm::dvec3 a = flat.surface.vertices[std::size_t(t.x)],
                     u = flat.surface.vertices[std::size_t(t.y)] - a,
                     v = flat.surface.vertices[std::size_t(t.z)] - a;
    const glm::dvec2 fa = flat.flat[std::size_t(t.x)], fu = flat.flat[std::size_t(t.y)] - fa,
                     fv = flat.flat[std::size_t(t.z)] - fa;
    const double det = fu.x * fv.y - fu.y * fv.x;
    if (!(std::abs(det) > 1e-30)) return glm::dvec3(0.0);
    const glm::dvec3 way = (fu.x * v - fv.x * u) / det;
    const double length = glm::length(way);
    return length > 0.0 && std::isfinite(length) ? way / length : glm::dvec3(0.0);
}

}  // namespace

std::vector<glm::vec3> stripDirections(const WallSamples& samples, const FlatMap& flat,
                                       int threads) {
    const std::int32_t sources =
        samples.sourceTriangle.empty()
            ? 0
            : *std::max_element(samples.sourceTriangle.begin(), samples.sourceTriangle.end()) + 1;
    std::vector<glm::vec3> ofSource(std::size_t(sources), glm::vec3(0.0f));
    for (std::size_t t = 0; t < flat.surface.triangles.size(); ++t) {
        const std::int32_t source = flat.sourceTriangle[t];
        if (source >= 0 && source < sources)
            ofSource[std::size_t(source)] += glm::vec3(alongStrip(flat, flat.surface.triangles[t]));
    }
    std::vector<glm::vec3> directions(samples.mesh.vertices.size());
    parallelFor(directions.size(), 16384, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            glm::vec3 sum(0.0f);
            for (const std::uint32_t t : samples.trianglesAround(std::uint32_t(v)))
                sum += ofSource[std::size_t(samples.sourceTriangle[t])];
            const float length = glm::length(sum);
            directions[v] = length > 1e-6f ? sum / length : glm::vec3(0.0f, 0.0f, 1.0f);
        }
    });
    return directions;
}

}  // namespace haustra::cad
