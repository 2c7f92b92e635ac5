#include "phantom/diverticula.h"

#include "phantom/random.h"
#include "phantom/wall_place.h"

#include <algorithm>

namespace haustra::phantom {

void addDiverticula(ColonShape& shape, std::uint64_t seed, int count) {
    Random random(seed, 25);
    const ColonPath& path = shape.path();
    for (int n = 0; n < count; ++n) {
        for (int attempt = 0; attempt < 60; ++attempt) {
            const bool sigmoid = random.chance(0.8);
            const double arc = sigmoid ? random.uniform(path.rectumEndMm + 15.0, path.sigmoidEndMm)
                                       : random.uniform(path.sigmoidEndMm, path.lengthMm() - 25.0);
            const double angle = random.uniform(0.0, 2.0 * 3.14159265358979);
            Diverticulum pouch;
            pouch.sacRadiusMm = random.uniform(2.0, 4.5);
            pouch.neckRadiusMm = random.uniform(1.0, 1.6);
            const double neckMm = random.uniform(0.5, 2.0);
            if (path.collapsedWithin(arc, 12.0)) continue;
            const auto place = castToWall(shape, arc, angle);
            // Through the wall itself, not through a fold that stands on it.
            if (!place || glm::distance(place->at, path.at(arc).position) < 0.8 * place->radiusMm)
                continue;
            pouch.mouth = place->at;
            pouch.centre = place->at - (neckMm + pouch.sacRadiusMm) * place->inward;
            const double roomMm = pouch.sacRadiusMm + shape.septumMm() + 2.5;
            if (shape.smoothTubeMm(pouch.centre, arc, 60.0) < roomMm + 2.5) continue;
            const auto near = [&](glm::dvec3 p, double distanceMm) {
                return glm::distance(p, pouch.centre) < distanceMm ||
                       glm::distance(p, pouch.mouth) < distanceMm;
            };
            if (std::any_of(shape.growths().begin(), shape.growths().end(), [&](const Growth& g) {
                    return near(g.centre, g.reachMm() + pouch.sacRadiusMm + 2.0);
                }))
                continue;
            if (std::any_of(shape.diverticula().begin(), shape.diverticula().end(),
                            [&](const Diverticulum& d) {
                                return near(d.centre, d.sacRadiusMm + pouch.sacRadiusMm + 2.5) ||
                                       near(d.mouth, pouch.sacRadiusMm + 4.0);
                            }))
                continue;
            if (shape.valve() && near(shape.valve()->at, shape.valve()->reachMm() + 6.0)) continue;
            // The sac lies outside the bare lumen.
            if (shape.evaluate(pouch.centre).lumenMm < pouch.sacRadiusMm - 0.5) continue;
            shape.add(pouch);
            break;
        }
    }
}

}  // namespace haustra::phantom
