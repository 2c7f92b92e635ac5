#include "cad/wall_samples.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace haustra::cad {
namespace {

// Divides triangles with a long edge into two, three or four, until there are none.
class Division {
public:
    Division(WallSamples& samples, double mostMm)
        : samples_(samples), mostMm2_(mostMm * mostMm), open_(samples.mesh.triangles.size()) {
        std::iota(open_.begin(), open_.end(), 0u);
    }

    void run() {
        while (findCuts())
            divideAll();
    }

private:
    // A triangle and where its edges are cut, as middleOf() says.
    struct Cut {
        std::uint32_t triangle;
        glm::ivec3 middles;
    };

    // False where no edge is too long.
    bool findCuts() {
        firstOf_.assign(samples_.mesh.vertices.size(), -1);
        middles_.clear(), cuts_.clear();
        for (const std::uint32_t number : open_) {
            const glm::ivec3 t = samples_.mesh.triangles[number];
            const int ab = middleOf(t.x, t.y), bc = middleOf(t.y, t.z), ca = middleOf(t.z, t.x);
            if (ab >= 0 || bc >= 0 || ca >= 0) cuts_.push_back({number, {ab, bc, ca}});
        }
        return !cuts_.empty();
    }

    void divideAll() {
        std::vector<glm::ivec3>& triangles = samples_.mesh.triangles;
        std::vector<glm::ivec3> divided;
        std::vector<std::int32_t> sources;
        divided.reserve(triangles.size() + 3 * cuts_.size());
        sources.reserve(divided.capacity());
        open_.clear();
        std::size_t next = 0;  // triangles before it are in `divided`
        const auto keepUntil = [&](std::size_t end) {
            divided.insert(divided.end(), triangles.begin() + std::ptrdiff_t(next),
                           triangles.begin() + std::ptrdiff_t(end));
            sources.insert(sources.end(), samples_.sourceTriangle.begin() + std::ptrdiff_t(next),
                           samples_.sourceTriangle.begin() + std::ptrdiff_t(end));
            next = end;
        };
        for (const Cut& cut : cuts_) {
            keepUntil(cut.triangle);
            divide(triangles[cut.triangle], cut.middles, divided);
            for (std::size_t t = sources.size(); t < divided.size(); ++t)
                open_.push_back(std::uint32_t(t));
            sources.resize(divided.size(), samples_.sourceTriangle[cut.triangle]);
            next = cut.triangle + 1;
        }
        keepUntil(triangles.size());
        triangles = std::move(divided);
        samples_.sourceTriangle = std::move(sources);
    }

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

    void divide(glm::ivec3 t, glm::ivec3 m, std::vector<glm::ivec3>& out) const {
        const int cut = (m.x >= 0) + (m.y >= 0) + (m.z >= 0);
        if (cut == 3) {
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
    // Those that may have a long edge, ascending: all at first, then what others were divided into.
    std::vector<std::uint32_t> open_;
    std::vector<Cut> cuts_;
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
    Division(samples, mostSpacingMm).run();
    renumber(samples.mesh);
    measureAreas(samples);
    joinNeighbours(samples, threads);
    return samples;
}

}  // namespace haustra::cad
