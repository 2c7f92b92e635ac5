#include "simplification/simplification.h"

#include "simplification/region_simplification.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace haustra::simplification {
namespace {

std::vector<Quadric> inputQuadrics(const CornerMesh& mesh) {
    std::vector<Quadric> quadric(mesh.position.size());
    for (int t = 0; t < mesh.triangleCount(); ++t) {
        const int* v = &mesh.vertex[3 * t];
        const glm::dvec3 a = mesh.position[v[0]];
        const glm::dvec3 upright = glm::cross(mesh.position[v[1]] - a, mesh.position[v[2]] - a);
        const double twiceArea = glm::length(upright);
        if (!(twiceArea > 0.0)) continue;
        Quadric plane;
        plane.addPlane(a, upright / twiceArea, twiceArea / 6.0);
        for (int k = 0; k < 3; ++k)
            quadric[v[k]] = quadric[v[k]] + plane;
    }
    return quadric;
}

/// The bits of x, two zeros between each.
std::uint64_t spread(std::uint32_t x) {
    std::uint64_t bits = x & 0x1fffff;
    bits = (bits | bits << 32) & 0x1f00000000ffff;
    bits = (bits | bits << 16) & 0x1f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    bits = (bits | bits << 2) & 0x1249249249249249;
    return bits;
}

/// The mesh with vertices, and triangles by their first vertex, in Morton order: what is near in
/// space is then near in memory. Vertices are put on the mesh lattice about `low`, and moved by
/// −(low + middle).
TriMesh orderedInSpace(const TriMesh& mesh, const glm::dvec3& low, const glm::dvec3& middle) {
    std::vector<std::pair<std::uint64_t, int>> order(mesh.vertices.size());
    for (std::size_t v = 0; v < order.size(); ++v) {
        const glm::dvec3 place = onMeshLattice(mesh.vertices[v] - low);
        const glm::uvec3 cell(glm::clamp(place * 2.0, 0.0, 2097151.0));
        order[v] = {spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2, int(v)};
    }
    std::sort(order.begin(), order.end());
    TriMesh result;
    result.vertices.reserve(order.size());
    std::vector<int> rank(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        rank[order[i].second] = int(i);
        result.vertices.push_back(onMeshLattice(mesh.vertices[order[i].second] - low) - middle);
    }
    const auto firstOf = [](const glm::ivec3& t) { return std::min({t.x, t.y, t.z}); };
    std::vector<std::size_t> begin(order.size() + 1, 0);
    std::vector<glm::ivec3> renamed;
    renamed.reserve(mesh.triangles.size());
    for (const glm::ivec3& t : mesh.triangles) {
        renamed.push_back({rank[t.x], rank[t.y], rank[t.z]});
        ++begin[firstOf(renamed.back()) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    result.triangles.resize(renamed.size());
    std::vector<std::size_t> end(begin.begin(), begin.end() - 1);
    for (const glm::ivec3& t : renamed)
        result.triangles[end[firstOf(t)]++] = t;
    for (std::size_t v = 0; v < order.size(); ++v) {
        std::sort(result.triangles.begin() + std::ptrdiff_t(begin[v]),
                  result.triangles.begin() + std::ptrdiff_t(end[v]),
                  [](const glm::ivec3& s, const glm::ivec3& t) {
                      return std::tie(s.x, s.y, s.z) < std::tie(t.x, t.y, t.z);
                  });
    }
    return result;
}

/// No triangle may name what is no vertex, before anything is looked up.
bool indicesValid(const TriMesh& mesh) {
    return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const glm::ivec3& t) {
        return glm::all(glm::greaterThanEqual(t, glm::ivec3(0))) &&
               glm::all(glm::lessThan(t, glm::ivec3(int(mesh.vertices.size()))));
    });
}

}  // namespace

Result<TriMesh> simplify(const TriMesh& mesh, const SimplificationOptions& options) {
    if (mesh.triangles.empty()) return TriMesh{};
    if (!indicesValid(mesh))
        return fail(ErrorKind::badInput, "a triangle names no vertex", "simplification");
    glm::dvec3 low(std::numeric_limits<double>::max()), high = -low;
    for (const glm::dvec3& v : mesh.vertices) {
        low = glm::min(low, v);
        high = glm::max(high, v);
    }
    if (!(glm::all(glm::lessThan(glm::abs(low), glm::dvec3(farthestMm))) &&
          glm::all(glm::lessThan(glm::abs(high), glm::dvec3(farthestMm))))) {
        return fail(ErrorKind::badInput, "the mesh has no finite extent", "simplification");
    }
    // From the mesh alone, so that the same mesh elsewhere is simplified alike, to the last bit.
    const glm::dvec3 middle = glm::floor(0.5 * onMeshLattice(high - low));
    auto corners = TRY(cornerMesh(orderedInSpace(mesh, low, middle)));

    std::optional<ErrorBound> bound;
    std::vector<Quadric> quadric;
    parallelFor(2, 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (i == 0) {
                bound.emplace(corners, options.errorMm);
            } else {
                quadric = inputQuadrics(corners);
            }
        }
    });
    const std::size_t vertices = mesh.vertices.size();
    const auto triangles = std::size_t(corners.triangleCount());
    Simplification shared{std::move(corners),         std::move(*bound),
                          std::move(quadric),         std::vector<char>(vertices, 0),
                          std::vector<int>(vertices), std::vector<int>(triangles),
                          options.minAngleDegrees};

    struct Pass {
        std::size_t vertexLimit;
        double share;
    };
    // What a box cuts off in one pass most often lies inside a box of the next.
    const Pass passes[] = {{5000, 0.5}, {5000, 0.37}, {5000, 0.62}, {20000, 0.45}};
    double done = 0.0;
    for (const Pass& pass : passes) {
        const std::vector<Region> regions = partition(shared.mesh, pass.vertexLimit, pass.share);
        parallelFor(regions.size(), 1, options.threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                simplifyRegion(shared, regions[i]);
        });
        done += 1.0 / std::size(passes);
        if (options.progress) options.progress(done);
    }
    TriMesh result = triMesh(shared.mesh);
    for (glm::dvec3& v : result.vertices)
        v += low + middle;
    return result;
}

}  // namespace haustra::simplification
