#include "flatten/tube/pouches.h"

#include "core/flat_map.h"
#include "flatten/tube/cut_pouch.h"
#include "flatten/tube/flat_discs.h"
#include "flatten/tube/flat_places.h"
#include "flatten/tube/spreading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

/// A cluster of no more triangles gets room from its neighbours, where they have it.
constexpr std::size_t mostSpread = 30;
/// A pouch may be set in with so many of its triangles too thin, to be mended where they lie.
constexpr double mostThin = 0.1;
/// Of Grids::small, beyond a disc of so many triangles, and a hundred for each folded one, none is
/// tried.
constexpr std::size_t mostAround = 5000;
/// A disc is worth trying where its triangles, spread evenly, would have sides of so many units.
constexpr double roomUnits = 64.0;

/// A map into which pouches are being set.
class Setting {
public:
    Setting(const TriMesh& tube, const PeriodicMap& map)
        : tube_(tube), map_(map), made_{tube, map, {}, {}}, gone_(tube.triangles.size(), 0) {}

    void take(const PlacedPouch& pouch) {
        ++made_.pouches;
        for (const int t : pouch.triangles)
            gone_[std::size_t(t)] = 1;
        const std::vector<int> vertex = placeVertices(pouch);
        const auto turnOf = [&](int v) {
            const auto on = pouch.borderPlaces.find(v);
            if (on == pouch.borderPlaces.end()) return std::int8_t(0);
            return std::int8_t(std::lround(on->second.x - made_.map.flat[std::size_t(v)].x));
        };
        for (const PlacedPouch::Piece& piece : pouch.collar) {
            auto& turn = turns_.emplace_back();
            glm::ivec3& corners = triangles_.emplace_back();
            for (int c = 0; c < 3; ++c) {
                const int key = piece.corners[c];
                if (key >= 0) turn[std::size_t(c)] = turnOf(key);
                corners[c] = key >= 0 ? key : vertex[std::size_t(-1 - key)];
            }
            sources_.push_back(piece.source);
        }
        for (const PlacedPouch::Piece& piece : pouch.inner) {
            triangles_.push_back({vertex[std::size_t(piece.corners.x)],
                                  vertex[std::size_t(piece.corners.y)],
                                  vertex[std::size_t(piece.corners.z)]});
            sources_.push_back(piece.source);
            turns_.emplace_back();
        }
    }

    void countSpread(std::size_t clusters) { made_.spread += clusters; }

    SetIn finish() {
        made_.tube.triangles.clear();
        made_.map.turns.clear();
        for (std::size_t t = 0; t < tube_.triangles.size(); ++t) {
            if (gone_[t]) continue;
            made_.tube.triangles.push_back(tube_.triangles[t]);
            made_.map.turns.push_back(map_.turns[t]);
            made_.sourceTriangle.push_back(int(t));
            made_.apart.push_back(0);
        }
        made_.tube.triangles.insert(made_.tube.triangles.end(), triangles_.begin(),
                                    triangles_.end());
        made_.map.turns.insert(made_.map.turns.end(), turns_.begin(), turns_.end());
        made_.sourceTriangle.insert(made_.sourceTriangle.end(), sources_.begin(), sources_.end());
        made_.apart.resize(made_.tube.triangles.size(), 1);
        rotate(made_.map, made_.tube, 0.0);
        return std::move(made_);
    }

private:
    /// Puts the pouch's vertices in their places, and returns their numbers.
    std::vector<int> placeVertices(const PlacedPouch& pouch) {
        std::vector<int> vertex = pouch.tubeVertex;
        for (std::size_t n = 0; n < vertex.size(); ++n) {
            if (vertex[n] < 0) {
                vertex[n] = int(made_.tube.vertices.size());
                made_.tube.vertices.push_back(pouch.verticesMm[n]);
                made_.map.flat.push_back(pouch.places[n]);
            } else {
                made_.map.flat[std::size_t(vertex[n])] = pouch.places[n];
            }
        }
        return vertex;
    }

    const TriMesh& tube_;
    const PeriodicMap& map_;
    SetIn made_;
    std::vector<char> gone_;
    std::vector<glm::ivec3> triangles_;
    std::vector<int> sources_;
    std::vector<std::array<std::int8_t, 3>> turns_;
};

