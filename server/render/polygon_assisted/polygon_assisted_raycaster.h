// The image-order raycaster whose rays begin at the colon's rasterised mesh (§6.3.1).
#pragma once

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/raster_target.h"
#include "render/gl/gl_scene.h"
#include "render/gl/march_variant.h"
#include "render/gl/single_pass_raycaster.h"
#include "render/polygon_assisted/wall_entry.h"
#include "render/scene/lru_cache.h"
#include "render/scene/raycaster.h"

#include <optional>

namespace haustra::render {

/// Two passes: triangles give each pixel's first step, then its ray is cast from there. The
/// triangles are the wall's mesh, moved inwards, and the faces of whatever blocks a transfer
/// function shows before it (wall_entry.h): nothing visible is ever jumped over, so that pixels are
/// the single pass's. Where the camera is not in the lumen, or its lens bends straight lines, or
/// leaping is off, or a transfer function shows so much of the lumen that the mesh tells nothing,
/// rays begin as in a single pass.
class PolygonAssistedRaycaster final : public Raycaster {
public:
    /// Fails (badInput) where the scene has no mesh of the wall, or one that is not closed; else as
    /// SinglePassRaycaster. Takes 0.2 s for a colon's.
    static Result<std::unique_ptr<PolygonAssistedRaycaster>> create(std::shared_ptr<GlScene> scene,
                                                                    int threads);

    RaycasterKind kind() const override { return RaycasterKind::polygonAssisted; }
    Result<void> render(const CameraView& view, const Band& band, Image& picture) override;
    std::size_t gpuBytes() const override;             ///< without the scene's
    std::vector<PassTime> passTimes() const override;  ///< "mesh", and the single pass's
    /// Whether the last band's rays began at the mesh.
    bool beganAtMesh() const { return beganAtMesh_; }
    /// Blocks that stand visible before the mesh, in the last view's colours.
    std::size_t blocksBefore() const { return blocksBefore_; }
    /// How often such blocks were looked for: once for each transfer function, as long as no more
    /// than four take turns.
    int searches() const { return searches_; }

private:
    /// Triangles on the GPU.
    struct Mesh {
        gpu::StorageBuffer places, triangles;
        int count;
    };
    /// What one transfer function shows before the mesh.
    struct Before {
        Optics optics;
        double stepMm = 0.0;
        std::vector<std::uint8_t> visible;
        std::size_t count = 0;
        std::optional<Mesh> faces;  // where there are any, and not too many
        bool tooMany = false;
    };
    PolygonAssistedRaycaster(std::shared_ptr<GlScene> scene, int threads,
                             std::unique_ptr<SinglePassRaycaster> rays, gpu::RasterProgram entry,
                             gpu::UniformBuffer block, WallEntry wall, Mesh mesh);
    static Result<Mesh> upload(const EntryTriangles& triangles);
    /// Valid until the next call.
    Result<const Before*> findBefore(const Optics& optics, double stepMm,
                                     const TransferTable& table);
    bool mayBeginAtMesh(const CameraView& view, const Before& before) const;
    Result<void> drawEntry(const CameraView& view, const Band& band, double stepMm,
                           const Before& before);

    std::shared_ptr<GlScene> scene_;
    int threads_;
    std::unique_ptr<SinglePassRaycaster> rays_;
    gpu::RasterProgram entry_;
    gpu::UniformBuffer block_;
    WallEntry wall_;
    Mesh mesh_;
    static constexpr std::size_t searchesKept = 4;  // as many classifications as the scene keeps
    LruCache<Before> before_{searchesKept};
    int searches_ = 0;
    std::size_t blocksBefore_ = 0;
    std::optional<gpu::RasterTarget> firstStep_;
    gpu::Timestamps timestamps_;
    bool beganAtMesh_ = false;
};

}  // namespace haustra::render
