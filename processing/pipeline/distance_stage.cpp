#include "pipeline/stages.h"
#include "topology/distance_field.h"

namespace haustra::pipeline {
namespace {

namespace product = store::product;

// Raise it whenever the distances change for the same lumen.
constexpr int distanceVersion = 1;

}  // namespace

Result<ProductKey> measureDistance(Preparation& preparation, const ProductKey& lumen) {
    const StageMeter meter;
    const ProductKey key = store::makeKey("distance", distanceVersion, "", {lumen});
    StageCase stage = preparation.open("distance", key);
    return preparation.run(stage, meter, [&](const Progress&) -> Result<void> {
        const auto labels = TRY(stage.readVolume<std::uint8_t>(product::lumen));
        // The transform goes axis by axis.
        if (!labels.grid().hasRightAngles())
            return fail(ErrorKind::unsupported, "the lumen's voxel axes are not at right angles");
        return stage.publish(product::distance,
                             topology::distanceToBoundaryMm(labels, preparation.options().threads));
    });
}

}  // namespace haustra::pipeline
