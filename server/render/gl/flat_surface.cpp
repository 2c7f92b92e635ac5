#include "render/gl/flat_surface.h"

#include "shaders/uniforms.h"

#include <span>
#include <utility>

namespace haustra::render {

Result<FlatSurface> FlatSurface::upload(std::shared_ptr<const FlatGeometry> geometry) {
    using gpu::StorageBuffer;
    auto vertices = TRY(StorageBuffer::create(
        std::span<const shaders::FlatVertex>(geometry->vertices()), "flat map"));
    auto triangles =
        TRY(StorageBuffer::create(std::span<const glm::ivec3>(geometry->triangles()), "flat map"));
    auto cameras = TRY(
        StorageBuffer::create(std::span<const shaders::FlatEye>(geometry->cameras()), "flat map"));
    return FlatSurface(std::move(geometry), std::move(vertices), std::move(triangles),
                       std::move(cameras));
}

FlatSurface::FlatSurface(std::shared_ptr<const FlatGeometry> geometry, gpu::StorageBuffer vertices,
                         gpu::StorageBuffer triangles, gpu::StorageBuffer cameras)
    : geometry_(std::move(geometry)),
      vertices_(std::move(vertices)),
      triangles_(std::move(triangles)),
      cameras_(std::move(cameras)) {}

void FlatSurface::bind() const {
    vertices_.bind(shaders::flatVertexBinding);
    triangles_.bind(shaders::flatTriangleBinding);
    cameras_.bind(shaders::flatCameraBinding);
}

std::size_t FlatSurface::gpuBytes() const {
    return vertices_.bytes() + triangles_.bytes() + cameras_.bytes();
}

}  // namespace haustra::render
