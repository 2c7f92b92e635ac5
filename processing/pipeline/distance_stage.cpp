#include "pipeline/stages.h"
#include "topology/distance_field.h"

#include <cmath>

namespace haustra::pipeline {
namespace {

namespace product = store::product;

// Raise it whenever the distances change for the same lumen.
constexpr int distanceVersion = 1;

// The distance transform goes axis by axis, which needs axes at right angles.
Result<void> checkOrthogonal(const Grid& grid) {
    const glm::dmat3 axes(grid.patientFromVoxel);
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        const double cosine =
            glm::dot(axes[a], axes[b]) / (glm::length(axes[a]) * glm::length(axes[b]));
        if (!(std::abs(cosine) <= 1e-3)) {
            return fail(ErrorKind::unsupported, "the lumen's voxel axes are not at right angles");
        }
    }
    return {};
}

}  // namespace

Result<ProductKey> measureDistance(Preparation& preparation, const ProductKey& lumen) {
    const StageMeter meter;
    const ProductKey key = store::makeKey("distance", distanceVersion, "", {lumen});
    StageCase stage = preparation.open("distance", key);
    return preparation.run(stage, meter, [&](const Progress&) -> Result<void> {
        const auto labels = TRY(stage.readVolume<std::uint8_t>(product::lumen));
        TRY(checkOrthogonal(labels.grid()));
        return stage.publish(product::distance,
                             topology::distanceToBoundaryMm(labels, preparation.options().threads));
    });
}

}  // namespace haustra::pipeline
