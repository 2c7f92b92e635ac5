#include "render/gl/gl_pictures.h"

#include "render/gl/march_variant.h"
#include "render/gl/picture_readback.h"
#include "render/scene/ray_setup.h"
#include "render/scene/stored_value.h"
#include "shaders/shader_source.h"
#include "shaders/uniforms.h"

#include <utility>

namespace haustra::render {

Result<std::unique_ptr<GlPictures>> GlPictures::create(std::shared_ptr<GlScene> scene,
                                                       const Volume<std::int16_t>& ct,
                                                       std::shared_ptr<const FlatSurface> surface,
                                                       int threads) {
    using shaders::shaderSource;
    std::optional<gpu::Texture> ctTexture;
    if (ct.voxels().data() != scene->scene().volume.voxels().data()) {
        auto texture = TRY(uploadVolume(ct, threads, "scan on the GPU"));
        ctTexture = std::move(texture);
    }
    auto slice = TRY(gpu::ComputeProgram::create(
        "slice.comp", {shaderSource("uniforms.h"), shaderSource("slice.comp")}));
    auto block = TRY(gpu::UniformBuffer::create(sizeof(shaders::SliceUniforms)));
    std::optional<FlatPainter> flat;
    if (surface) {
        auto painter = TRY(FlatPainter::create(std::move(surface)));
        flat = std::move(painter);
    }
    return std::unique_ptr<GlPictures>(new GlPictures(std::move(scene), std::move(ctTexture),
                                                      std::move(flat), std::move(slice),
                                                      std::move(block)));
}

GlPictures::GlPictures(std::shared_ptr<GlScene> scene, std::optional<gpu::Texture> ct,
                       std::optional<FlatPainter> flat, gpu::ComputeProgram slice,
                       gpu::UniformBuffer sliceBlock)
    : scene_(std::move(scene)),
      ct_(std::move(ct)),
      flat_(std::move(flat)),
      slice_(std::move(slice)),
      sliceBlock_(std::move(sliceBlock)) {}

Result<void> GlPictures::makePicture(glm::ivec2 size) {
    if (picture_ && glm::ivec2(picture_->size()) == size) return {};
    auto made = TRY(gpu::Texture::create(2, {size, 1}, gpu::TexelFormat::rgba8,
                                         gpu::Filter::nearest, "picture"));
    picture_ = std::move(made);
    return {};
}

Result<Image> GlPictures::readPicture(int errorsBefore) {
    Image image = blankImage(picture_->size());
    TRY(readBack(scene_->context(), *picture_, errorsBefore, 0, image));
    return image;
}

Result<Image> GlPictures::slice(const SlicePicture& picture, const Band& band) {
    const auto& [placement, window, scan, slab] = picture;
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    const int errorsBefore = scene_->context().errorCount();
    TRY(makePicture(size));
    const Grid& grid = scene_->scene().grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const glm::dvec3 voxels(grid.size);
    const auto textureVector = [&](glm::dvec3 mm) {
        return glm::dvec3(voxelFromPatient * glm::dvec4(mm, 0.0)) / voxels;
    };
    shaders::SliceUniforms u{};
    u.originTexture = glm::vec4(
        (glm::dvec3(voxelFromPatient * glm::dvec4(placement.topLeftMm, 1.0)) + 0.5) / voxels, 0.0);
    u.rightTexture = glm::vec4(textureVector(placement.rightMm), 0.0);
    u.downTexture = textureVector(placement.downMm);
    const SlabSamples samples = slabSamples(slab, placement.normal(), grid);
    u.alongTexture = textureVector(samples.stepMm);
    u.samplesAside = samples.aside;
    u.rightTexture.w = slab.projection == Projection::maximum ? 1.0f : 0.0f;
    u.greyScale = float(storedRange / window.widthHu);
    u.greyBias = float(0.5 - (storedOffset + window.centerHu) / window.widthHu);
    u.bandSize = size;
    u.firstRow = band.firstRow;
    sliceBlock_.write(u);
    sliceBlock_.bind(shaders::uniformBinding);
    (scan == Scan::original && ct_ ? *ct_ : scene_->volume()).bind(shaders::volumeUnit);
    picture_->bindImage(shaders::pictureImage);
    slice_.dispatch(size);
    return readPicture(errorsBefore);
}

Result<Image> GlPictures::flat(const FlatView& view, const Band& band) {
    if (!flat_) return fail(ErrorKind::badInput, "the case has no flat map", "flattened view");
    const int errorsBefore = scene_->context().errorCount();
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    const auto classified = TRY(scene_->classification(view.optics, view.march));
    TRY(makePicture(size));
    const Scene& scene = scene_->scene();
    scene_->bind(marchUniforms(view.optics, view.march, scene.grid(), classified->table(),
                               scene.ranges.size, size),
                 *classified);
    TRY(flat_->findTriangles(view.window, band));
    const MarchVariant variant =
        MarchVariant::of(view.optics, scene_->hasGradients(view.optics), false);
    TRY(flat_->castRays(variant, stepMm(view.march, scene.grid()), *picture_));
    return readPicture(errorsBefore);
}

std::size_t GlPictures::gpuBytes() const {
    std::size_t bytes = flat_ ? flat_->gpuBytes() : 0;
    for (const std::optional<gpu::Texture>* texture : {&ct_, &picture_})
        if (*texture) bytes += (*texture)->bytes();
    return bytes;
}

}  // namespace haustra::render
