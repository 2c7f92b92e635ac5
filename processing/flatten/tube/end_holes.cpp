#include "flatten/tube/end_holes.h"

#include "flatten/tube/rim_cut.h"
#include "flatten/tube/tip_function.h"
#include "mesh/halfedge_mesh.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

namespace haustra::flatten {
namespace {

// Of the neighbourhood's radius, how far a rim may be from its tip, and of how many holes' radii
// the neighbourhood is.
constexpr double farthestLevel = 2.0 / 3.0, neighbourhoodRadii = 3.0;
// Fewer corners move where more would break the surface.
constexpr double snapShares[] = {0.35, 0.25, 0.15, 0.05, 1e-3, 0.0};

struct Hit {
    double distanceMm;
    std::size_t triangle;
    bool leaving;
};

/// The first triangle that the ray from `from` meets (Möller and Trumbore).
std::optional<Hit> firstHit(const TriMesh& mesh, glm::dvec3 from, glm::dvec3 direction) {
    std::optional<Hit> nearest;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::ivec3 c = mesh.triangles[t];
        const glm::dvec3 a = mesh.vertices[std::size_t(c.x)];
        const glm::dvec3 u = mesh.vertices[std::size_t(c.y)] - a,
                         v = mesh.vertices[std::size_t(c.z)] - a;
        const glm::dvec3 normal = glm::cross(u, v), offset = from - a;
        const double slope = glm::dot(direction, normal);
        if (slope == 0.0) continue;
        const double distance = -glm::dot(offset, normal) / slope;
        const glm::dvec3 moment = glm::cross(offset, direction);
        const double s = glm::dot(v, moment) / -slope, r = glm::dot(u, moment) / slope;
        // A ray through an edge must not slip between its triangles.
        constexpr double slack = -1e-9;
        if (distance < 0.0 || s < slack || r < slack || s + r > 1.0 - slack) continue;
        if (!nearest || distance < nearest->distanceMm) nearest = Hit{distance, t, slope > 0.0};
    }
    return nearest;
}

int tipOf(const TriMesh& mesh, glm::dvec3 end, glm::dvec3 outward) {
    if (outward != glm::dvec3(0.0)) {
        const auto hit = firstHit(mesh, end, outward);
        if (hit && hit->leaving) {
            const glm::dvec3 place = end + hit->distanceMm * outward;
            const glm::ivec3 corners = mesh.triangles[hit->triangle];
            int nearest = corners.x;
            for (const int v : {corners.y, corners.z}) {
                if (glm::distance(mesh.vertices[std::size_t(v)], place) <
                    glm::distance(mesh.vertices[std::size_t(nearest)], place)) {
                    nearest = v;
                }
            }
            return nearest;
        }
    }
    int nearest = -1;
    double best = std::numeric_limits<double>::infinity();
    for (const glm::ivec3& t : mesh.triangles) {
        for (int c = 0; c < 3; ++c) {
            const double distance = glm::distance(mesh.vertices[std::size_t(t[c])], end);
            if (distance < best) best = distance, nearest = t[c];
        }
    }
    return nearest;
}

/// The level whose line is `rimMm` long, or the farthest where all are shorter.
double levelOfLength(const TriMesh& closed, const TipFunction& function, double rimMm) {
    TriMesh around{closed.vertices, {}};
    for (const glm::ivec3& t : closed.triangles) {
        bool near = false;
        for (int c = 0; c < 3; ++c)
            near = near || function.value[std::size_t(t[c])] < 1.0;
        if (near) around.triangles.push_back(t);
    }
    double low = 0.0, high = farthestLevel;
    if (levelLengthMm(around, function, high) <= rimMm) return high;
    for (int step = 0; step < 40; ++step) {
        const double middle = 0.5 * (low + high);
        (levelLengthMm(around, function, middle) < rimMm ? low : high) = middle;
    }
    return high;
}

std::optional<RimCut> bestRim(const TriMesh& closed, const TipFunction& function, double level) {
    std::optional<RimCut> best;
    for (const double share : snapShares) {
        auto cut = cutRim(closed, function, level, share);
        if (cut && (!best || cut->leastAngleDegrees > best->leastAngleDegrees))
            best = std::move(cut);
    }
    return best;
}

Result<void> checkClosed(const TriMesh& closed) {
    const MeshTopology topology = meshTopology(closed);
    if (topology.components == 1 && topology.eulerCharacteristic == 2) return {};
    return fail(ErrorKind::badInput, "only one closed surface of genus 0 has two ends: this has " +
                                         std::to_string(topology.components) + " parts and genus " +
                                         std::to_string(topology.genus()));
}

/// Puts what is left around both holes into the surface, and leaves out what no triangle uses.
PunchedTube assemble(const TriMesh& closed, const RimCut cuts[2]) {
    PunchedTube made;
    std::vector<char> gone(closed.triangles.size(), 0);
    std::vector<glm::dvec3> places = closed.vertices;
    int firstAdded[2];
    for (int end = 0; end < 2; ++end) {
        for (const int t : cuts[end].replaced)
            gone[std::size_t(t)] = 1;
        for (const auto& [v, place] : cuts[end].moved)
            places[std::size_t(v)] = place;
        firstAdded[end] = int(places.size()) - int(closed.vertices.size());
        places.insert(places.end(), cuts[end].added.begin(), cuts[end].added.end());
        made.capAreaMm2[end] = cuts[end].removedMm2;
        made.rimLengthMm[end] = cuts[end].rimLengthMm;
    }
    const auto numberOf = [&](int end, int v) {
        return v < int(closed.vertices.size()) ? v : v + firstAdded[end];
    };
    for (std::size_t t = 0; t < closed.triangles.size(); ++t) {
        if (gone[t]) continue;
        made.tube.triangles.push_back(closed.triangles[t]);
        made.sourceTriangle.push_back(int(t));
    }
    for (int end = 0; end < 2; ++end) {
        for (std::size_t t = 0; t < cuts[end].triangles.size(); ++t) {
            const glm::ivec3 c = cuts[end].triangles[t];
            made.tube.triangles.push_back(
                {numberOf(end, c.x), numberOf(end, c.y), numberOf(end, c.z)});
            made.sourceTriangle.push_back(cuts[end].source[t]);
        }
    }
    std::vector<int> number(places.size(), -1);
    for (const glm::ivec3& t : made.tube.triangles) {
        for (int c = 0; c < 3; ++c)
            number[std::size_t(t[c])] = 0;
    }
    for (std::size_t v = 0; v < places.size(); ++v) {
        if (number[v] < 0) continue;
        number[v] = int(made.tube.vertices.size());
        made.tube.vertices.push_back(places[v]);
    }
    for (glm::ivec3& t : made.tube.triangles) {
        for (int c = 0; c < 3; ++c)
            t[c] = number[std::size_t(t[c])];
    }
    made.firstLoop = number[std::size_t(numberOf(0, cuts[0].rim[0]))];
    return made;
}

}  // namespace

