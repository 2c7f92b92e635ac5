#include "cli/labelled_input.h"

#include "nifti/nifti_file.h"

#include <utility>

namespace haustra::cli {

Result<std::shared_ptr<const render::LabelledColorVolume>> readLabelledColor(
    const std::filesystem::path& color, const std::filesystem::path& labels, int threads) {
    auto image = nifti::readColorNifti(color);
    if (!image) return tl::make_unexpected(image.error());
    auto organs = nifti::readNifti<std::int16_t>(labels);
    if (!organs) return tl::make_unexpected(organs.error());
    auto volume = render::makeLabelledColor(std::move(image->voxels), std::move(*organs));
    if (!volume) return tl::make_unexpected(volume.error());
    if (!image->hasOpacity)
        volume->color =
            render::withColorOpacity(volume->color, volume->labels, {.least = 0.1}, threads);
    return std::make_shared<const render::LabelledColorVolume>(std::move(*volume));
}

}  // namespace haustra::cli
