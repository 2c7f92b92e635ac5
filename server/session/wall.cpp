#include "session/wall.h"

#include "render/wall/wall_coverage.h"
#include "store/products.h"
#include "store/sha256.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace haustra::session {
namespace {

// So near to the wall a bookmark is a place of it, wherever it looks.
constexpr double onWallMm = 2.0;

double areaMm2(const TriMesh& surface) {
    double doubled = 0.0;
    for (const glm::ivec3& t : surface.triangles) {
        const glm::dvec3 a = surface.vertices[std::size_t(t.x)];
        doubled += glm::length(glm::cross(surface.vertices[std::size_t(t.y)] - a,
                                          surface.vertices[std::size_t(t.z)] - a));
    }
    return 0.5 * doubled;
}

std::vector<WallRow> rowsOf(const FlatMap& map) {
    std::vector<double> sums(map.cameras.size(), 0.0), counts(map.cameras.size(), 0.0);
    for (std::size_t n = 0; n < map.flat.size(); ++n) {
        sums[std::size_t(map.camera[n])] += map.flat[n].y;
        counts[std::size_t(map.camera[n])] += 1.0;
    }
    struct Pool {
        double sum, count;
        std::size_t rows;
        double mean() const { return sum / count; }
    };
    std::vector<Pool> pools;
    std::vector<WallRow> rows;
    for (std::size_t n = 0; n < map.cameras.size(); ++n) {
        if (counts[n] == 0.0) continue;
        rows.push_back({map.cameras[n].arcMm, 0.0});
        Pool pool{sums[n], counts[n], 1};
        while (!pools.empty() && pools.back().mean() >= pool.mean()) {
            pool.sum += pools.back().sum;
            pool.count += pools.back().count;
            pool.rows += pools.back().rows;
            pools.pop_back();
        }
        pools.push_back(pool);
    }
    auto row = rows.begin();
    for (const Pool& pool : pools)
        for (std::size_t n = 0; n < pool.rows; ++n)
            (row++)->y = std::clamp(pool.mean(), 0.0, map.height);
    return rows;
}

// Of the numbers themselves, whatever made them.
std::string contentOf(const TriMesh& surface) {
    store::Sha256 hash;
    hash.add(std::to_string(surface.vertices.size()) + ' ');
    hash.add(std::as_bytes(std::span(surface.vertices)));
    hash.add(std::as_bytes(std::span(surface.triangles)));
    return store::toHex(hash.finish());
}

WallMeasure measure(const FlatLookup& lookup, const Measure& question) {
    WallMeasure result;
    std::vector<glm::dvec3> outline;
    const auto& points = question.points;
    const std::size_t legs = question.closed ? points.size() : points.size() - 1;
    for (std::size_t n = 0; n < legs; ++n) {
        const WallPath leg = lookup.path(points[n], points[(n + 1) % points.size()]);
        result.lengthMm += leg.lengthMm;
        outline.insert(outline.end(), leg.pointsMm.begin(), leg.pointsMm.end());
    }
    if (!question.closed) {
        result.straightMm = glm::distance(outline.front(), outline.back());
        return result;
    }
    result.areaMm2 = lookup.areaMm2(points);
    double squared = 0.0;
    for (std::size_t a = 0; a < outline.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const glm::dvec3 apart = outline[a] - outline[b];
            squared = std::max(squared, glm::dot(apart, apart));
        }
    }
    result.largestDiameterMm = std::sqrt(squared);
    return result;
}

}  // namespace

Result<std::shared_ptr<const Wall>> makeWall(std::shared_ptr<const FlatMap> map,
                                             std::vector<std::uint8_t> bridged) {
    const double area = areaMm2(map->surface);
    if (!(area > 0.0) || !std::isfinite(area))
        return fail(ErrorKind::badInput, "the flattened surface has no area",
                    store::product::flatMap);
    const double circumferenceMm = std::sqrt(area / map->height);
    std::vector<WallRow> rows = rowsOf(*map);
    FlatLookup lookup(map);
    auto sight = TRY(render::WallSight::of(map, std::move(bridged)));
    auto painter = TRY(render::StripPainter::of(std::move(sight)));
    std::string content = contentOf(map->surface);
    return std::make_shared<const Wall>(Wall{std::move(map), std::move(content), std::move(lookup),
                                             circumferenceMm, std::move(rows), std::move(painter)});
}

Result<WallAnswer> answer(const Wall& wall, const WallQuestion& question) {
    if (const auto* inStrip = std::get_if<LocateInStrip>(&question)) {
        const auto place = wall.lookup.at(inStrip->flat);
        if (!place) return fail(ErrorKind::badInput, "the place lies beyond the strip", "flat");
        return *place;
    }
    if (const auto* inSpace = std::get_if<LocateInSpace>(&question))
        return wall.lookup.nearest(inSpace->positionMm);
    return measure(wall.lookup, std::get<Measure>(question));
}

std::optional<WallPlace> markOf(const Wall& wall, glm::dvec3 positionMm, glm::dvec3 forward) {
    const WallPlace near = wall.lookup.nearest(positionMm);
    if (glm::distance(near.positionMm, positionMm) <= onWallMm) return near;
    const auto met = wall.painter->sight().firstMet(positionMm, forward);
    if (!met || met->distanceMm > render::sightLimits.farthestMm) return std::nullopt;
    const auto place = wall.lookup.at(met->flat);
    return place ? *place : wall.lookup.nearest(met->positionMm);
}

}  // namespace haustra::session
