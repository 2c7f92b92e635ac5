#include "cli/labelled_input.h"

#include "nifti/nifti_file.h"

#include <utility>

namespace haustra::cli {

Result<std::shared_ptr<const render::LabelledColorVolume>> readLabelledColor(
    const std::filesystem::path& color, const std::filesystem::path& labels, int threads) {
    auto image = TRY(nifti::readColorNifti(color));
    auto organs = TRY(nifti::readNifti<std::int16_t>(labels));
    auto volume = TRY(render::makeLabelledColor(std::move(image.voxels), std::move(organs)));
    if (!image.hasOpacity)
        volume.color =
            render::withColorOpacity(volume.color, volume.labels, {.least = 0.1}, threads);
    return std::make_shared<const render::LabelledColorVolume>(std::move(volume));
}

}  // namespace haustra::cli
