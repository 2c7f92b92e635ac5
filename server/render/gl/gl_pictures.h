// Slices and flattened views, drawn by shaders.
#pragma once

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "render/gl/flat_painter.h"
#include "render/gl/gl_scene.h"
#include "render/scene/case_pictures.h"

#include <memory>
#include <optional>

namespace haustra::render {

/// Belongs to the thread of the context, which must be current and outlive it.
class GlPictures final : public CasePictures {
public:
    /// `ct` is the scan before cleansing; where it is not the scene's volume, it is copied to the
    /// GPU, 2 bytes a voxel. `surface` is null where the case has no flat map. Fails as
    /// uploadVolume does, and where a shader is refused.
    static Result<std::unique_ptr<GlPictures>> create(std::shared_ptr<GlScene> scene,
                                                      const Volume<std::int16_t>& ct,
                                                      std::shared_ptr<const FlatSurface> surface,
                                                      int threads);

    Result<Image> slice(const SlicePicture& picture, const Band& band) override;
    Result<Image> flat(const FlatView& view, const Band& band) override;
    /// Without the scene's and the surface's.
    std::size_t gpuBytes() const override;

private:
    GlPictures(std::shared_ptr<GlScene> scene, std::optional<gpu::Texture> ct,
               std::optional<FlatPainter> flat, gpu::ComputeProgram slice,
               gpu::UniformBuffer sliceBlock);
    Result<void> makePicture(glm::ivec2 size);
    Result<Image> readPicture(int errorsBefore);

    std::shared_ptr<GlScene> scene_;
    std::optional<gpu::Texture> ct_;  // where it is not the scene's
    std::optional<FlatPainter> flat_;
    gpu::ComputeProgram slice_;
    gpu::UniformBuffer sliceBlock_;
    std::optional<gpu::Texture> picture_;
};

}  // namespace haustra::render
