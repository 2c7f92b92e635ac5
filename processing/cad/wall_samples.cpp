#include "cad/wall_samples.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::cad {
namespace {

// One division of every triangle with a long edge into two, three or four.
class Division {
public:
    Division(WallSamples& samples, double mostMm)
        : samples_(samples),
          mostMm2_(mostMm * mostMm),
          firstOf_(samples.mesh.vertices.size(), -1) {}

    // False where no edge was too long.
    bool run() {
        std::vector<glm::ivec3> triangles;
        std::vector<std::int32_t> sources;
        triangles.reserve(samples_.mesh.triangles.size() * 4);
        sources.reserve(triangles.capacity());
        const std::size_t edges = samples_.mesh.triangles.size() * 3 / 2;
        middles_.reserve(edges);
        samples_.mesh.vertices.reserve(samples_.mesh.vertices.size() + edges);
        for (std::size_t t = 0; t < samples_.mesh.triangles.size(); ++t) {
            divide(samples_.mesh.triangles[t], triangles);
            sources.resize(triangles.size(), samples_.sourceTriangle[t]);
        }
        samples_.mesh.triangles = std::move(triangles);
        samples_.sourceTriangle = std::move(sources);
        return !middles_.empty();
    }

private:
    double squaredMm2(int a, int b) const {
        const glm::dvec3 edge =
            samples_.mesh.vertices[std::size_t(a)] - samples_.mesh.vertices[std::size_t(b)];
        return glm::dot(edge, edge);
    }

    // −1: the edge is short enough. One that takes an odd number of pieces is cut beside its
    // middle, where whole pieces lie on either side: three of 0.5 mm instead of four of 0.37 mm.
    int middleOf(int a, int b) {
        const double mm2 = squaredMm2(a, b);
        if (mm2 <= mostMm2_) return -1;
        if (a > b) std::swap(a, b);
        for (int n = firstOf_[std::size_t(a)]; n >= 0; n = middles_[std::size_t(n)].next)
            if (middles_[std::size_t(n)].otherEnd == b) return middles_[std::size_t(n)].vertex;
        const int vertex = int(samples_.mesh.vertices.size());
        middles_.push_back({b, vertex, firstOf_[std::size_t(a)]});
        firstOf_[std::size_t(a)] = int(middles_.size()) - 1;
        const double pieces = std::max(2.0, std::ceil(std::sqrt(mm2 / mostMm2_) - 1e-9));
        samples_.mesh.vertices.push_back(glm::mix(samples_.mesh.vertices[std::size_t(a)],
                                                  samples_.mesh.vertices[std::size_t(b)],
                                                  std::floor(0.5 * pieces) / pieces));
        return vertex;
    }

    void divide(glm::ivec3 t, std::vector<glm::ivec3>& out) {
        int m[3];
        int cut = 0;
        for (int n = 0; n < 3; ++n) {
            m[n] = middleOf(t[n], t[(n + 1) % 3]);
            cut += m[n] >= 0;
        }
        if (cut == 0) {
            out.push_back(t);
        } else if (cut == 3) {
            out.insert(out.end(), {glm::ivec3(t[0], m[0], m[2]), glm::ivec3(m[0], t[1], m[1]),
                                   glm::ivec3(m[2], m[1], t[2]), glm::ivec3(m[0], m[1], m[2])});
        } else if (cut == 1) {
            const int n = m[0] >= 0 ? 0 : m[1] >= 0 ? 1 : 2;
            const int a = t[n], b = t[(n + 1) % 3], c = t[(n + 2) % 3];
            out.insert(out.end(), {glm::ivec3(a, m[n], c), glm::ivec3(m[n], b, c)});
        } else {
            const int n = m[0] < 0 ? 0 : m[1] < 0 ? 1 : 2;  // the edge that stays
            const int a = t[n], b = t[(n + 1) % 3], c = t[(n + 2) % 3];
            const int bc = m[(n + 1) % 3], ca = m[(n + 2) % 3];
            out.push_back(glm::ivec3(ca, bc, c));
            // The shorter diagonal.
            if (squaredMm2(a, bc) <= squaredMm2(b, ca))
                out.insert(out.end(), {glm::ivec3(a, b, bc), glm::ivec3(a, bc, ca)});
            else
                out.insert(out.end(), {glm::ivec3(a, b, ca), glm::ivec3(b, bc, ca)});
        }
    }

