// The image-order raycaster: one compute pass over the picture's pixels (§5.1).
#pragma once

#include "gpu/program.h"
#include "gpu/texture.h"
#include "render/gl_scene.h"
#include "render/raycaster.h"

#include <optional>

namespace haustra::render {

/// Rays leap over empty blocks, and a pass at an eighth of the resolution finds how far the rays of
/// a tile have no need to look at all.
class SinglePassRaycaster final : public Raycaster {
public:
    static Result<std::unique_ptr<SinglePassRaycaster>> create(std::shared_ptr<GlScene> scene);

    RaycasterKind kind() const override { return RaycasterKind::singlePass; }
    Result<void> render(const CameraView& view, const Band& band, Image& picture) override;
    std::size_t gpuBytes() const override;  ///< without the scene's

private:
    SinglePassRaycaster(std::shared_ptr<GlScene> scene, gpu::ComputeProgram coneStart,
                        gpu::ComputeProgram cast);
    Result<void> makeTargets(glm::ivec2 size);
    std::shared_ptr<GlScene> scene_;
    gpu::ComputeProgram coneStart_, cast_;
    std::optional<gpu::Texture> target_, firstStep_;
};

}  // namespace haustra::render
