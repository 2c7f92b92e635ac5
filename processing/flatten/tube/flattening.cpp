#include "flatten/tube/flattening.h"

#include "core/flood_fill.h"
#include "core/printed_text.h"
#include "flatten/tube/flip_repair.h"
#include "flatten/tube/pouches.h"
#include "flatten/tube/unified_flattening.h"
#include "mesh/halfedge_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>

namespace haustra::flatten {
namespace {

// Of the time, where unifiedFlattening follows the conformal map.
constexpr double conformalShare = 0.2;
/// Of a pouch's triangles, each time that they are mapped, for each of the tube's.
constexpr std::size_t workPerTriangle = 6, leastWork = 20000;
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

/// A tube's map, of the tube itself or of what its pouches cut it into.
struct Mapped {
    TriMesh tube;
    PeriodicMap map;
    std::vector<int> source;  ///< per triangle: of the tube that was given
    std::vector<char> apart;  ///< per triangle: of a pouch
    PouchWork work{};

    /// What has had discs set in; those of `pouch` false around folds are no pouches.
    void take(SetIn made, bool pouch) {
        std::vector<char> now(made.apart.size());
        for (std::size_t t = 0; t < now.size(); ++t) {
            const auto from = std::size_t(made.sourceTriangle[t]);
            now[t] = apart[from] || (pouch && made.apart[t]);
            made.sourceTriangle[t] = source[from];
        }
        tube = std::move(made.tube);
        map = std::move(made.map);
        source = std::move(made.sourceTriangle);
        apart = std::move(now);
    }
    double areaMm2(std::size_t t) const { return triangleAreaMm2(tube, tube.triangles[t]); }
    Distortion measured(bool outside = false) const {
        if (!outside) {
            return measureDistortion(
                tube, [&](std::size_t t, int corner) { return map.corner(tube, t, corner); });
        }
        TriMesh rest{tube.vertices, {}};
        std::vector<std::size_t> number;
        for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
            if (apart[t]) continue;
            rest.triangles.push_back(tube.triangles[t]);
            number.push_back(t);
        }
        return measureDistortion(
            rest, [&](std::size_t t, int corner) { return map.corner(tube, number[t], corner); });
    }
};

/// Sums up the pouches' wall, and counts them and finds the largest: triangles that hang together.
void measurePouches(const Mapped& mapped, Flattening& made) {
    for (std::size_t t = 0; t < mapped.apart.size(); ++t) {
        made.wallAreaMm2 += mapped.areaMm2(t);
        if (mapped.apart[t]) made.pouchAreaMm2 += mapped.areaMm2(t);
    }
    const auto halfedges = mesh::HalfedgeMesh::of(mapped.tube);
    if (!(made.pouchAreaMm2 > 0.0) || !halfedges) return;
    std::vector<char> waiting = mapped.apart;
    for (std::size_t seed = 0; seed < waiting.size(); ++seed) {
        if (!std::exchange(waiting[seed], char(0))) continue;
        std::vector<int> pouch{int(seed)};
        double areaMm2 = 0.0;
        int border = -1;  // a half-edge
        const auto acrossEdges = [&](int t, const auto& visit) {
            areaMm2 += mapped.areaMm2(std::size_t(t));
            for (int h = 3 * t; h < 3 * t + 3; ++h) {
                const int other = halfedges->opposite(h);
                if (other >= 0 && mapped.apart[std::size_t(other / 3)]) {
                    visit(other / 3);
                } else {
                    border = h;
                }
            }
        };
        floodFill(pouch, acrossEdges,
                  [&](int t) { return std::exchange(waiting[std::size_t(t)], char(0)) != 0; });
        ++made.pouches;
        if (areaMm2 <= made.largestPouchMm2 || border < 0) continue;
        made.largestPouchMm2 = areaMm2;
        made.largestPouchY = mapped.map.flat[std::size_t(halfedges->origin(border))].y;
    }
}

/// Blind fingers apart, the rest repaired. Returns the vertices that the repair moved.
int makeRoom(Mapped& mapped, Grids grids) {
    const std::vector<Pouch> pouches = findPouches(mapped.tube, mapped.map);
    std::vector<char> apart;
    if (!pouches.empty()) apart.assign(mapped.tube.triangles.size(), 0);
    for (const Pouch& pouch : pouches) {
        for (const int t : pouch.triangles)
            apart[std::size_t(t)] = 1;
    }
    const int repaired = repairMap(mapped.map, mapped.tube, apart);
    if (!pouches.empty())
        mapped.take(setIn(mapped.tube, mapped.map, pouches, mapped.work, 0, grids), true);
    return repaired;
}

struct Cut {
    FlatMap map;
    double seam = 0.0;
    std::vector<int> folded;
};

Cut cutAt(const Mapped& mapped, double seam) {
    Cut cut{cutAlongSeam(mapped.tube, mapped.map, seam), seam, {}};
    cut.folded = foldedTriangles(cut.map);
    return cut;
}

/// The strip cut open; where that leaves folds, with a seam a hair aside, and discs around the
/// folds set in.
Cut cutOpen(Mapped& mapped, double radiusFactor, Grids grids, const SeamOptions& options) {
    constexpr int rounds = 40;
    constexpr double aside = 1.0 / 5760.0;  // an eighth of a column of bestSeam's
    Cut cut = cutAt(mapped, bestSeam(mapped.tube, mapped.map, options));
    std::vector<int> before;
    for (int round = 0; round < rounds && !cut.folded.empty(); ++round) {
        std::vector<int> folded;
        for (const int t : cut.folded)
            folded.push_back(cut.map.sourceTriangle[std::size_t(t)]);
        std::sort(folded.begin(), folded.end());
        folded.erase(std::unique(folded.begin(), folded.end()), folded.end());
        // Splinters that the seam cuts off need another seam alone.
        const Cut moved = cutAt(mapped, cut.seam + aside);
        std::vector<int> again;
        for (const int t : moved.folded)
            again.push_back(moved.map.sourceTriangle[std::size_t(t)]);
        std::sort(again.begin(), again.end());
        std::vector<int> stay;
        std::set_intersection(folded.begin(), folded.end(), again.begin(), again.end(),
                              std::back_inserter(stay));
        stay.erase(std::unique(stay.begin(), stay.end()), stay.end());
        if (stay.empty()) {
            cut = moved;
            continue;
        }
        SetIn mended = mendFolds(mapped.tube, mapped.map, stay, radiusFactor, grids, mapped.work);
        if (mended.pouches + mended.spread == 0) break;
        mapped.take(std::move(mended), grids == Grids::any);
        cut = cutAt(mapped, cut.seam);
    }
    return cut;
}

/// The strip cut open; where folds stay, all over again with holes of other radii, as one in
/// between may be round enough to be filled; each try has as much more work.
Cut cutOpen(Mapped& mapped, Grids grids, const SeamOptions& options) {
    constexpr std::array<double, 3> radiusFactors{1.5, 1.25, 1.12};
    // Of more, some have a pouch for themselves that no hole around them has room for.
    constexpr std::size_t mostToMend = 1000;
    Mapped before = mapped;
    Cut cut;
    for (const double factor : radiusFactors) {
        mapped = before;
        cut = cutOpen(mapped, factor, grids, options);
        if (cut.folded.empty() || (grids == Grids::small && cut.folded.size() > mostToMend)) break;
        before.work.left += workPerTriangle * before.tube.triangles.size();
    }
    return cut;
}

tl::unexpected<Error> foldsRemain(const Cut& cut, const FlatteningOptions& options) {
    const glm::ivec3 t = cut.map.surface.triangles[std::size_t(cut.folded.front())];
    const auto& at = cut.map.surface.vertices;
    const glm::dvec3 place =
        (at[std::size_t(t.x)] + at[std::size_t(t.y)] + at[std::size_t(t.z)]) / 3.0;
    return fail(
        ErrorKind::noResult,
        "the surface cannot be flattened without folds: " + std::to_string(cut.folded.size()) +
            " of the flat map's triangles would be turned over, the first at " +
            (options.placeName ? options.placeName(place)
                               : printed("%.1f, %.1f, %.1f mm", place.x, place.y, place.z)),
        "flattening");
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

std::vector<int> foldedTriangles(const FlatMap& map) {
    const double units = flatUnitsPerCircumference(map.height);
    const auto whole = [&](int v) {
        const glm::dvec2 at = map.flat[std::size_t(v)] * units;
        return glm::i64vec2(std::llround(at.x), std::llround(at.y));
    };
    std::vector<int> folded;
    for (std::size_t n = 0; n < map.surface.triangles.size(); ++n) {
        const glm::ivec3 t = map.surface.triangles[n];
        const glm::i64vec2 a = whole(t.x), u = whole(t.y) - a, v = whole(t.z) - a;
        // Below 2³¹ each, so that the products are exact.
        if (u.x * v.y - u.y * v.x <= 0) folded.push_back(int(n));
    }
    return folded;
}

Result<Flattening> flattenTube(const TriMesh& tube, int firstLoop,
                               const FlatteningOptions& options) {
    ConformalTubeOptions conformal;
    conformal.threads = options.threads;
    conformal.repairFlips = false;
    conformal.progress =
        part(options.progress, 0.0, options.areaWeight > 0.0 ? conformalShare : 0.9);
    auto flat = TRY(conformalTube(tube, firstLoop, conformal));
    // Energies that miss each other's inverse by half are of no map.
    if (!(flat.certificate < mostUncertain)) {
        return fail(
            ErrorKind::noResult,
            "the surface is pinched or too coarse somewhere: its conformal map cannot be told",
            "flattening");
    }
    Flattening made;
    made.modulus = flat.modulus;
    made.certificate = flat.certificate;
    Mapped mapped{tube,
                  std::move(flat.map),
                  std::vector<int>(tube.triangles.size()),
                  std::vector<char>(tube.triangles.size(), 0),
                  {workPerTriangle * tube.triangles.size() + leastWork, 0}};
    std::iota(mapped.source.begin(), mapped.source.end(), 0);
    const Mapped bare = mapped;
    Cut cut;
    Grids grids = Grids::small;
    for (const Grids tried : {Grids::small, Grids::any}) {
        grids = tried;
        mapped = bare;
        made.repaired = makeRoom(mapped, grids);
        cut = cutOpen(mapped, grids, options.seam);
        if (cut.folded.empty()) break;
    }
    if (!cut.folded.empty()) return foldsRemain(cut, options);
    made.conformal = made.distortion = mapped.measured();
    // A large grid scatters areas over many powers of ten, and each step would take minutes.
    if (options.areaWeight > 0.0 && grids == Grids::small) {
        UnifiedOptions unified;
        unified.areaWeight = options.areaWeight;
        unified.threads = options.threads;
        unified.progress = part(options.progress, conformalShare, 1.0);
        if (auto traded = unifiedFlattening(mapped.tube, mapped.map, unified)) {
            Mapped weighted = mapped;
            weighted.map = std::move(*traded);
            if (Cut again = cutOpen(weighted, Grids::small, options.seam); again.folded.empty()) {
                mapped = std::move(weighted);
                cut = std::move(again);
                made.areaWeight = options.areaWeight;
                made.distortion = mapped.measured();
            }
        }
    }
    measurePouches(mapped, made);
    made.outside = made.pouches > 0 ? mapped.measured(true) : made.distortion;
    made.pouchWork = mapped.work.done;
    made.seam = cut.seam;
    made.map = std::move(cut.map);
    if (made.pouches > 0) made.isPouch.resize(made.map.sourceTriangle.size());
    for (std::size_t t = 0; t < made.map.sourceTriangle.size(); ++t) {
        std::int32_t& source = made.map.sourceTriangle[t];
        if (made.pouches > 0) made.isPouch[t] = mapped.apart[std::size_t(source)];
        source = mapped.source[std::size_t(source)];
    }
    made.seamMismatch = seamMismatch(made.map);
    if (options.progress) options.progress(1.0);
    return made;
}

}  // namespace haustra::flatten
