#include "cad/wall_samples.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace haustra::cad {
namespace {

std::uint64_t edgeKey(int a, int b) {
    return (std::uint64_t(std::uint32_t(std::min(a, b))) << 32) | std::uint32_t(std::max(a, b));
}

// One division of every triangle with a long edge into two, three or four.
class Division {
public:
    Division(WallSamples& samples, double mostMm) : samples_(samples), mostMm2_(mostMm * mostMm) {}

    // False where no edge was too long.
    bool run() {
        std::vector<glm::ivec3> triangles;
        std::vector<std::int32_t> sources;
        triangles.reserve(samples_.mesh.triangles.size() * 4);
        sources.reserve(triangles.capacity());
        middles_.reserve(samples_.mesh.triangles.size() * 3 / 2);
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

    // −1: the edge is short enough.
    int middleOf(int a, int b) {
        if (squaredMm2(a, b) <= mostMm2_) return -1;
        const auto [at, fresh] =
            middles_.try_emplace(edgeKey(a, b), int(samples_.mesh.vertices.size()));
        if (fresh) {
            samples_.mesh.vertices.push_back(0.5 * (samples_.mesh.vertices[std::size_t(a)] +
                                                    samples_.mesh.vertices[std::size_t(b)]));
        }
        return at->second;
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
    std::unordered_map<std::uint64_t, int> middles_;
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

void joinNeighbours(WallSamples& samples) {
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
    samples.neighbours.clear();
    samples.neighbours.reserve(all.size() / 2);
    for (std::size_t v = 0; v < count; ++v) {
        const auto first = all.begin() + begin[v], last = all.begin() + begin[v + 1];
        std::sort(first, last);
        samples.neighbours.insert(samples.neighbours.end(), first, std::unique(first, last));
        samples.begin[v + 1] = std::uint32_t(samples.neighbours.size());
    }
}

}  // namespace

WallSamples sampleWall(const TriMesh& surface, double mostSpacingMm) {
    WallSamples samples;
    samples.mesh = surface;
    samples.sourceTriangle.resize(surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        samples.sourceTriangle[t] = std::int32_t(t);
    while (Division(samples, mostSpacingMm).run()) {
    }
    measureAreas(samples);
    joinNeighbours(samples);
    return samples;
}

}  // namespace haustra::cad
