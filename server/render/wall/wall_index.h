// Which place of the wall each pixel of a camera's picture sees.
#pragma once

#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/raster_target.h"
#include "gpu/texture.h"
#include "render/gl/flat_surface.h"
#include "render/scene/raycaster.h"
#include "render/wall/wall_paint.h"
#include "shaders/wall_uniforms.h"

#include <optional>
#include <vector>

namespace haustra::render {

/// Rasterises the flat map's cut surface with a depth test, a triangle's number for each pixel, and
/// then cuts each pixel's ray with its triangle (dissertation §6.3.1). Of a fisheye's picture the
/// six sides of a cube around the camera are drawn, or five where it sees nothing behind. Whatever
/// raycaster draws the picture, also one without a GPU, a software device can do this: what lies
/// wholly outside a pass is not drawn. Belongs to the thread of the context.
class WallIndex {
public:
    /// Fails where the shaders do not compile.
    static Result<WallIndex> create();

    /// One for each pixel of the band, rows from the top: the place where its ray first meets the
    /// surface, from whichever side. The surface is open at the colon's two ends. The camera must
    /// have passed its check. Fails (device) where the driver reports an error. O(triangles +
    /// pixels).
    /// Of one surface, from the first call to the last.
    Result<std::vector<WallPixel>> find(gpu::Context& context, const FlatSurface& surface,
                                        const Camera& camera, const Band& band);
    std::size_t gpuBytes() const;

private:
    WallIndex(gpu::RasterProgram triangles, gpu::ComputeProgram places, gpu::UniformBuffer block);
    /// Triangles that follow each other in drawing order lie close to each other: a run of them is
    /// within a ball, from the surface's origin.
    struct Run {
        TriangleRange triangles;
        glm::vec3 middleMm{0.0f};
        float radiusMm = 0.0f;
    };
    void makeRuns(const FlatGeometry& geometry);
    void drawSeen(const FlatSurface& surface, shaders::WallUniforms& pass);
    Result<void> makeTargets(glm::ivec2 picture, glm::ivec2 raster);
    gpu::RasterProgram triangles_;
    gpu::ComputeProgram places_;
    gpu::UniformBuffer block_;
    std::vector<Run> runs_;
    std::optional<gpu::RasterTarget> triangleOfPixel_;
    std::optional<gpu::Texture> placeOfPixel_;
};

}  // namespace haustra::render
