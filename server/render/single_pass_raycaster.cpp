#include "render/single_pass_raycaster.h"

#include "render/picture_readback.h"
#include "render/ray_setup.h"
#include "shaders/shader_source.h"

#include <utility>

namespace haustra::render {

Result<std::unique_ptr<SinglePassRaycaster>> SinglePassRaycaster::create(
    std::shared_ptr<GlScene> scene) {
    using gpu::ComputeProgram, shaders::shaderSource;
    const auto structs = shaderSource("uniforms.h"), march = shaderSource("march.glsl");
    auto cone = ComputeProgram::create("cone_start.comp",
                                       {structs, march, shaderSource("cone_start.comp")});
    if (!cone) return tl::make_unexpected(cone.error());
    auto cast = ComputeProgram::create(
        "endoscopic.comp",
        {structs, march, shaderSource("picture.glsl"), shaderSource("endoscopic.comp")});
    if (!cast) return tl::make_unexpected(cast.error());
    return std::unique_ptr<SinglePassRaycaster>(
        new SinglePassRaycaster(std::move(scene), std::move(*cone), std::move(*cast)));
}

SinglePassRaycaster::SinglePassRaycaster(std::shared_ptr<GlScene> scene,
                                         gpu::ComputeProgram coneStart, gpu::ComputeProgram cast)
    : scene_(std::move(scene)), coneStart_(std::move(coneStart)), cast_(std::move(cast)) {}

Result<void> SinglePassRaycaster::makeTargets(glm::ivec2 size) {
    if (target_ && glm::ivec2(target_->size()) == size) return {};
    using gpu::Filter, gpu::Texture, gpu::TexelFormat;
    auto target = Texture::create(2, {size, 1}, TexelFormat::rgba8, Filter::nearest, "picture");
    if (!target) return tl::make_unexpected(target.error());
    auto starts = Texture::create(2, {(size + coneTile - 1) / coneTile, 1}, TexelFormat::r32f,
                                  Filter::nearest, "cone pass");
    if (!starts) return tl::make_unexpected(starts.error());
    target_ = std::move(*target);
    firstStep_ = std::move(*starts);
    return {};
}

Result<void> SinglePassRaycaster::render(const CameraView& view, const Band& band, Image& picture) {
    if (auto sound = checkBand(band, picture); !sound) return sound;
    if (auto sound = checkCameraView(view, band.pictureSize); !sound) return sound;
    const int errorsBefore = scene_->context().errorCount();
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    if (auto made = makeTargets(size); !made) return made;
    const auto classified = scene_->classification(view.optics, view.march);
    if (!classified) return tl::make_unexpected(classified.error());
    const Scene& scene = scene_->scene();
    shaders::MarchUniforms uniforms = marchUniforms(view, scene.grid(), (*classified)->table(),
                                                    scene.ranges.size, band.pictureSize);
    uniforms.pictureSize.w = band.firstRow;
    scene_->bind(uniforms, **classified);
    firstStep_->bindImage(shaders::startImage);
    coneStart_.dispatch((size + coneTile - 1) / coneTile);
    firstStep_->bind(shaders::startUnit);
    target_->bindImage(shaders::pictureImage);
    cast_.dispatch(size);
    return readBack(scene_->context(), *target_, errorsBefore, band.firstRow, picture);
}

std::size_t SinglePassRaycaster::gpuBytes() const {
    return target_ ? target_->bytes() + firstStep_->bytes() : 0;
}

}  // namespace haustra::render
