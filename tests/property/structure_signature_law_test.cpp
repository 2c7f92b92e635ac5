// Thin and small tissue in fluid is told from fluid, its borders and noise.
#include "cleansing/submerged_mixture.h"
#include "cleansing_scenes.h"

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::test;

namespace {

constexpr double noiseSd = 12.0;

/// Mean signature where `at` holds of a place.
template <class Where>
double meanSignature(const Scene& scene, const Where& at) {
    double sum = 0.0;
    int count = 0;
    const Grid& grid = scene.scan.hu.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (v.z < 3 || v.z + 3 >= grid.size.z) continue;
        if (!at(grid.patientFromVoxelPoint(glm::dvec3(v)))) continue;
        sum += cleansing::structureSignature(scene.scan.hu, v, noiseSd), ++count;
    }
    return sum / count;
}

TEST(StructureSignature, FoldsAndPolypsHaveItAndEvenFluidHasNot) {
    const glm::dvec3 ball(30.0, 15.0, 12.0);
    const Scene scene = makeScene({56, 40, 24}, 600.0, noiseSd, [=](glm::dvec3 p) {
        const double fold = blurredStep(p.x - 14.4) - blurredStep(p.x - 15.6);
        const double polyp = blurredStep(1.5 - glm::distance(p, ball));
        return Shares{0.0, 1.0 - fold - polyp};
    });
    EXPECT_GT(meanSignature(scene, [](glm::dvec3 p) { return std::abs(p.x - 15.0) < 0.4; }), 0.9);
    EXPECT_GT(meanSignature(scene, [&](glm::dvec3 p) { return glm::distance(p, ball) < 0.8; }),
              0.9);
    EXPECT_LT(meanSignature(
                  scene,
                  [](glm::dvec3 p) { return p.x > 18.0 && p.x < 26.0 && p.y > 3.0 && p.y < 26.0; }),
              0.06);
}

}  // namespace
