#include "phantom/wild.h"

#include "phantom/random.h"

namespace haustra::phantom {

PhantomOptions wildOptions(std::uint64_t seed) {
    PhantomOptions options;
    options.seed = seed;
    Random random(seed, 40);
    options.preset = random.chance(0.5) ? Preset::standard : Preset::hard;
    BowelOptions& bowel = options.bowel;
    if (random.chance(0.85)) bowel.ileumMm = random.uniform(250.0, 900.0);
    bowel.ileumCalibreMm = random.uniform(12.0, 30.0);
    bowel.valveOpen = random.chance(0.5);
    if (random.chance(0.75)) bowel.septumMm = random.uniform(0.5, 1.0);
    for (int left = random.index(4); left > 0; --left)
        bowel.collapsesMm.push_back(random.uniform(5.0, 60.0));
    if (random.chance(0.4)) bowel.redundantSigmoidMm = random.uniform(100.0, 300.0);
    if (random.chance(0.6)) bowel.untagged = random.uniform(0.1, 0.4);
    if (random.chance(0.6)) bowel.layered = random.uniform(0.1, 0.5);
    if (random.chance(0.6)) bowel.full = random.uniform(0.1, 0.5);
    if (random.chance(0.5)) bowel.diverticula = 10 + random.index(91);
    bowel.rectalTube = random.chance(0.5);
    ScanOptions& scan = options.scan;
    Random scanner(seed, 41);
    scan.fieldOfViewMm = scanner.uniform(320.0, 500.0);
    if (scanner.chance(0.5)) {
        const double plane = scanner.uniform(0.6, 1.5);
        scan.blurMm = {plane, plane * scanner.uniform(0.8, 1.25), scanner.uniform(0.8, 3.0)};
    }
    if (scanner.chance(0.5)) scan.overshoot = scanner.uniform(0.1, 0.6);
    scan.grainMm = scanner.uniform(0.8, 2.5);
    if (scanner.chance(0.6)) scan.pseudoEnhancementHu = scanner.uniform(10.0, 80.0);
    Random room(seed, 42);
    if (room.chance(0.5)) scan.streakHu = room.uniform(5.0, 40.0);
    scan.metalHip = room.chance(0.15);
    scan.feetFirst = room.chance(0.3);
    return options;
}

}  // namespace haustra::phantom
