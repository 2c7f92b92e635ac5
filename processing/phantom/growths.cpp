#include "phantom/growths.h"

#include "phantom/random.h"
#include "phantom/wall_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace haustra::phantom {
namespace {

Growth polypAt(const WallPlace& place, Growth::Kind kind, double diameterMm, Random& random) {
    Growth growth;
    growth.kind = kind;
    growth.inward = place.inward;
    growth.tangent = place.tangent;
    growth.seed = random.bits();
    growth.root = place.at;
    const double r = 0.5 * diameterMm;
    if (kind == Growth::Kind::flat) {
        const double height = std::min(2.8, 0.4 * diameterMm);
        growth.semiAxes = {r, r * random.uniform(0.75, 0.95), height};
        growth.center = place.at;
    } else if (kind == Growth::Kind::pedunculated) {
        growth.semiAxes = {r, r * random.uniform(0.85, 1.0), r * random.uniform(0.8, 0.95)};
        growth.stalkRadiusMm = std::clamp(0.18 * diameterMm, 1.2, 2.4);
        growth.center = place.at + place.inward * (growth.semiAxes.z + random.uniform(2.5, 5.0));
        growth.rootDepthMm = 1.0;
        growth.root = place.at - growth.rootDepthMm * place.inward;
    } else {
        growth.semiAxes = {r, r * random.uniform(0.85, 1.0), r * random.uniform(0.85, 1.0)};
        growth.center = place.at + place.inward * (growth.semiAxes.z * random.uniform(0.25, 0.5));
    }
    return growth;
}

/// What a place for a growth must be like.
struct Wanted {
    double fromMm = 45.0, beforeEndMm = 20.0;  ///< stretch of the colon
    double apartMm = 25.0;                     ///< from the centres of other growths
    double radiusAtLeastMm = 11.0;             ///< of the colon there
    glm::dvec3 downward{0.0};  ///< unit: on the lower wall, facing up; zero: anywhere
    int attempts = 80;
    /// Further wishes about what grew.
    std::function<bool(const Growth&)> fits = [](const Growth&) { return true; };
};

class Placer {
public:
    Placer(ColonShape& shape, Random& random) : shape_(shape), random_(random) {}

    /// Adds what `grow` makes of the first free place found; false after many tries.
    template <class Grow>
    bool add(const Wanted& wanted, const Grow& grow) {
        const ColonPath& path = shape_.path();
        for (int attempt = 0; attempt < wanted.attempts; ++attempt) {
            const double arc = random_.uniform(wanted.fromMm, path.lengthMm() - wanted.beforeEndMm);
            const double angle = random_.uniform(0.0, 2.0 * 3.14159265358979);
            if (path.collapsedWithin(arc, 30.0)) continue;
            if (path.at(arc).radiusMm < wanted.radiusAtLeastMm) continue;
            const auto place = castToWall(shape_, arc, angle);
            if (!place) continue;
            if (glm::dot(place->inward, wanted.downward) > -0.5 * glm::length(wanted.downward))
                continue;
            if (crowded(place->at, wanted.apartMm)) continue;
            const Growth growth = grow(*place);
            if (!wanted.fits(growth) || blocksAxis(growth)) continue;
            shape_.add(growth);
            return true;
        }
        return false;
    }

private:
    bool crowded(glm::dvec3 at, double apartMm) const {
        const auto& others = shape_.growths();
        return std::any_of(others.begin(), others.end(),
                           [&](const Growth& g) { return glm::distance(g.center, at) < apartMm; });
    }
    /// The axis stays open, so that the true centerline runs through lumen.
    bool blocksAxis(const Growth& growth) const {
        const auto& samples = shape_.path().samples;
        return std::any_of(samples.begin(), samples.end(), [&](const PathSample& s) {
            return glm::distance(s.position, growth.center) < growth.reachMm() + 3.0 &&
                   growth.distance(s.position) < 2.5;
        });
    }

    ColonShape& shape_;
    Random& random_;
};

}  // namespace

