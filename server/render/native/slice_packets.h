// Slices, as packets.
#pragma once

#include "render/native/packet_scene.h"

namespace haustra::render {

/// One slice of a volume; voxel coordinates.
struct PacketSlice {
    glm::vec3 origin{0.0f};  ///< the centre of the picture's top left pixel
    glm::vec3 right{0.0f}, down{0.0f};
    float perHu = 1.0f, atZero = 0.0f;  ///< HU -> grey 0…1
    int width = 0;
    int firstRow = 0;  ///< of the picture: the band's row 0
};

/// Draws rows [firstRow, endRow) of a band into the whole of it, on the widest vectors that this
/// machine has: linearly interpolated, black outside the volume. Of the scene, only the volume is
/// read. Any thread.
using DrawSlice = void (*)(const PacketScene& scene, const PacketSlice& slice, int firstRow,
                           int endRow, std::uint8_t* rgb);
DrawSlice slicePackets();

}  // namespace haustra::render
