#include "phantom/filled_colon.h"

#include "phantom/diverticula.h"
#include "phantom/growths.h"
#include "phantom/random.h"

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

FilledColon makeFilledColon(const PhantomOptions& options) {
    const BodyPlan body = bodyOf(options);
    const BowelOptions& bowel = options.bowel;
    ColonShape shape(makeColonPath(options.seed, options.preset, body, bowel), options.seed,
                     bowel.septumMm);
    addGrowths(shape, options.seed, options.preset, body);
    ColonField field(shape, gridOf(options.size, options.scan.fieldOfViewMm), options.threads);
    Fluid fluid = pourFluid(shape, field, options.seed, options.preset, body, bowel);
    // The levels stay: what a polyp displaces is little beside a pool.
    const std::size_t dry = shape.growths().size();
    addSubmergedPolyps(shape, fluid, options.seed, options.preset);
    for (std::size_t n = dry; n < shape.growths().size(); ++n) {
        const Growth& growth = shape.growths()[n];
        field.resample(shape, growth.centre, growth.reachMm() + 3.0);
    }
    std::optional<Ileum> ileum;
    if (bowel.ileumMm > 0.0) ileum = addIleum(shape, options.seed, body, bowel);
    if (shape.valve()) field.resample(shape, shape.valve()->at, shape.valve()->reachMm() + 3.0);
    addDiverticula(shape, options.seed, bowel.diverticula);
    for (const Diverticulum& pouch : shape.diverticula())
        field.resample(shape, pouch.centre, pouch.sacRadiusMm + ColonShape::reachMm + 6.0);
    return {std::move(shape), std::move(field), std::move(fluid), std::move(ileum)};
}

}  // namespace haustra::phantom