void addGrowths(ColonShape& shape, std::uint64_t seed, Preset preset, const BodyPlan& body) {
    Random random(seed, 3);
    Placer placer(shape, random);
    const glm::dvec3 gravity = gravityDirection(body.position);

    // One of each kind and size class, spread over the colon at places that the seed draws.
    using Kind = Growth::Kind;
    const std::array<std::pair<Kind, double>, 9> wanted = {
        {{Kind::sessile, random.uniform(4.0, 6.0)},
         {Kind::sessile, random.uniform(6.0, 8.0)},
         {Kind::sessile, random.uniform(8.0, 10.0)},
         {Kind::sessile, random.uniform(10.0, 13.0)},
         {Kind::pedunculated, random.uniform(6.0, 9.0)},
         {Kind::pedunculated, random.uniform(9.0, 12.0)},
         {Kind::pedunculated, random.uniform(12.0, 15.0)},
         {Kind::flat, random.uniform(7.0, 10.0)},
         {Kind::flat, random.uniform(10.0, 15.0)}}};
    for (const auto& [kindOf, size] : wanted) {
        const Kind kind = kindOf;
        const double diameter = size;
        Wanted where;
        where.radiusAtLeastMm =
            std::max(12.0, kind == Kind::pedunculated ? diameter + 5.0 : 0.8 * diameter);
        // Some are sought on the lower wall, where fluid may cover them.
        if (random.chance(0.4)) where.downward = gravity;
        const auto grow = [&](const WallPlace& place) {
            return polypAt(place, kind, diameter, random);
        };
        if (!placer.add(where, grow)) {
            where.downward = glm::dvec3(0.0);
            placer.add(where, grow);
        }
    }
    const int bumps = preset == Preset::easy ? 2 : 6;
    for (int n = 0; n < bumps; ++n) {
        Wanted where;
        where.apartMm = 15.0;
        placer.add(where, [&](const WallPlace& place) {
            Growth bump = polypAt(place, Kind::sessile, random.uniform(2.5, 4.5), random);
            bump.kind = Kind::hyperplastic;
            return bump;
        });
    }

    const int tagged = preset == Preset::easy ? 5 : preset == Preset::standard ? 16 : 22;
    const int untagged = preset == Preset::hard ? 9 : 0;
    for (int n = 0; n < tagged + untagged; ++n) {
        const double r = random.uniform(1.5, 5.5);
        Wanted where;
        where.fromMm = 60.0, where.beforeEndMm = 15.0;
        where.apartMm = r + 10.0;
        where.radiusAtLeastMm = 2.2 * r + 3.0;
        // Most stool rests on the lower wall; some sticks anywhere.
        if (random.chance(0.65)) where.downward = gravity;
        placer.add(where, [&](const WallPlace& place) {
            Growth stool;
            stool.kind = n < tagged ? Kind::taggedStool : Kind::untaggedStool;
            stool.inward = place.inward, stool.tangent = place.tangent, stool.root = place.at;
            const double x = random.uniform(0.9, 1.4), y = random.uniform(0.8, 1.2),
                         z = random.uniform(0.7, 1.0);
            stool.semiAxes = r * glm::dvec3(x, y, z);
            stool.center = place.at + place.inward * (0.75 * stool.semiAxes.z);
            stool.seed = random.bits();
            stool.hu = n >= tagged              ? random.uniform(5.0, 60.0)
                       : preset == Preset::hard ? random.uniform(200.0, 400.0)
                                                : random.uniform(350.0, 800.0);
            return stool;
        });
    }
}

void addSubmergedPolyps(ColonShape& shape, const Fluid& fluid, std::uint64_t seed, Preset preset) {
    Random random(seed, 9);
    Placer placer(shape, random);
    struct Kind {
        Growth::Kind kind;
        double fromMm, toMm;
        bool cutBySurface;
    };
    using enum Growth::Kind;
    const std::vector<Kind> wanted =
        preset == Preset::easy
            ? std::vector<Kind>{{sessile, 4.0, 6.0, false}, {flat, 7.0, 10.0, false}}
            : std::vector<Kind>{{sessile, 4.0, 6.0, false},
                                {sessile, 6.0, 9.0, false},
                                {pedunculated, 6.0, 8.0, false},
                                {flat, 8.0, 12.0, false},
                                {sessile, 7.0, 10.0, true}};
    for (const Kind& kind : wanted) {
        const double diameter = random.uniform(kind.fromMm, kind.toMm);
        Wanted where;
        where.attempts = 600;
        where.apartMm = 20.0;
        where.fits = [&](const Growth& growth) {
            const double height = fluid.heightMm(growth.center);
            const double depth = fluid.poolAt(shape.evaluate(growth.center).arcMm).levelMm - height;
            // The whole head and a little fluid above it; or the surface about its middle.
            return kind.cutBySurface ? std::abs(depth) < 0.1 * diameter
                                     : depth > 0.55 * diameter + 1.5;
        };
        placer.add(where, [&](const WallPlace& place) {
            return polypAt(place, kind.kind, diameter, random);
        });
    }
}

