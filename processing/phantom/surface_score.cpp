#include "phantom/surface_score.h"

#include "core/parallel.h"
#include "phantom/random.h"

#include <cmath>
#include <numeric>

namespace haustra::phantom {
namespace {

struct Place {
    glm::dvec3 at{0.0};
    double areaMm2 = 0.0;
    double distanceMm = 0.0;  ///< signed, where that has a meaning
    bool leftOut = false;
};

glm::dvec3 nearestOnTriangle(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    // Ericson, Real-Time Collision Detection, 5.1.5.
    const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    const glm::dvec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
    const glm::dvec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    const double sum = va + vb + vc;
    return sum > 0.0 ? a + ab * (vb / sum) + ac * (vc / sum) : a;
}

/// A mesh that answers for the distance from anywhere.
class MeshDistance {
public:
    explicit MeshDistance(const TriMesh& mesh) : mesh_(mesh) {
        std::vector<Box> boxes;
        boxes.reserve(mesh.triangles.size());
        for (const glm::ivec3 t : mesh.triangles) {
            const glm::dvec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
            boxes.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
        }
        near_ = CellGrid(boxes, 1.5);
    }

    double distanceMm(glm::dvec3 p) const {
        return std::sqrt(near_
                             .nearest(p,
                                      [&](std::uint32_t n) {
                                          const glm::ivec3 t = mesh_.triangles[n];
                                          const glm::dvec3 d =
                                              p - nearestOnTriangle(p, mesh_.vertices[t.x],
                                                                    mesh_.vertices[t.y],
                                                                    mesh_.vertices[t.z]);
                                          return glm::dot(d, d);
                                      })
                             .squaredMm2);
    }

private:
    const TriMesh& mesh_;
    CellGrid near_;
};

/// Places spread evenly over the mesh: one at a random point of each of `count` equal shares of
/// its area, in the order of the triangles.
std::vector<Place> spreadOver(const TriMesh& mesh, int count) {
    std::vector<double> until(mesh.triangles.size());
    double total = 0.0;
    for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
        total += triangleAreaMm2(mesh, mesh.triangles[n]);
        until[n] = total;
    }
    std::vector<Place> places;
    if (!(total > 0.0)) return places;
    Random random(1, 11);
    const double share = total / count;
    std::size_t triangle = 0;
    for (int n = 0; n < count; ++n) {
        const double area = share * (n + random.uniform());
        while (triangle + 1 < until.size() && until[triangle] < area)
            ++triangle;
        const glm::ivec3 t = mesh.triangles[triangle];
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        const glm::dvec3 a = mesh.vertices[t.x];
        places.push_back({a + u * (mesh.vertices[t.y] - a) + v * (mesh.vertices[t.z] - a), share});
    }
    return places;
}

void measure(std::vector<Place>& places, int threads, const TrueSurface& truth,
             const std::function<double(glm::dvec3)>& distance) {
    parallelFor(places.size(), 512, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            places[n].leftOut = truth.leftOut(places[n].at);
            if (!places[n].leftOut) places[n].distanceMm = distance(places[n].at);
        }
    });
}

SurfaceDistances summarise(const std::vector<Place>& places) {
    SurfaceDistances all;
    std::vector<std::pair<double, double>> byDistance;  // with its area
    for (const Place& place : places) {
        if (place.leftOut) {
            all.leftOutAreaMm2 += place.areaMm2;
            continue;
        }
        const double d = std::abs(place.distanceMm);
        all.areaMm2 += place.areaMm2, all.meanMm += d * place.areaMm2;
        if (d > all.maxMm) all.maxMm = d, all.farthestMm = place.at;
        byDistance.emplace_back(d, place.areaMm2);
    }
    if (!(all.areaMm2 > 0.0)) return all;
    all.meanMm /= all.areaMm2;
    std::sort(byDistance.begin(), byDistance.end());
    double below = 0.0;
    for (const auto& [d, area] : byDistance) {
        below += area;
        all.p95Mm = d;
        if (below >= 0.95 * all.areaMm2) break;
    }
    return all;
}

}  // namespace

Result<SurfaceScore> scoreSurface(const TriMesh& mesh, const TrueSurface& truth,
                                  const SurfaceScoreOptions& options) {
    std::vector<Place> places = spreadOver(mesh, std::max(1, options.samples));
    if (places.empty()) return fail(ErrorKind::badInput, "the mesh has no area", "surface score");
    if (truth.samples().empty())
        return fail(ErrorKind::badInput, "the truth has no surface", "surface score");
    SurfaceScore score;
    const auto toTruth = [&](glm::dvec3 p) { return truth.signedDistanceMm(p); };
    measure(places, options.threads, truth, toTruth);
    score.fromMesh = summarise(places);
    double signedSum = 0.0;
    for (const Place& place : places)
        signedSum += place.leftOut ? 0.0 : place.distanceMm * place.areaMm2;
    if (score.fromMesh.areaMm2 > 0.0) score.biasMm = signedSum / score.fromMesh.areaMm2;

    std::vector<Place> corners;
    for (const glm::dvec3& vertex : mesh.vertices)
        corners.push_back({vertex, 1.0});
    measure(corners, options.threads, truth, [&](glm::dvec3 p) {
        return truth.atMostMm(p) > score.fromMesh.maxMm ? truth.distanceMm(p) : 0.0;
    });
    const SurfaceDistances atCorners = summarise(corners);
    if (atCorners.maxMm > score.fromMesh.maxMm) {
        score.fromMesh.maxMm = atCorners.maxMm;
        score.fromMesh.farthestMm = atCorners.farthestMm;
    }

    std::vector<Place> fromTruth;
    for (const SurfaceSample& sample : truth.samples())
        fromTruth.push_back({sample.positionMm, sample.areaMm2});
    const MeshDistance toMesh(mesh);
    measure(fromTruth, options.threads, truth, [&](glm::dvec3 p) { return toMesh.distanceMm(p); });
    score.fromTruth = summarise(fromTruth);
    return score;
}

}  // namespace haustra::phantom
