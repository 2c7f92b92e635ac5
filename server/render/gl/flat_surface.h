// A flat map on the GPU.
#pragma once

#include "gpu/buffer.h"
#include "render/flat/flat_geometry.h"

#include <memory>

namespace haustra::render {

/// The geometry's vertices, triangles and cameras as shaders/flat_map.glsl and flattened.comp read
/// them. Belongs to the thread of the context.
class FlatSurface {
public:
    /// Fails (device) where the GPU has no room. 48 bytes a vertex and 12 a triangle on the GPU.
    static Result<FlatSurface> upload(std::shared_ptr<const FlatGeometry> geometry);

    const FlatGeometry& geometry() const { return *geometry_; }
    glm::dvec3 originMm() const { return geometry_->originMm(); }
    int unitsPerCircumference() const { return geometry_->unitsPerCircumference(); }
    const gpu::StorageBuffer& triangles() const { return triangles_; }
    int triangleCount() const { return int(geometry_->triangles().size()); }
    void bind() const;  ///< to the bindings of shaders/uniforms.h
    std::size_t gpuBytes() const;

private:
    FlatSurface(std::shared_ptr<const FlatGeometry> geometry, gpu::StorageBuffer vertices,
                gpu::StorageBuffer triangles, gpu::StorageBuffer cameras);
    std::shared_ptr<const FlatGeometry> geometry_;
    gpu::StorageBuffer vertices_, triangles_, cameras_;
};

}  // namespace haustra::render