/// The least disc around a spot that can be mapped apart with fewer folds than the spot has.
std::optional<PlacedPouch> leastDisc(const TriMesh& tube, const HalfedgeMesh& halfedges,
                                     const PeriodicMap& map, const Spot& spot,
                                     const std::vector<char>& taken, Discs& discs,
                                     double radiusFactor, Grids grids, PouchWork& work) {
    const double units = flatUnitsPerCircumference(map.height);
    const double most = largestRadiusAround(map, spot.middle);
    if (spot.triangles.size() > work.left) return std::nullopt;
    std::vector<char> inside(tube.triangles.size(), 0);
    for (double radius = std::max(1.5 * spot.reach, crowdedUnits / units); radius < most;
         radius *= radiusFactor) {
        const auto disc = discs.within(map, spot.triangles, spot.middle, radius, taken);
        if (!disc) continue;
        if (disc->triangles.size() > work.left) break;
        if (grids == Grids::small &&
            disc->triangles.size() > mostAround + 100 * spot.triangles.size())
            break;
        for (const int t : disc->triangles)
            inside[std::size_t(t)] = 1;
        const double clear = radius * units * roundness(tube, halfedges, map, inside, *disc);
        if (std::numbers::pi * clear * clear >
            roomUnits * roomUnits * double(disc->triangles.size())) {
            auto cut = placed(tube, halfedges, map, inside, *disc, 0, 0.0,
                              spot.triangles.size() / 2, grids, work);
            if (cut) return cut;
        }
        for (const int t : disc->triangles)
            inside[std::size_t(t)] = 0;
    }
    return std::nullopt;
}

}  // namespace

SetIn setIn(const TriMesh& tube, const PeriodicMap& map, const std::vector<Pouch>& pouches,
            PouchWork& work, int depth, Grids grids) {
    Setting setting(tube, map);
    const auto halfedges = HalfedgeMesh::of(tube);
    std::vector<char> inside(tube.triangles.size(), 0);
    for (const Pouch& pouch : pouches) {
        if (!halfedges) break;
        for (const int t : pouch.triangles)
            inside[std::size_t(t)] = 1;
        const auto most = std::size_t(mostThin * double(pouch.triangles.size()));
        if (const auto cut =
                placed(tube, *halfedges, map, inside, pouch, depth, 0.0, most, grids, work))
            setting.take(*cut);
        for (const int t : pouch.triangles)
            inside[std::size_t(t)] = 0;
    }
    return setting.finish();
}

SetIn mendFolds(const TriMesh& tube, const PeriodicMap& map, const std::vector<int>& folded,
                double radiusFactor, Grids grids, PouchWork& work) {
    PeriodicMap spread = map;
    const VertexStars stars(tube);
    const double units = flatUnitsPerCircumference(map.height);
    const std::vector<char> none;
    Spreading spreading(spread, tube, stars, none, units);
    std::vector<Spot> spots;
    std::size_t mended = 0;
    for (std::vector<int>& cluster : clustersOf(tube, stars, folded)) {
        if (cluster.size() <= mostSpread && spreading.run(cluster)) {
            ++mended;
        } else {
            spots.push_back(spotOf(tube, map, std::move(cluster)));
        }
    }
    Setting setting(tube, spread);
    setting.countSpread(mended);
    const auto halfedges = HalfedgeMesh::of(tube);
    if (!halfedges) return setting.finish();
    std::vector<char> taken(tube.triangles.size(), 0);
    Discs discs(tube, *halfedges, stars);
    for (const Spot& spot : spots) {
        if (std::ranges::any_of(spot.triangles, [&](int t) { return taken[std::size_t(t)] != 0; }))
            continue;
        const auto cut =
            leastDisc(tube, *halfedges, spread, spot, taken, discs, radiusFactor, grids, work);
        if (!cut) continue;
        for (const int t : cut->triangles)
            taken[std::size_t(t)] = 1;
        setting.take(*cut);
    }
    return setting.finish();
}

}  // namespace haustra::flatten
