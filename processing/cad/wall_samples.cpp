#include "cad/wall_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::cad {
namespace {

// Divides a triangle with a long edge into two, three or four, and each of these in turn, until
// there is no long edge. Where an edge is cut depends on its ends alone, and on which was made
// first, so that the two triangles that share it agree, whichever comes first.
class Division {
public:
    Division(TriMesh& mesh, double mostMm, std::size_t expectedVertices)
        : mesh_(mesh),
          mostMm2_(mostMm * mostMm),
          firstOf_(mesh.vertices.size(), -1),
          roundOf_(mesh.vertices.size(), 0) {
        firstOf_.reserve(expectedVertices);
        roundOf_.reserve(expectedVertices);
        middles_.reserve(expectedVertices);
    }

    // What a triangle of the mesh is divided into, appended in order.
    void divide(glm::ivec3 t, std::vector<glm::ivec3>& out) { divide(t, 1, out); }

private:
    double squaredMm2(int a, int b) const {
        const glm::dvec3 edge = mesh_.vertices[std::size_t(a)] - mesh_.vertices[std::size_t(b)];
        return glm::dot(edge, edge);
    }

    // −1: the edge is short enough. One that takes an odd number of pieces is cut beside its
    // middle, where whole pieces lie on either side: three of 0.5 mm instead of four of 0.37 mm.
    int middleOf(int a, int b, int round) {
        const double mm2 = squaredMm2(a, b);
        if (!(mm2 > mostMm2_)) return -1;
        // The shorter part is on the side of the end that was made first.
        const auto orderOf = [&](int v) { return std::pair(roundOf_[std::size_t(v)], v); };
        if (orderOf(a) > orderOf(b)) std::swap(a, b);
        for (int n = firstOf_[std::size_t(a)]; n >= 0; n = middles_[std::size_t(n)].next)
            if (middles_[std::size_t(n)].otherEnd == b) return middles_[std::size_t(n)].vertex;
        const int vertex = int(mesh_.vertices.size());
        middles_.push_back({b, vertex, firstOf_[std::size_t(a)]});
        firstOf_[std::size_t(a)] = int(middles_.size()) - 1;
        const double pieces = std::max(2.0, std::ceil(std::sqrt(mm2 / mostMm2_) - 1e-9));
        mesh_.vertices.push_back(glm::mix(mesh_.vertices[std::size_t(a)],
                                          mesh_.vertices[std::size_t(b)],
                                          std::floor(0.5 * pieces) / pieces));
        firstOf_.push_back(-1);
        roundOf_.push_back(std::uint8_t(round));
        return vertex;
    }

    void divide(glm::ivec3 t, int round, std::vector<glm::ivec3>& out) {
        const int ab = middleOf(t.x, t.y, round), bc = middleOf(t.y, t.z, round),
                  ca = middleOf(t.z, t.x, round);
        const glm::ivec3 m(ab, bc, ca);
        const auto further = [&](int a, int b, int c) { divide({a, b, c}, round + 1, out); };
        const int cut = (m.x >= 0) + (m.y >= 0) + (m.z >= 0);
        if (cut == 0) {
            out.push_back(t);
        } else if (cut == 3) {
            further(t[0], m[0], m[2]), further(m[0], t[1], m[1]);
            further(m[2], m[1], t[2]), further(m[0], m[1], m[2]);
        } else if (cut == 1) {
            const int n = m[0] >= 0 ? 0 : m[1] >= 0 ? 1 : 2;
            const int a = t[n], b = t[(n + 1) % 3], c = t[(n + 2) % 3];
            further(a, m[n], c), further(m[n], b, c);
        } else {
            const int n = m[0] < 0 ? 0 : m[1] < 0 ? 1 : 2;  // the edge that stays
            const int a = t[n], b = t[(n + 1) % 3], c = t[(n + 2) % 3];
            const int onBc = m[(n + 1) % 3], onCa = m[(n + 2) % 3];
            further(onCa, onBc, c);
            // The shorter diagonal.
            if (squaredMm2(a, onBc) <= squaredMm2(b, onCa))
                further(a, b, onBc), further(a, onBc, onCa);
            else
                further(a, b, onCa), further(b, onBc, onCa);
        }
    }

