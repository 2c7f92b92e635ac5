// Levels of fluid under gas: flat across the true vertical, with nothing but blur between.
#include "segmentation/air_fluid_levels.h"

#include "segmentation/bowel_contents.h"
#include "segmentation/field_of_view.h"
#include "segmentation/hu_range_lumen.h"

#include <cmath>
#include <functional>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::segmentation;

namespace {

TissueModel tissueModel() {
    TissueModel tissue;
    tissue.meanHu = {-1000, -100, 40, 600};
    tissue.airBelowHu = -480, tissue.taggedAboveHu = 200;
    return tissue;
}

/// A supine patient of soft tissue in the room's air, on a grid that is turned about x: HU of each
/// place (x to the left, y down), blurred by 0.8 mm.
struct Scan {
    Volume<std::int16_t> hu;
    BowelContents contents;

    Scan(double turnDegrees, const std::function<double(glm::dvec3)>& inside,
         double sliceMm = 1.0) {
        Grid grid = axisAlignedGrid({90, 90, int(60 / sliceMm)}, {1.0, 1.0, sliceMm});
        const glm::dvec3 middle(45, 45, 30);
        grid.patientFromVoxel =
            glm::rotate(glm::dmat4(1.0), glm::radians(turnDegrees), glm::dvec3(1, 0, 0)) *
            glm::translate(glm::dmat4(1.0), -middle) * grid.patientFromVoxel;
        Volume<std::int16_t> sharp(grid);
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n)));
            sharp.writable()[n] =
                std::int16_t(std::hypot(p.x, p.y) > 38.0 ? -1000.0 : std::round(inside(p)));
        }
        hu = smoothHu(sharp, 0.8, 1);
        contents = findContents(hu, fieldOfView(hu, 1), PatientPosition::supine, tissueModel(), 1);
    }
    double areaMm2() const {
        double sum = 0.0;
        for (const Level& level : contents.levels)
            sum += level.areaMm2;
        return sum;
    }
};

// A ball of gas over fluid, the level at y = 5: 24² − 5² in radius.
double ballOfFluid(glm::dvec3 p) {
    return glm::length(p) > 24.0 ? 40.0 : p.y < 5.0 ? -1000.0 : 600.0;
}

TEST(AirFluidLevels, AreFoundOnObliqueGrids) {
    const double trueMm2 = M_PI * (24.0 * 24.0 - 5.0 * 5.0);
    for (const double degrees : {0.0, 3.0, 8.0, 15.0}) {
        const Scan scan(degrees, ballOfFluid);
        EXPECT_NEAR(scan.areaMm2() / trueMm2, 1.0, 0.1) << degrees;
        EXPECT_TRUE(scan.contents.warnings.empty()) << degrees;
        EXPECT_EQ(scan.contents.gravity, glm::dvec3(0, 1, 0));
    }
    // From slice to slice the level climbs by one and a half voxels.
    EXPECT_NEAR(Scan(27.0, ballOfFluid, 3.0).areaMm2() / trueMm2, 1.0, 0.15);
}

// Two walls of 1.5 mm lie between the gas of one loop and the fluid of another.
TEST(AirFluidLevels, AreNotTakenForFluidBehindWalls) {
    const auto walled = [](double wallMm) {
        return [=](glm::dvec3 p) {
            if (glm::length(p) > 24.0) return 40.0;
            return p.y < 5.0 ? -1000.0 : p.y < 5.0 + wallMm ? 40.0 : 600.0;
        };
    };
    EXPECT_GT(Scan(0.0, walled(0.0)).areaMm2(), 1000.0);
    EXPECT_EQ(Scan(0.0, walled(3.0)).areaMm2(), 0.0);
    // Nor does what is flat behind walls overrule the position that the series tells.
    const Scan sideways(0.0, [&](glm::dvec3 p) { return walled(2.5)({p.y, p.x, p.z}); });
    EXPECT_TRUE(sideways.contents.warnings.empty());
    EXPECT_EQ(sideways.contents.gravity, glm::dvec3(0, 1, 0));
    const Scan lying(0.0, [&](glm::dvec3 p) { return ballOfFluid({p.y, p.x, p.z}); });
    EXPECT_EQ(lying.contents.gravity, glm::dvec3(1, 0, 0)) << "a true level does";
}

TEST(AirFluidLevels, AnEdgeIsAsWideAsItsBlur) {
    const Scan scan(0.0, [](glm::dvec3 p) { return glm::length(p) > 24.0 ? 40.0 : -1000.0; });
    // A ball's edges are crossed aslant, by a square root of two at most where they are steep.
    for (const int axis : {0, 1}) {
        const double mm = edgeWidthMm(scan.hu, tissueModel(), scan.contents.content, axis).value();
        EXPECT_GT(mm, 1.35 * 0.8);
        EXPECT_LT(mm, 1.35 * 0.8 * std::sqrt(2.0));
    }
    const Scan solid(0.0, [](glm::dvec3) { return 40.0; });
    EXPECT_FALSE(edgeWidthMm(solid.hu, tissueModel(), solid.contents.content, 1));
}

}  // namespace
