// Packets of rays: what they read, which is plain numbers and pointers, the same for every vector
// width, and what they draw.
#pragma once

#include "render/optics/optics.h"
#include "shaders/uniforms.h"

#include <cstdint>

namespace haustra::render {

struct FlatPixel;

/// A volume, its leap map and its transfer table. Voxel coordinates have their centres at integers.
struct PacketScene {
    const std::int16_t* voxels = nullptr;
    std::int32_t size[3] = {0, 0, 0};  ///< at least 2 along x: voxels are read in pairs
    std::int64_t rowStride = 0, sliceStride = 0;
    /// Bytes; three more may be read behind the last.
    const std::uint8_t* leap = nullptr;
    std::int32_t lastBlock[3] = {0, 0, 0};
    Composition composition = Composition::emissionAbsorption;
    bool shading = true;
    const float* table = nullptr;  ///< rgba, rows of TransferTable::entries each
    int rows = 1;
    const float* integrals = nullptr;  ///< of pre-integrated optics, TransferTable::entries
    float entriesPerHu = 1.0f, firstEntry = 0.0f;  ///< HU -> entry
    float rowsPerGradient = 0.0f;                  ///< length of a normal (optics-inl.h) -> row
    float visibleAboveHu = 0.0f, visibleBelowHu = 0.0f;
    float lastVisibleHu = 0.0f;  ///< from here on the table goes on unchanged
    float voxelFromMm[3][3];     ///< rows: a patient vector becomes voxels
    shaders::MarchUniforms u;

    /// Whether byte offsets of voxels need more than 32 bits.
    bool isFar() const { return sliceStride * size[2] > (std::int64_t(1) << 31) - 1; }
};

/// Rows of one picture that camera packets draw.
struct PacketPicture {
    int firstRow = 0, endRow = 0;
    std::uint8_t* rgb = nullptr;          ///< the whole picture's
    const glm::vec4* backdrop = nullptr;  ///< the whole picture's, or null
};

/// What camera packets do on this machine's vector units.
struct CameraPackets {
    /// Pixels along the sides of the stretch that one call draws.
    int tileWidth = 0, tileHeight = 0;
    /// Draws what of the picture lies in the tile at (x, y), counted in tiles.
    void (*cast)(const PacketScene& scene, const PacketPicture& picture, int x, int y) = nullptr;
};
/// The widest that this machine has; any thread.
CameraPackets cameraPackets();

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

/// Casts the rays of these rows of the flattened wall, on the widest vectors that this machine has.
/// Any thread.
using CastFlat = void (*)(const PacketScene& scene, const PacketWall& wall, const PacketRows& rows);
CastFlat flatPackets();

/// One slice of a volume; voxel coordinates.
struct PacketSlice {
    glm::vec3 origin{0.0f};  ///< the centre of the picture's top left pixel
    glm::vec3 right{0.0f}, down{0.0f};
    glm::vec3 along{0.0f};              ///< from one sample of a slab to the next
    int samplesAside = 0;               ///< of a slab, on each side of the plane
    bool maximum = false;               ///< of a slab's samples; else their mean
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