    TriMesh& mesh_;
    double mostMm2_;
    // Of each vertex the edges to younger ones that have been cut, as a list: a vertex has few.
    struct Middle {
        int otherEnd = 0, vertex = 0, next = -1;
    };
    std::vector<int> firstOf_;
    std::vector<Middle> middles_;
    std::vector<std::uint8_t> roundOf_;  // in which a vertex was made; 0: the surface's own
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

void findTriangles(WallSamples& samples) {
    const std::size_t count = samples.mesh.vertices.size();
    std::vector<std::uint32_t>& begin = samples.beginTriangles;
    begin.assign(count + 1, 0);
    for (const glm::ivec3& t : samples.mesh.triangles)
        for (int n = 0; n < 3; ++n)
            ++begin[std::size_t(t[n]) + 1];
    for (std::size_t v = 0; v < count; ++v)
        begin[v + 1] += begin[v];
    samples.triangles.resize(begin[count]);
    std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1);
    for (std::size_t t = 0; t < samples.mesh.triangles.size(); ++t)
        for (int n = 0; n < 3; ++n)
            samples.triangles[at[std::size_t(samples.mesh.triangles[t][n])]++] = std::uint32_t(t);
}

// By the triangles around each vertex: the vertex is told to their corners, in ascending order, so
// that what each has been told of is in ascending order, too. Without a branch that depends on the
// mesh, as it could not be predicted: what a corner knows already, and itself, goes to a spare
// place at the end. Without checks of indices, which took a sixth of its time.
void joinNeighbours(WallSamples& samples) {
    const std::size_t count = samples.mesh.vertices.size();
    constexpr std::uint32_t none = ~0u;
    const glm::ivec3* const triangles = samples.mesh.triangles.data();
    const auto tell = [&](const auto& toldOf) {
        std::vector<std::uint32_t> last(count, none);
        std::uint32_t* const toldLast = last.data();
        for (std::uint32_t v = 0; v < count; ++v) {
            toldLast[v] = v;  // of itself
            for (const std::uint32_t triangle : samples.trianglesAround(v)) {
                const glm::ivec3 corners = triangles[triangle];
                for (int n = 0; n < 3; ++n) {
                    const auto corner = std::uint32_t(corners[n]);
                    toldOf(corner, v, toldLast[corner] != v);
                    toldLast[corner] = v;
                }
            }
        }
    };
    std::vector<std::uint32_t>& begin = samples.begin;
    begin.assign(count + 1, 0);
    std::uint32_t* const counts = begin.data() + 1;
    tell([&](std::uint32_t corner, std::uint32_t, bool isNew) { counts[corner] += isNew; });
    for (std::size_t v = 0; v < count; ++v)
        begin[v + 1] += begin[v];
    const std::uint32_t spare = begin[count];
    samples.neighbours.resize(spare + 1);
    std::uint32_t* const neighbours = samples.neighbours.data();
    std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1);
    std::uint32_t* const next = at.data();
    tell([&](std::uint32_t corner, std::uint32_t v, bool isNew) {
        neighbours[isNew ? next[corner] : spare] = v;
        next[corner] += isNew;
    });
    samples.neighbours.pop_back();
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

// About how many it takes, rather too many: memory that is set aside and not used costs nothing.
std::size_t expectedSamples(const TriMesh& surface, double mostSpacingMm) {
    double areaMm2 = 0.0;
    for (const glm::ivec3& t : surface.triangles)
        areaMm2 += triangleAreaMm2(surface, t);
    return surface.vertices.size() + std::size_t(4.0 * areaMm2 / (mostSpacingMm * mostSpacingMm));
}

}  // namespace

WallSamples dividedWall(const TriMesh& surface, double mostSpacingMm) {
    WallSamples samples;
    const std::size_t expected = expectedSamples(surface, mostSpacingMm);
    samples.mesh.vertices.reserve(expected);
    samples.mesh.vertices = surface.vertices;
    samples.mesh.triangles.reserve(2 * expected);
    samples.sourceTriangle.reserve(2 * expected);
    Division division(samples.mesh, mostSpacingMm, expected);
    for (const std::int32_t t : nearbyOrder(surface)) {
        division.divide(surface.triangles[std::size_t(t)], samples.mesh.triangles);
        samples.sourceTriangle.resize(samples.mesh.triangles.size(), t);
    }
    renumber(samples.mesh);
    return samples;
}

void joinSamples(WallSamples& samples) {
    measureAreas(samples);
    findTriangles(samples);
    joinNeighbours(samples);
}

WallSamples sampleWall(const TriMesh& surface, double mostSpacingMm) {
    WallSamples samples = dividedWall(surface, mostSpacingMm);
    joinSamples(samples);
    return samples;
}

}  // namespace haustra::cad
