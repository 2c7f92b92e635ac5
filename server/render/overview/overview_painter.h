// Draws the colon from outside.
#pragma once

#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/raster_target.h"
#include "render/scene/lru_cache.h"
#include "render/scene/picture.h"
#include "render/scene/raycaster.h"
#include "render/scene/scene.h"
#include "shaders/overview_uniforms.h"

#include <memory>
#include <optional>

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

    /// Draws the band's rows into `picture`, which has the whole picture's size; `raycaster`, which
    /// is of this scene, draws the body. Path, reader and bookmarks come over all of the picture
    /// with the last rows, which therefore need the rows above them drawn before. The picture's
    /// edges are smooth up to a million pixels. Fails (badInput) on a bad view or band, (device)
    /// where the driver reports an error.
    Result<void> draw(const OverviewView& view, const Band& band, Raycaster& raycaster,
                      Image& picture);
    std::size_t gpuBytes() const;

private:
    OverviewPainter(gpu::Context& context, std::shared_ptr<const Scene> scene,
                    gpu::RasterProgram wall, gpu::RasterProgram marks, gpu::UniformBuffer block);
    /// What the wall looks like depends on.
    struct Sight {
        Camera camera;
        glm::ivec2 size;
        bool operator==(const Sight&) const = default;
    };
    struct Wall {
        Sight sight;
        std::shared_ptr<const Backdrop> backdrop;
    };
    /// Wall and body, of the rows from the top that have been drawn.
    struct Ground {
        OverviewView view;
        Image picture;
        int rows = 0;
    };
    bool shows(const OverviewView& view, glm::ivec2 size) const;
    Result<void> makeTargets(glm::ivec2 size);
    void rasterizeWall(const Sight& sight);
    std::shared_ptr<const Backdrop> wallOf(const Sight& sight);
    Result<void> drawGround(const OverviewView& view, const Band& band, Raycaster& raycaster,
                            Image& picture);
    Result<void> addMarks(const OverviewView& view, Image& picture);

    gpu::Context& context_;
    std::shared_ptr<const Scene> scene_;
    glm::dvec3 originMm_;
    gpu::RasterProgram wall_, marks_;
    gpu::UniformBuffer block_;
    std::optional<gpu::StorageBuffer> wallVertices_, wallTriangles_;
    std::optional<gpu::RasterTarget> wallTarget_, marksTarget_;
    std::optional<Sight> inTarget_;  // whose wall wallTarget_ holds
    LruCache<Wall> walls_{4};        // of 16 bytes a pixel: readers' bands alternate
    std::optional<Ground> ground_;
};

}  // namespace haustra::render
