// A scene on the GPU, whole, as the raycasters that need all of it there share it.
#pragma once

#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/texture.h"
#include "render/optics/classification.h"
#include "render/scene/lru_cache.h"
#include "render/scene/picture.h"
#include "render/scene/scene.h"
#include "shaders/uniforms.h"

#include <memory>
#include <optional>

namespace haustra::render {

/// HU as a 3-D texture of 16-bit fractions (stored_value.h). Fails where a side is longer than the
/// device's textures allow or its memory is short; `what` names the volume in that message.
Result<gpu::Texture> uploadVolume(const Volume<std::int16_t>& volume, int threads,
                                  const char* what);

/// The volume's texture, the uniform block of optics.glsl, and the classifications lately asked
/// for. Belongs to the thread of the context, which must be current and outlive it.
class GlScene {
public:
    /// Each holds a leap map, a byte a block.
    static constexpr std::size_t classificationsKept = 4;

    /// 2 bytes a voxel on the GPU, and those of the gradients if they are at most
    /// `gradientBudgetBytes`. Fails as uploadVolume does.
    static Result<std::unique_ptr<GlScene>> upload(gpu::Context& context,
                                                   std::shared_ptr<const Scene> scene, int threads,
                                                   std::size_t gradientBudgetBytes = 0);

    const Scene& scene() const { return *scene_; }
    gpu::Context& context() { return context_; }

    /// Made, or found among those lately used: readers of one case may differ in their colours. The
    /// last four are kept; a new one costs some 0.1 s for a 512³ scan. Fails (badInput) on bad
    /// optics or sampling. Valid until the next call.
    Result<const Classification*> classification(const Optics& optics, const MarchOptions& march);
    /// Binds the volume, what makes it visible, and how rays run through it: all that march()
    /// reads.
    void bind(const shaders::MarchUniforms& uniforms, const Classification& classified);
    /// Binds what lies behind the volume, for shaders compiled with a backdrop. Held until another
    /// is bound. Fails where the device has no room.
    Result<void> bindBackdrop(const std::shared_ptr<const Backdrop>& backdrop);
    /// Whether gradients are read from a texture, which is made here when the first optics ask that
    /// need it: where its 8 bytes a voxel are within the budget and the device has them. Then
    /// bind() binds it, and shaders may be compiled for it (march_variant.h); else they compute
    /// gradients from six values.
    bool hasGradients(const Optics& optics);
    const gpu::Texture& volume() const { return volume_; }
    std::size_t gpuBytes() const;

private:
    GlScene(gpu::Context& context, std::shared_ptr<const Scene> scene, int threads,
            std::size_t gradientBudgetBytes, gpu::Texture volume, gpu::UniformBuffer marchBlock);
    Result<gpu::Texture> makeGradients();

    gpu::Context& context_;
    std::shared_ptr<const Scene> scene_;
    int threads_;
    std::size_t gradientBudgetBytes_;  // 0 also after a failure
    gpu::Texture volume_;
    gpu::UniformBuffer marchBlock_;
    std::optional<gpu::Texture> gradients_;
    LruCache<Classification> recent_{classificationsKept};
    std::shared_ptr<const Backdrop> backdrop_;
    std::optional<gpu::Texture> backdropTexture_;  // of backdrop_
};

}  // namespace haustra::render
