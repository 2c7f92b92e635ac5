// The image-order raycaster: one compute pass over the picture's pixels (§5.1).
#pragma once

#include "gpu/program.h"
#include "gpu/texture.h"
#include "gpu/timestamps.h"
#include "render/gl/gl_scene.h"
#include "render/gl/march_variant.h"
#include "render/scene/raycaster.h"

#include <memory>
#include <optional>
#include <vector>

namespace haustra::render {

/// Rays leap over empty blocks, and a pass at an eighth of the resolution finds how far the rays of
/// a tile have no need to look at all.
class SinglePassRaycaster final : public Raycaster {
public:
    static Result<std::unique_ptr<SinglePassRaycaster>> create(std::shared_ptr<GlScene> scene);

    RaycasterKind kind() const override { return RaycasterKind::singlePass; }
    Result<void> render(const CameraView& view, const Band& band, Image& picture) override;
    /// The same where somebody else has found from which step on each pixel's ray must be examined:
    /// `firstSteps`, r32f, of the band's size. No cone pass is made.
    Result<void> renderFrom(const gpu::Texture& firstSteps, const CameraView& view,
                            const Band& band, Image& picture);
    std::size_t gpuBytes() const override;             ///< without the scene's
    std::vector<PassTime> passTimes() const override;  ///< "cone" and "cast", by the GPU's clock

private:
    SinglePassRaycaster(std::shared_ptr<GlScene> scene, gpu::ComputeProgram coneStart);
    Result<void> makeTargets(glm::ivec2 size);
    Result<void> cast(const gpu::Texture* firstSteps, const CameraView& view, const Band& band,
                      Image& picture);
    std::shared_ptr<GlScene> scene_;
    gpu::ComputeProgram coneStart_;
    MarchPrograms cast_{"endoscopic.comp"};
    std::optional<gpu::Texture> target_, firstStep_;
    gpu::Timestamps timestamps_;
};

}  // namespace haustra::render