Result<PunchedTube> punchEnds(const TriMesh& closed, const glm::dvec3 endsMm[2],
                              const glm::dvec3 outwardsMm[2], const EndHoleOptions& options) {
    if (!(options.rimMm > 0.0)) return fail(ErrorKind::badInput, "a hole's rim must have a length");
    const auto halfedges = TRY(mesh::HalfedgeMesh::ofClosed(closed));
    TRY(checkClosed(closed));
    RimCut cuts[2];
    std::vector<char> touched(closed.vertices.size(), 0);
    for (int end = 0; end < 2; ++end) {
        const double radiusMm = neighbourhoodRadii * options.rimMm / (2.0 * std::numbers::pi);
        const int tip = tipOf(closed, endsMm[end], outwardsMm[end]);
        const auto function = tipFunction(closed, halfedges, tip, radiusMm);
        auto cut = function
                       ? bestRim(closed, *function, levelOfLength(closed, *function, options.rimMm))
                       : std::nullopt;
        if (!cut) {
            return fail(ErrorKind::badInput,
                        "the surface is too small or too coarse for a hole at each end");
        }
        for (const int t : cut->replaced) {
            for (int c = 0; c < 3; ++c) {
                const auto v = std::size_t(closed.triangles[std::size_t(t)][c]);
                if (touched[v] == 1 && end == 1) {
                    return fail(ErrorKind::badInput,
                                "the ends are so near to each other that their holes would meet");
                }
                if (end == 0) touched[v] = 1;
            }
        }
        cuts[end] = std::move(*cut);
    }
    return assemble(closed, cuts);
}

}  // namespace haustra::flatten
