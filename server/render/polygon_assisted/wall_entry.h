// From where on rays in the lumen must look: the colon's mesh, and what stands before it
// (dissertation §6.3.1).
#pragma once

#include "render/optics/leap_map.h"
#include "render/optics/transfer_table.h"
#include "render/scene/scene.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// Triangles to rasterise; xyz: millimetres from the volume's centre.
struct EntryTriangles {
    std::vector<glm::vec4> places;
    std::vector<glm::ivec3> triangles;
};

/// The wall's mesh, moved inwards by `marginMm`, and the blocks of the leap map that it leaves on
/// the lumen's side. A ray from such a block meets nothing visible before it either meets the
/// moved mesh, or a visible block on the lumen's side (`visibleBefore`): residue, a fold that the
/// mesh has lost. So the nearest of both is a safe start whatever the mesh is worth; a better mesh
/// only leaves fewer such blocks. Immutable; any number of threads.
class WallEntry {
public:
    /// What a transfer function shows begins up to the width of the scanner's blur before the mesh,
    /// and the blocks that the moved mesh touches should be empty. Of the margins tried on a real
    /// colon (METHODS §16.3 "Rays that begin at the mesh") this leaves the fewest blocks before it.
    static constexpr double defaultMarginMm = 4.0;

    /// The scene must have a closed mesh with its indices in range. O(blocks + triangles); a byte
    /// a block.
    explicit WallEntry(const Scene& scene, double marginMm = defaultMarginMm);

    const EntryTriangles& wall() const { return wall_; }
    /// Whether each block may be visible, on the lumen's side or where the moved mesh touches.
    /// O(blocks).
    std::vector<std::uint8_t> visibleBefore(const BlockRanges& ranges, const TransferTable& table,
                                            int threads) const;
    /// The faces by which rays enter these blocks.
    EntryTriangles faces(const std::vector<std::uint8_t>& visible) const;
    /// Whether a ray may begin at the nearest of mesh and faces that begins here: in a block on the
    /// lumen's side that neither the mesh touches nor is one of `visible`.
    bool isClear(glm::dvec3 positionMm, const std::vector<std::uint8_t>& visible) const;

private:
    enum Side : std::uint8_t { lumen, touched, outside };
    void touch(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);
    void floodOutside();
    glm::dvec3 blockCoordinate(glm::dvec3 positionMm) const;
    std::size_t index(glm::ivec3 block) const;
    bool contains(glm::ivec3 block) const;

    glm::ivec3 blocks_;
    glm::dmat4 voxelFromPatient_, patientFromVoxel_;
    glm::dvec3 originMm_;
    EntryTriangles wall_;
    std::vector<Side> side_;
};

}  // namespace haustra::render
