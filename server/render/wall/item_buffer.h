// Which triangles of a wall pictures show, on the GPU (dissertation §2.4).
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"
#include "core/wall_visibility.h"
#include "gpu/context.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace haustra::render {

/// Counts, for each picture, the pixels of each triangle (N_total) and those that see it before all
/// others (N_observed): the source asks an occlusion query for each triangle, one draw each; here
/// one draw with a depth test writes each pixel's triangle (an item buffer), and a second without a
/// depth test counts the pixels of those that were observed. What is known of a triangle only
/// grows. Pixels, depth of field and inner sides are those of coverage/sight.h; the two differ
/// where a pixel's centre lies on an edge, as rasters round corners to 1/256 of a pixel and rays do
/// not. Belongs to the thread of the context, which outlives it.
class ItemBuffer {
public:
    ~ItemBuffer();
    /// `bridged` (empty: none) are not 0 for triangles that are no wall. Triangles
    /// counter-clockwise seen from outside. Fails (device) where the shaders do not compile or
    /// there is no room; 60 bytes a triangle.
    static Result<std::unique_ptr<ItemBuffer>> create(gpu::Context& context, const TriMesh& wall,
                                                      const std::vector<std::uint8_t>& bridged,
                                                      const PinholePicture& picture,
                                                      bool tellFully);

    /// Adds what a picture shows. Fails (device) where the driver reports an error. O(triangles
    /// within the depth of field + pixels).
    Result<void> look(const CenterlineCamera& camera);
    /// Of each triangle of the wall, what all pictures until now have shown.
    std::vector<Visibility> seen() const;

private:
    struct Run;
    struct Parts;
    ItemBuffer(gpu::Context& context, std::unique_ptr<Parts> parts);

    gpu::Context& context_;
    std::unique_ptr<Parts> parts_;
};

}  // namespace haustra::render
