// Draws the colon from outside.
#pragma once

#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/raster_target.h"
#include "render/raycaster.h"
#include "render/scene.h"
#include "render/view.h"
#include "shaders/overview_uniforms.h"

#include <memory>
#include <optional>
#include <vector>

namespace haustra::render {

/// The wall's mesh is rasterised first; it is what the body's rays end at. Wall and body are kept
/// until the view of them changes: while a reader flies, only path, reader and bookmarks are drawn
/// anew. Belongs to the thread of the context, which must be current and outlive it.
class OverviewPainter {
public:
    /// The scene's wall and path may be missing, and are then not drawn. Fails where the shaders do
    /// not compile or the GPU has no room: 48 bytes a vertex and 12 a triangle.
    static Result<std::unique_ptr<OverviewPainter>> create(gpu::Context& context,
                                                           std::shared_ptr<const Scene> scene);

    /// `raycaster` draws the body: of this scene. The picture's edges are smooth up to a million
    /// pixels. Fails (badInput) on a bad view, (device) where the driver reports an error.
    Result<Image> draw(const OverviewView& view, glm::ivec2 size, Raycaster& raycaster);
    std::size_t gpuBytes() const;

private:
    OverviewPainter(gpu::Context& context, std::shared_ptr<const Scene> scene,
                    gpu::RasterProgram wall, gpu::RasterProgram marks, gpu::UniformBuffer block);
    /// Wall and body of the picture that was drawn last.
    struct Ground {
        OverviewView view;
        glm::ivec2 size;
        Image picture;
    };
    bool shows(const OverviewView& view, glm::ivec2 size) const;
    Result<void> makeTargets(glm::ivec2 size);
    Result<Image> drawGround(const OverviewView& view, glm::ivec2 size, Raycaster& raycaster);
    Result<void> addMarks(const OverviewView& view, Image& picture);

    gpu::Context& context_;
    std::shared_ptr<const Scene> scene_;
    glm::dvec3 originMm_;
    gpu::RasterProgram wall_, marks_;
    gpu::UniformBuffer block_;
    std::optional<gpu::StorageBuffer> wallVertices_, wallTriangles_;
    std::optional<gpu::RasterTarget> wallTarget_, marksTarget_;
    std::optional<Ground> ground_;
};

}  // namespace haustra::render