    WallSamples& samples_;
    double mostMm2_;
    // Of each vertex the edges to later ones that have been cut, as a list: a vertex has few.
    struct Middle {
        int otherEnd = 0, vertex = 0, next = -1;
    };
    std::vector<int> firstOf_;
    std::vector<Middle> middles_;
};

void measureAreas(WallSamples& samples) {
    samples.areaMm2.assign(samples.mesh.vertices.size(), 0.0f);
    for (const glm::ivec3& t : samples.mesh.triangles) {
        const glm::dvec3 a = samples.mesh.vertices[std::size_t(t.x)];
        const float third =
            float(glm::length(glm::cross(samples.mesh.vertices[std::size_t(t.y)] - a,
                                         samples.mesh.vertices[std::size_t(t.z)] - a)) /
                  6.0);
        for (int n = 0; n < 3; ++n)
            samples.areaMm2[std::size_t(t[n])] += third;
    }
}

void joinNeighbours(WallSamples& samples, int threads) {
    const std::size_t count = samples.mesh.vertices.size();
    // Each edge from both triangles and both ends; doubles go once sorted.
    std::vector<std::uint32_t> begin(count + 1, 0);
    for (const glm::ivec3& t : samples.mesh.triangles)
        for (int n = 0; n < 3; ++n)
            begin[std::size_t(t[n]) + 1] += 2;
    for (std::size_t v = 0; v < count; ++v)
        begin[v + 1] += begin[v];
    std::vector<std::uint32_t> all(begin[count]), at(begin.begin(), begin.end() - 1);
    for (const glm::ivec3& t : samples.mesh.triangles) {
        for (int n = 0; n < 3; ++n) {
            all[at[std::size_t(t[n])]++] = std::uint32_t(t[(n + 1) % 3]);
            all[at[std::size_t(t[n])]++] = std::uint32_t(t[(n + 2) % 3]);
        }
    }
    samples.begin.assign(count + 1, 0);
    parallelFor(count, 16384, threads, [&](std::size_t from, std::size_t to) {
        for (std::size_t v = from; v < to; ++v) {
            const auto first = all.begin() + begin[v], last = all.begin() + begin[v + 1];
            std::sort(first, last);
            samples.begin[v + 1] = std::uint32_t(std::unique(first, last) - first);
        }
    });
    for (std::size_t v = 0; v < count; ++v)
        samples.begin[v + 1] += samples.begin[v];
    samples.neighbours.resize(samples.begin[count]);
    parallelFor(count, 16384, threads, [&](std::size_t from, std::size_t to) {
        for (std::size_t v = from; v < to; ++v)
            std::copy_n(all.begin() + begin[v], samples.begin[v + 1] - samples.begin[v],
                        samples.neighbours.begin() + samples.begin[v]);
    });
}

// Interleaves the bits of three numbers below 1024: what is near in space is mostly near in order.
std::uint32_t mortonCode(glm::ivec3 cell) {
    std::uint32_t code = 0;
    for (int bit = 0; bit < 10; ++bit)
        for (int axis = 0; axis < 3; ++axis)
            code |= ((std::uint32_t(cell[axis]) >> bit) & 1u) << (3 * bit + axis);
    return code;
}

// The surface's triangles in an order in which neighbours are near to each other.
std::vector<std::int32_t> nearbyOrder(const TriMesh& surface) {
    glm::dvec3 low(1e30), high(-1e30);
    for (const glm::dvec3& p : surface.vertices)
        low = glm::min(low, p), high = glm::max(high, p);
    const double cellMm = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-3}) / 1023.0;
    std::vector<std::pair<std::uint32_t, std::int32_t>> order;
    order.reserve(surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const glm::dvec3 p = surface.vertices[std::size_t(surface.triangles[t].x)];
        order.emplace_back(mortonCode(glm::ivec3((p - low) / cellMm)), std::int32_t(t));
    }
    std::sort(order.begin(), order.end());
    std::vector<std::int32_t> triangles;
    triangles.reserve(order.size());
    for (const auto& entry : order)
        triangles.push_back(entry.second);
    return triangles;
}

// Numbers vertices as triangles need them, so that those of one neighbourhood lie together in
// memory: everything that walks on the wall is bound by that.
void renumber(TriMesh& mesh) {
    std::vector<int> numbers(mesh.vertices.size(), -1);
    std::vector<glm::dvec3> vertices;
    vertices.reserve(mesh.vertices.size());
    for (glm::ivec3& t : mesh.triangles) {
        for (int n = 0; n < 3; ++n) {
            int& number = numbers[std::size_t(t[n])];
            if (number < 0) {
                number = int(vertices.size());
                vertices.push_back(mesh.vertices[std::size_t(t[n])]);
            }
            t[n] = number;
        }
    }
    mesh.vertices = std::move(vertices);
}

}  // namespace

WallSamples sampleWall(const TriMesh& surface, double mostSpacingMm, int threads) {
    WallSamples samples;
    samples.mesh.vertices = surface.vertices;
    samples.sourceTriangle = nearbyOrder(surface);
    samples.mesh.triangles.reserve(surface.triangles.size());
    for (const std::int32_t t : samples.sourceTriangle)
        samples.mesh.triangles.push_back(surface.triangles[std::size_t(t)]);
    while (Division(samples, mostSpacingMm).run()) {
    }
    renumber(samples.mesh);
    measureAreas(samples);
    joinNeighbours(samples, threads);
    return samples;
}

}  // namespace haustra::cad
