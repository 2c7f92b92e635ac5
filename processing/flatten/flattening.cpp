#include "flatten/flattening.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <unordered_map>

namespace haustra::flatten {
namespace {

// Its bits: what lies at the same place of the surface.
std::string placeKey(glm::dvec3 positionMm) {
    std::string key(sizeof positionMm, '\0');
    std::memcpy(key.data(), &positionMm, sizeof positionMm);
    return key;
}

std::size_t flipsOf(const FlatMap& map) {
    std::size_t flips = 0;
    for (const glm::ivec3& t : map.surface.triangles) {
        const glm::dvec2 a = map.flat[std::size_t(t.x)];
        const glm::dvec2 u = map.flat[std::size_t(t.y)] - a, v = map.flat[std::size_t(t.z)] - a;
        if (!(u.x * v.y - u.y * v.x > 0.0)) ++flips;
    }
    return flips;
}

}  // namespace

double seamMismatch(const FlatMap& map) {
    std::unordered_map<std::string, std::size_t> left;
    std::size_t paired = 0;
    for (std::size_t v = 0; v < map.flat.size(); ++v) {
        if (map.flat[v].x == 0.0) left.emplace(placeKey(map.surface.vertices[v]), v);
    }
    double worst = 0.0;
    for (std::size_t v = 0; v < map.flat.size(); ++v) {
        if (map.flat[v].x != 1.0) continue;
        const auto partner = left.find(placeKey(map.surface.vertices[v]));
        if (partner == left.end()) return 1.0;
        ++paired;
        worst = std::max(worst, std::abs(map.flat[partner->second].y - map.flat[v].y));
    }
    return paired == left.size() ? worst : 1.0;
}

Result<Flattening> flattenTube(const TriMesh& tube, int firstLoop,
                               const FlatteningOptions& options) {
    ConformalTubeOptions conformal;
    conformal.threads = options.threads;
    conformal.progress = options.progress;
    auto flat = conformalTube(tube, firstLoop, conformal);
    if (!flat) return tl::make_unexpected(flat.error());
    Flattening made;
    made.modulus = flat->modulus;
    made.certificate = flat->certificate;
    made.repaired = flat->repaired;
    made.distortion = measureDistortion(
        tube, [&](std::size_t t, int corner) { return flat->map.corner(tube, t, corner); });
    made.seam = bestSeam(tube, flat->map, options.seam);
    made.map = cutAlongSeam(tube, std::move(flat->map), made.seam);
    made.flips = flipsOf(made.map);
    made.seamMismatch = seamMismatch(made.map);
    return made;
}

}  // namespace haustra::flatten
