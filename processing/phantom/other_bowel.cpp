#include "phantom/anatomy.h"
#include "phantom/implicit.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>

namespace haustra::phantom {
namespace {

using Chain = std::vector<glm::dvec3>;

double chainDistance(const Chain& chain, double radius, glm::dvec3 p) {
    double d = 1e9;
    for (std::size_t n = 1; n < chain.size(); ++n)
        d = std::min(d, capsule(p, chain[n - 1], chain[n], radius));
    return d;
}

struct Contents {
    double gasAboveMm = 1e9;  ///< height of the level
    double fluidHu = 25.0;
};

std::function<double(glm::dvec3, double)> contents(glm::dvec3 up, Contents c, double wallMm,
                                                   std::uint64_t seed) {
    return [=](glm::dvec3 p, double d) {
        if (d > -wallMm) return 45.0;
        if (glm::dot(up, p) > c.gasAboveMm) return -985.0;
        return c.fluidHu + 0.06 * std::abs(c.fluidHu) * valueNoise(seed, p, 8.0);
    };
}

void addStomach(std::vector<Solid>& solids, Random& random, Preset preset, glm::dvec3 up) {
    // Fundus under the left dome, antrum across the midline.
    const glm::dvec3 fundus{48, 6, 352}, body{52, -36, 318}, antrum{6, -48, 300};
    const double wall = 4.0;
    auto distance = [=](glm::dvec3 p) {
        const double d = std::min({ellipsoid(p, fundus, {34, 34, 30}),
                                   capsule(p, fundus, body, 25.0), capsule(p, body, antrum, 18.0)});
        const double rugae =
            1.6 * std::sin(0.55 * p.x + 0.2 * p.z) * std::sin(0.5 * p.z - 0.3 * p.y);
        return std::max(d + rugae, 0.75 * (p.z + 8.0 - BodyPlan::diaphragmZ(p.x, p.y)));
    };
    const double hu = preset == Preset::easy ? 20.0
                      : random.chance(0.6)   ? random.uniform(150.0, 450.0)
                                             : 25.0;
    const Contents inside{glm::dot(up, fundus) + random.uniform(-12.0, 10.0), hu};
    solids.push_back({{-20, -90, 275},
                      {100, 60, 395},
                      distance,
                      contents(up, inside, wall, random.bits()),
                      4.5,
                      std::uint8_t(Site::otherBowel),
                      wall});
}

}  // namespace

std::vector<Solid> makeOtherBowel(std::uint64_t seed, Preset preset, const BodyPlan& body) {
    Random random(seed, 5);
    const glm::dvec3 up = -gravityDirection(body.position);
    std::vector<Solid> solids;
    addStomach(solids, random, preset, up);

    const bool easy = preset == Preset::easy;
    const int loops = easy ? 60 : 110;
    for (int n = 0; n < loops; ++n) {
        const double radius = random.uniform(6.5, 11.5);
        Chain chain;
        glm::dvec3 at{random.uniform(-78.0, 78.0), random.uniform(-64.0, 8.0),
                      random.uniform(112.0, 270.0)};
        glm::dvec3 heading = glm::normalize(random.normal3() + glm::dvec3(0.01));
        const int pieces = 3 + random.index(4);
        for (int k = 0; k <= pieces; ++k) {
            chain.push_back(at);
            heading = glm::normalize(heading + 0.75 * random.normal3());
            at += heading * random.uniform(9.0, 15.0);
            at = glm::clamp(at, glm::dvec3(-84, -68, 105), glm::dvec3(84, 8, 292));
        }
        // A sixth hold gas over fluid; many are full of fluid, opacified where tagging reached.
        Contents inside;
        const double kind = random.uniform();
        double top = -1e9, bottom = 1e9;
        for (const glm::dvec3& p : chain) {
            top = std::max(top, glm::dot(up, p) + radius),
            bottom = std::min(bottom, glm::dot(up, p) - radius);
        }
        if (kind < 0.16) inside.gasAboveMm = glm::mix(bottom, top, random.uniform(0.2, 0.8));
        inside.fluidHu =
            !easy && random.chance(0.5) ? random.uniform(180.0, 520.0) : random.uniform(10.0, 40.0);
        glm::dvec3 low = chain[0], high = chain[0];
        for (const glm::dvec3& p : chain)
            low = glm::min(low, p), high = glm::max(high, p);
        const auto distance = [chain, radius](glm::dvec3 p) {
            return chainDistance(chain, radius, p);
        };
        solids.push_back({low - radius - 2.0, high + radius + 2.0, distance,
                          contents(up, inside, 2.0, random.bits()),
                          easy ? 10.0 : ColonShape::wallMm + 0.3, std::uint8_t(Site::otherBowel),
                          2.0});
    }
    return solids;
}

}  // namespace haustra::phantom
