// Where the lumen's boundary crosses the line between two voxel centres, and how it stands there.
#pragma once

#include "core/volume.h"

namespace haustra::contouring {

struct Crossing {
    glm::dvec3 onEdge{0.0};  ///< in voxels from the origin, strictly between the two centres
    glm::dvec3 point{0.0};   ///< likewise, where HU crosses, up to half an edge beyond it
    glm::dvec3 normal{0.0};  ///< unit, mm, along rising HU; zero where the HU do not show the wall
    /// 1 where HU cross between the centres, falling to 0 half an edge beyond.
    double weight = 0.0;
};

/// The wall in the HU between voxels that labels tell apart. Reads only; any thread.
class BoundaryCrossings {
public:
    /// Places are told from the voxel `origin`: near the boundary, so that the same boundary
    /// elsewhere on a grid gives the same numbers to the last bit.
    BoundaryCrossings(const Volume<std::int16_t>& hu, double isoHu, glm::ivec3 origin);

    /// `inside` and `outside` are neighbours along an axis; one may be beyond the grid. Where HU
    /// rises outwards and crosses isoHu between the two centres or a little beyond them, there is
    /// the wall; else (where a handle was cut, along a bridge) it is midway.
    Crossing between(glm::ivec3 inside, glm::ivec3 outside) const;

    glm::ivec3 origin() const { return origin_; }
    /// Voxel axes in patient mm.
    const glm::dmat3& mmFromVoxel() const { return mmFromVoxel_; }

private:
    double at(glm::ivec3 v) const;
    /// HU a voxel, by Sobel's stencil of 27 voxels: smoothed across each difference, it has half
    /// the noise of central differences and follows oblique walls better.
    glm::dvec3 gradient(glm::ivec3 v) const;

    const Volume<std::int16_t>& hu_;
    double isoHu_;
    glm::ivec3 origin_, last_;
    glm::dmat3 mmFromVoxel_, covectorMm_;
};

}  // namespace haustra::contouring
