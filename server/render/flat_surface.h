// A flat map on the GPU.
#pragma once

#include "core/flat_map.h"
#include "gpu/buffer.h"

#include <vector>

namespace haustra::render {

/// Triangles [first, first + count), in the order of the GPU's copy.
struct TriangleRange {
    int first = 0, count = 0;
};

/// The map's vertices, triangles and cameras as shaders/flat_map.glsl and flattened.comp read them.
/// Belongs to the thread of the context.
class FlatSurface {
public:
    /// Millimetres are counted from `originMm`, which should be near. Fails (badInput) where the
    /// map is not sound: numbers of flat coordinates and cameras that differ from the vertices',
    /// indices out of range, values that are not finite, nothing in it, or a height over
    /// maxFlatHeight; (device) where the GPU has no room. O(n log n); 48 bytes a vertex and 12 a
    /// triangle on the GPU, 20 a triangle in main memory.
    static Result<FlatSurface> upload(const FlatMap& map, glm::dvec3 originMm);

    double height() const { return height_; }
    glm::dvec3 originMm() const { return originMm_; }
    int cameraCount() const { return cameraCount_; }
    /// Flat coordinates are stored as whole numbers of 1 / unitsPerCircumference, a power of two.
    int unitsPerCircumference() const { return unitsPerCircumference_; }

    /// A range that holds every triangle with a place in lowY … highY. O(log n).
    TriangleRange trianglesWithin(double lowY, double highY) const;
    const gpu::StorageBuffer& triangles() const { return triangles_; }
    int triangleCount() const { return int(mapTriangle_.size()); }
    /// The number in the map of the GPU's triangle.
    int mapTriangle(int triangle) const { return mapTriangle_[std::size_t(triangle)]; }
    void bind() const;  ///< to the bindings of shaders/uniforms.h
    std::size_t gpuBytes() const;

private:
    FlatSurface(gpu::StorageBuffer vertices, gpu::StorageBuffer triangles,
                gpu::StorageBuffer cameras);
    gpu::StorageBuffer vertices_, triangles_, cameras_;
    std::vector<int> mapTriangle_;
    std::vector<double> lowestY_;        // of each triangle: rising
    std::vector<double> highestYSoFar_;  // of all triangles up to each: rising
    glm::dvec3 originMm_{0.0};
    double height_ = 0.0;
    int cameraCount_ = 0, unitsPerCircumference_ = 0;
};

}  // namespace haustra::render
