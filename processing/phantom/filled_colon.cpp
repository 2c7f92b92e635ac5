#include "phantom/filled_colon.h"

#include "phantom/growths.h"
#include "phantom/random.h"
#include "phantom/wall_place.h"

#include <algorithm>

namespace haustra::phantom {

Grid gridOf(Size size, double fieldOfViewMm) {
    glm::ivec3 voxels(512, 512, 400);
    glm::dvec3 spacing(0.75, 0.75, 1.05);
    if (size == Size::small) voxels = {256, 256, 200}, spacing = {1.5, 1.5, 2.1};
    if (size == Size::photonCounting) voxels = {1024, 1024, 1000}, spacing = {0.35, 0.35, 0.4};
    if (fieldOfViewMm > 0.0) spacing.x = spacing.y = fieldOfViewMm / voxels.x;
    const glm::dvec3 half = 0.5 * spacing * glm::dvec3(voxels - 1);
    return axisAlignedGrid(voxels, spacing, {-half.x, -half.y, 0.5 * spacing.z});
}

BodyPlan bodyOf(const PhantomOptions& options) {
    Random random(options.seed, 6);
    BodyPlan body;
    body.position = options.position;
    body.widthScale = random.uniform(0.97, 1.06);
    body.fatMm = random.uniform(10.0, 20.0);
    return body;
}

namespace {

/// Adds up to `count` diverticula with sacs of 4 to 9 mm, four fifths of them in the sigmoid and
/// none in the rectum, clear of growths, the valve, other loops and each other. Fewer where there
/// is no room.
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
            pouch.center = place->at - (neckMm + pouch.sacRadiusMm) * place->inward;
            const double roomMm = pouch.sacRadiusMm + shape.septumMm() + 2.5;
            if (shape.smoothTubeMm(pouch.center, arc, 60.0) < roomMm + 2.5) continue;
            const auto near = [&](glm::dvec3 p, double distanceMm) {
                return glm::distance(p, pouch.center) < distanceMm ||
                       glm::distance(p, pouch.mouth) < distanceMm;
            };
            if (std::any_of(shape.growths().begin(), shape.growths().end(), [&](const Growth& g) {
                    return near(g.center, g.reachMm() + pouch.sacRadiusMm + 2.0);
                }))
                continue;
            if (std::any_of(shape.diverticula().begin(), shape.diverticula().end(),
                            [&](const Diverticulum& d) {
                                return near(d.center, d.sacRadiusMm + pouch.sacRadiusMm + 2.5) ||
                                       near(d.mouth, pouch.sacRadiusMm + 4.0);
                            }))
                continue;
            if (shape.valve() && near(shape.valve()->at, shape.valve()->reachMm() + 6.0)) continue;
            // The sac lies outside the bare lumen.
            if (shape.evaluate(pouch.center).lumenMm < pouch.sacRadiusMm - 0.5) continue;
            shape.add(pouch);
            break;
        }
    }
}

}  // namespace

FilledColon makeFilledColon(const PhantomOptions& options) {
    const BodyPlan body = bodyOf(options);
    const BowelOptions& bowel = options.bowel;
    ColonShape shape(makeColonPath(options.seed, options.preset, body, bowel), options.seed,
                     bowel.septumMm);
    addGrowths(shape, options.seed, options.preset, body);
    addMoreGrowths(shape, options.seed, options.growths, body);
    ColonField field(shape, gridOf(options.size, options.scan.fieldOfViewMm), options.threads);
    Fluid fluid = pourFluid(shape, field, options.seed, options.preset, body, bowel);
    // The levels stay: what a polyp displaces is little beside a pool.
    const std::size_t dry = shape.growths().size();
    addSubmergedPolyps(shape, fluid, options.seed, options.preset);
    for (std::size_t n = dry; n < shape.growths().size(); ++n) {
        const Growth& growth = shape.growths()[n];
        field.resample(shape, growth.center, growth.reachMm() + 3.0);
    }
    std::optional<Ileum> ileum;
    if (bowel.ileumMm > 0.0) ileum = addIleum(shape, options.seed, body, bowel);
    if (shape.valve()) field.resample(shape, shape.valve()->at, shape.valve()->reachMm() + 3.0);
    addDiverticula(shape, options.seed, bowel.diverticula);
    for (const Diverticulum& pouch : shape.diverticula())
        field.resample(shape, pouch.center, pouch.sacRadiusMm + ColonShape::reachMm + 6.0);
    std::vector<Film> films = makeFilms(shape, options.seed, options.growths);
    return {std::move(shape), std::move(field), std::move(fluid), std::move(ileum),
            std::move(films)};
}

}  // namespace haustra::phantom
