#include "flatten/flattening.h"

#include "flatten/unified_flattening.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <unordered_map>

namespace haustra::flatten {
namespace {

// Of the time, where unifiedFlattening follows the conformal map.
constexpr double conformalShare = 0.2;
constexpr double mostUncertain = 0.5;  // certificate; a real colon's is 0.01

/// Progress from `from` to `to` of the whole.
Progress part(const Progress& whole, double from, double to) {
    if (!whole) return {};
    return [=](double fraction) { whole(from + (to - from) * fraction); };
}

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
    conformal.progress =
        part(options.progress, 0.0, options.areaWeight > 0.0 ? conformalShare : 1.0);
    auto flat = conformalTube(tube, firstLoop, conformal);
    if (!flat) return tl::make_unexpected(flat.error());
    // Energies that miss each other's inverse by half are of no map.
    if (!(flat->certificate < mostUncertain)) {
        return fail(
            ErrorKind::noResult,
            "the surface is pinched or too coarse somewhere: its conformal map cannot be told",
            "flattening");
    }
    Flattening made;
    made.modulus = flat->modulus;
    made.certificate = flat->certificate;
    made.repaired = flat->repaired;
    PeriodicMap map = std::move(flat->map);
    const auto measured = [&] {
        return measureDistortion(
            tube, [&](std::size_t t, int corner) { return map.corner(tube, t, corner); });
    };
    made.conformal = made.distortion = measured();
    if (options.areaWeight > 0.0) {
        UnifiedOptions unified;
        unified.areaWeight = options.areaWeight;
        unified.threads = options.threads;
        unified.progress = part(options.progress, conformalShare, 1.0);
        auto traded = unifiedFlattening(tube, map, unified);
        if (!traded) return tl::make_unexpected(traded.error());
        map = std::move(*traded);
        made.distortion = measured();
    }
    made.seam = bestSeam(tube, map, options.seam);
    made.map = cutAlongSeam(tube, std::move(map), made.seam);
    made.flips = flipsOf(made.map);
    made.seamMismatch = seamMismatch(made.map);
    return made;
}

}  // namespace haustra::flatten
