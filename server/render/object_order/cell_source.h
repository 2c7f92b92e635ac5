// What is in a volume's cells, as the GPU keeps it.
#pragma once

#include "core/volume.h"
#include "gpu/texture.h"
#include "render/object_order/cell_grid.h"

#include <cstddef>
#include <cstdint>

namespace haustra::render {

/// A box of voxels. Beyond the volume's faces the nearest voxel's value goes on, as textures clamp.
struct VoxelBox {
    glm::ivec3 corner{0};
    int side = 0;
};

/// Where cells are read from: main memory, or a mapped product. Any number of threads may read.
class CellSource {
public:
    virtual ~CellSource() = default;
    virtual gpu::TexelFormat format() const = 0;
    virtual std::size_t texelBytes() const = 0;
    /// Writes box.side³ texels, x fastest.
    virtual void read(const VoxelBox& box, std::byte* texels) const = 0;
};

/// HU in the encoding of stored_value.h.
class ScanCells final : public CellSource {
public:
    explicit ScanCells(Volume<std::int16_t> volume) : volume_(std::move(volume)) {}
    gpu::TexelFormat format() const override { return gpu::TexelFormat::r16; }
    std::size_t texelBytes() const override { return sizeof(std::uint16_t); }
    void read(const VoxelBox& box, std::byte* texels) const override;

private:
    Volume<std::int16_t> volume_;
};

/// Calls row(y, z, texel) for each row of a box: the voxels' row, and the first texel's index.
template <class Row>
void forEachRow(const VoxelBox& box, glm::ivec3 voxels, Row&& row) {
    std::size_t texel = 0;
    for (int k = 0; k < box.side; ++k) {
        const int z = glm::clamp(box.corner.z + k, 0, voxels.z - 1);
        for (int j = 0; j < box.side; ++j, texel += std::size_t(box.side))
            row(glm::clamp(box.corner.y + j, 0, voxels.y - 1), z, texel);
    }
}

/// Texels of a row that lie inside the volume: [first, second); at least one.
inline glm::ivec2 insideOfRow(const VoxelBox& box, glm::ivec3 voxels) {
    return {glm::clamp(-box.corner.x, 0, box.side - 1),
            glm::clamp(voxels.x - box.corner.x, 1, box.side)};
}

}  // namespace haustra::render