void addMoreGrowths(ColonShape& shape, std::uint64_t seed, const GrowthOptions& options,
                    const BodyPlan& body) {
    Random random(seed, 61);
    Placer placer(shape, random);
    for (int n = 0; n < options.morePolyps; ++n) {
        const double draw = random.uniform(0.0, 1.0), diameter = random.uniform(4.0, 15.0);
        const auto kind = draw < 0.45  ? Growth::Kind::sessile
                          : draw < 0.7 ? Growth::Kind::pedunculated
                                       : Growth::Kind::flat;
        const double lowest = kind == Growth::Kind::sessile ? 4.0 : 6.0;
        Wanted where;
        where.apartMm = 18.0;
        where.radiusAtLeastMm =
            std::max(12.0, kind == Growth::Kind::pedunculated ? diameter + 5.0 : 0.8 * diameter);
        if (random.chance(0.4)) where.downward = gravityDirection(body.position);
        placer.add(where, [&](const WallPlace& place) {
            Growth growth = polypAt(place, kind, std::max(lowest, diameter), random);
            if (kind == Growth::Kind::sessile) {
                // From a low dome to a head that hangs over its base.
                const double height = random.uniform(0.4, 0.85) * diameter,
                             half = std::min(growth.semiAxes.x, 0.62 * height);
                growth.semiAxes.z = half;
                growth.center = place.at + place.inward * (height - half);
            } else if (kind == Growth::Kind::flat) {
                growth.semiAxes.z = std::min(random.uniform(1.8, 3.0), 0.45 * diameter);
            } else {
                // The stalk leans.
                growth.center += random.uniform(-2.0, 2.0) * place.tangent;
            }
            return growth;
        });
    }
    Random flatRandom(seed, 62);
    Placer flatPlacer(shape, flatRandom);
    for (int n = 0; n < options.moreFlat; ++n) {
        const double diameter = flatRandom.uniform(6.0, 18.0);
        Wanted where;
        where.apartMm = 0.5 * diameter + 11.0;
        where.radiusAtLeastMm = std::max(12.0, diameter);
        if (flatRandom.chance(0.3)) where.downward = gravityDirection(body.position);
        flatPlacer.add(where, [&](const WallPlace& place) {
            Growth growth = polypAt(place, Growth::Kind::flat, diameter, flatRandom);
            growth.semiAxes.z = flatRandom.uniform(1.0, 2.5);
            growth.footMm = flatRandom.uniform(0.8, 3.5);
            return growth;
        });
    }
    for (int n = 0; n < options.moreUntaggedStool; ++n) {
        const double r = random.uniform(2.5, 6.0);
        Wanted where;
        where.fromMm = 60.0, where.beforeEndMm = 15.0;
        where.apartMm = r + 10.0;
        where.radiusAtLeastMm = 2.2 * r + 3.0;
        if (random.chance(0.65)) where.downward = gravityDirection(body.position);
        placer.add(where, [&](const WallPlace& place) {
            Growth stool;
            stool.kind = Growth::Kind::untaggedStool;
            stool.inward = place.inward, stool.tangent = place.tangent, stool.root = place.at;
            const double x = random.uniform(0.9, 1.3), y = random.uniform(0.8, 1.2),
                         z = random.uniform(0.6, 1.0);
            stool.semiAxes = r * glm::dvec3(x, y, z);
            stool.center = place.at + place.inward * (random.uniform(0.5, 0.9) * stool.semiAxes.z);
            stool.seed = random.bits();
            stool.hu = random.uniform(5.0, 60.0);
            return stool;
        });
    }
}

Findings polypsOf(const ColonShape& shape) {
    Findings polyps;
    for (const Growth& growth : shape.growths()) {
        if (!growth.polyp()) continue;
        const double diameter =
            2.0 * std::max({growth.semiAxes.x, growth.semiAxes.y, growth.semiAxes.z});
        polyps.findings.push_back({growth.center, diameter, 1.0,
                                   growth.kind == Growth::Kind::sessile        ? "sessile"
                                   : growth.kind == Growth::Kind::pedunculated ? "pedunculated"
                                                                               : "flat"});
    }
    return polyps;
}

}  // namespace haustra::phantom
