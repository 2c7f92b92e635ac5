// Draws windows onto the flattened wall.
#pragma once

#include "core/grid.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "render/gl/flat_surface.h"
#include "render/gl/march_variant.h"
#include "render/scene/picture.h"
#include "shaders/uniforms.h"

#include <memory>
#include <optional>
#include <vector>

namespace haustra::render {

/// The raster pass that finds each pixel's triangle, and the compute pass that casts its ray.
/// Belongs to the thread of the context.
class FlatPainter {
public:
    /// The flat map of a case whose volumes are on `grid`. Fails as FlatGeometry::of and
    /// FlatSurface::upload do, and where the shaders do not compile.
    static Result<FlatPainter> create(const FlatMap& map, const Grid& grid);
    static Result<FlatPainter> create(std::shared_ptr<const FlatSurface> surface);

    /// Finds which triangle covers each pixel of a band. The window must have passed its check.
    Result<void> findTriangles(const FlatWindow& window, const Band& band);
    /// What it found, rows from the top: the number of the map's triangle, or −1 beyond the strip.
    std::vector<int> triangleOfPixel() const;
    /// Casts the rays of the band that findTriangles was given last, into the whole of `picture`,
    /// which has the band's size. The volume, its classification and the block of optics.glsl must
    /// be bound; `stepMm` is that block's. Fails (device) where the driver refuses the variant's
    /// text.
    Result<void> castRays(const MarchVariant& variant, double stepMm, const gpu::Texture& picture);
    std::size_t gpuBytes() const;  ///< without the surface's

private:
    FlatPainter(std::shared_ptr<const FlatSurface> surface, gpu::RasterProgram triangles,
                gpu::UniformBuffer block);
    std::shared_ptr<const FlatSurface> surface_;
    gpu::RasterProgram triangles_;
    MarchPrograms rays_{"flattened.comp", {"volume.glsl"}, {"flat_map.glsl", "flat_wall.glsl"}};
    gpu::UniformBuffer block_;
    shaders::FlatUniforms uniforms_{};
    std::optional<gpu::Texture> triangleOfPixel_;
};

}  // namespace haustra::render
