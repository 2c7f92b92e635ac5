#include "render/gl/single_pass_raycaster.h"

#include "render/gl/picture_readback.h"
#include "render/scene/ray_setup.h"
#include "shaders/shader_source.h"

#include <utility>

namespace haustra::render {

Result<std::unique_ptr<SinglePassRaycaster>> SinglePassRaycaster::create(
    std::shared_ptr<GlScene> scene) {
    using shaders::shaderSource;
    auto cone = TRY(gpu::ComputeProgram::create(
        "cone_start.comp",
        {shaderSource("uniforms.h"), shaderSource("srgb.glsl"), shaderSource("lens.glsl"),
         shaderSource("optics.glsl"), shaderSource("rays.glsl"), shaderSource("picture.glsl"),
         shaderSource("cone_start.comp")}));
    std::unique_ptr<SinglePassRaycaster> made(
        new SinglePassRaycaster(std::move(scene), std::move(cone)));
    // A driver that refuses the text is found here, not in a reader's session.
    TRY(made->cast_.program({}));
    return made;
}

SinglePassRaycaster::SinglePassRaycaster(std::shared_ptr<GlScene> scene,
                                         gpu::ComputeProgram coneStart)
    : scene_(std::move(scene)), coneStart_(std::move(coneStart)) {}

Result<void> SinglePassRaycaster::makeTargets(glm::ivec2 size) {
    if (target_ && glm::ivec2(target_->size()) == size) return {};
    using gpu::Filter, gpu::Texture, gpu::TexelFormat;
    auto target =
        TRY(Texture::create(2, {size, 1}, TexelFormat::rgba8, Filter::nearest, "picture"));
    auto starts = TRY(Texture::create(2, {(size + coneTile - 1) / coneTile, 1}, TexelFormat::r32f,
                                      Filter::nearest, "cone pass"));
    target_ = std::move(target);
    firstStep_ = std::move(starts);
    return {};
}

Result<void> SinglePassRaycaster::render(const CameraView& view, const Band& band, Image& picture) {
    return cast(nullptr, view, band, picture);
}

Result<void> SinglePassRaycaster::renderFrom(const gpu::Texture& firstSteps, const CameraView& view,
                                             const Band& band, Image& picture) {
    return cast(&firstSteps, view, band, picture);
}

Result<void> SinglePassRaycaster::cast(const gpu::Texture* firstSteps, const CameraView& view,
                                       const Band& band, Image& picture) {
    TRY(checkBand(band, picture));
    TRY(checkCameraView(view, band.pictureSize));
    const int errorsBefore = scene_->context().errorCount();
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    TRY(makeTargets(size));
    const auto classified = TRY(scene_->classification(view.optics, view.march));
    const Scene& scene = scene_->scene();
    shaders::MarchUniforms uniforms =
        marchUniforms(view, scene.grid(), classified->table(), scene.ranges.size, band.pictureSize);
    uniforms.firstRow = band.firstRow;
    if (firstSteps) uniforms.coneTileSide = 1;
    const auto rays = TRY(cast_.program(MarchVariant::of(
        view.optics, scene_->hasGradients(view.optics), view.backdrop != nullptr)));
    scene_->bind(uniforms, *classified);
    if (view.backdrop) {
        TRY(scene_->bindBackdrop(view.backdrop));
    }
    timestamps_.restart();
    timestamps_.mark();
    if (!firstSteps) {
        firstStep_->bindImage(shaders::startImage);
        coneStart_.dispatch((size + coneTile - 1) / coneTile);
    }
    timestamps_.mark();
    (firstSteps ? *firstSteps : *firstStep_).bind(shaders::startUnit);
    target_->bindImage(shaders::pictureImage);
    rays->dispatch(size);
    timestamps_.mark();
    return readBack(scene_->context(), *target_, errorsBefore, band.firstRow, picture);
}

std::vector<PassTime> SinglePassRaycaster::passTimes() const {
    const std::vector<double> ms = timestamps_.betweenMs();
    if (ms.size() != 2) return {};
    return {{"cone", ms[0]}, {"cast", ms[1]}};
}

std::size_t SinglePassRaycaster::gpuBytes() const {
    return target_ ? target_->bytes() + firstStep_->bytes() : 0;
}

}  // namespace haustra::render
