// The flattened wall's rays, as packets.
#pragma once

#include "render/flat/flat_coverage.h"
#include "render/native/packet_scene.h"

namespace haustra::render {

/// A flat map and the window onto it, as packets read them.
struct PacketWall {
    const shaders::FlatVertex* vertices = nullptr;
    const glm::ivec3* triangles = nullptr;
    const shaders::FlatEye* cameras = nullptr;
    shaders::FlatUniforms u{};  ///< but u.riseThatEnds: in HU
};

/// Some rows of a picture.
struct PacketRows {
    int firstRow = 0, rows = 0;
    const FlatPixel* pixels = nullptr;  ///< of these rows
    std::uint8_t* rgb = nullptr;        ///< the whole picture's
};

/// Casts the rays of these rows, on the widest vectors that this machine has. Any thread.
using CastFlat = void (*)(const PacketScene& scene, const PacketWall& wall, const PacketRows& rows);
CastFlat flatPackets();

}  // namespace haustra::render
