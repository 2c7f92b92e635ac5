#include "render/gl/gl_scene.h"

#include "core/parallel.h"
#include "gpu/program.h"
#include "render/gl/march_variant.h"
#include "render/scene/ray_setup.h"
#include "render/scene/stored_value.h"
#include "shaders/shader_source.h"

#include <algorithm>
#include <utility>

namespace haustra::render {

Result<gpu::Texture> uploadVolume(const Volume<std::int16_t>& volume, int threads,
                                  const char* what) {
    const glm::ivec3 size = volume.grid().size;
    auto texture =
        TRY(gpu::Texture::create(3, size, gpu::TexelFormat::r16, gpu::Filter::linear, what));
    // By slabs, so that the copy in the texture's encoding stays small.
    const std::size_t slice = std::size_t(size.x) * std::size_t(size.y);
    const int slab = std::max(1, int((std::size_t(16) << 20) / slice));
    std::vector<std::uint16_t> encoded;
    for (int z = 0; z < size.z; z += slab) {
        const int count = std::min(slab, size.z - z);
        encoded.resize(slice * std::size_t(count));
        const std::int16_t* from = volume.voxels().data() + slice * std::size_t(z);
        parallelFor(encoded.size(), 1 << 20, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                encoded[i] = encodeHu(from[i]);
        });
        texture.uploadSlices(z, count, encoded.data());
    }
    return texture;
}

Result<std::unique_ptr<GlScene>> GlScene::upload(gpu::Context& context,
                                                 std::shared_ptr<const Scene> scene, int threads,
                                                 std::size_t gradientBudgetBytes) {
    auto volume = TRY(uploadVolume(scene->volume, threads, "scan on the GPU"));
    auto block = TRY(gpu::UniformBuffer::create(sizeof(shaders::MarchUniforms)));
    return std::unique_ptr<GlScene>(new GlScene(context, std::move(scene), threads,
                                                gradientBudgetBytes, std::move(volume),
                                                std::move(block)));
}

GlScene::GlScene(gpu::Context& context, std::shared_ptr<const Scene> scene, int threads,
                 std::size_t gradientBudgetBytes, gpu::Texture volume,
                 gpu::UniformBuffer marchBlock)
    : context_(context),
      scene_(std::move(scene)),
      threads_(threads),
      gradientBudgetBytes_(gradientBudgetBytes),
      volume_(std::move(volume)),
      marchBlock_(std::move(marchBlock)) {}

Result<const Classification*> GlScene::classification(const Optics& optics,
                                                      const MarchOptions& march) {
    TRY(checkOptics(optics));
    TRY(checkMarch(march, optics));
    const double step = stepMm(march, scene_->grid());
    const bool leaping = march.emptySpaceLeaping;
    if (const Classification* known = recent_.find(
            [&](const Classification& one) { return one.isFor(optics, step, leaping); }))
        return known;
    recent_.makeRoom();
    auto made = TRY(Classification::create(optics, step, leaping, scene_->ranges, threads_));
    return recent_.keep(std::move(made));
}

void GlScene::bind(const shaders::MarchUniforms& uniforms, const Classification& classified) {
    marchBlock_.write(uniforms);
    marchBlock_.bind(shaders::uniformBinding);
    volume_.bind(shaders::volumeUnit);
    if (gradients_) gradients_->bind(shaders::gradientUnit);
    classified.bind();
}

bool GlScene::hasGradients(const Optics& optics) {
    if (gradients_ || !MarchVariant::of(optics, true, false).gradientTexture)
        return gradients_.has_value();
    if (8 * scene_->grid().voxelCount() > gradientBudgetBytes_) return false;
    auto made = makeGradients();
    if (!made) {
        gradientBudgetBytes_ = 0;
        return false;
    }
    gradients_ = std::move(*made);
    gradients_->bind(shaders::gradientUnit);
    return true;
}

Result<gpu::Texture> GlScene::makeGradients() {
    const glm::ivec3 size = scene_->grid().size;
    auto program = TRY(
        gpu::ComputeProgram::create("gradients.comp", {shaders::shaderSource("gradients.comp")}));
    auto made = TRY(
        gpu::Texture::create(3, size, gpu::TexelFormat::rgba16f, gpu::Filter::linear, "gradients"));
    volume_.bind(shaders::volumeUnit);
    made.bindImage(shaders::gradientImage);
    program.dispatch({size.x, size.y});
    return made;
}

Result<void> GlScene::bindBackdrop(const std::shared_ptr<const Backdrop>& backdrop) {
    if (backdrop != backdrop_) {
        if (!backdropTexture_ || glm::ivec2(backdropTexture_->size()) != backdrop->size) {
            auto made = TRY(gpu::Texture::create(2, {backdrop->size, 1}, gpu::TexelFormat::rgba32f,
                                                 gpu::Filter::nearest, "backdrop"));
            backdropTexture_ = std::move(made);
        }
        backdropTexture_->upload(backdrop->pixels.data());
        backdrop_ = backdrop;
    }
    backdropTexture_->bind(shaders::backdropUnit);
    return {};
}

std::size_t GlScene::gpuBytes() const {
    std::size_t bytes = volume_.bytes() + (backdropTexture_ ? backdropTexture_->bytes() : 0) +
                        (gradients_ ? gradients_->bytes() : 0);
    for (const Classification& one : recent_.all())
        bytes += one.gpuBytes();
    return bytes;
}

}  // namespace haustra::render
