// What of the wall has not been seen, patch by patch, for somebody to go there and look (Kreeger et
// al., SPIE Medical Imaging 2002;4683:198; dissertation §2.5).
#pragma once

#include "core/centerline.h"
#include "core/tri_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// For each triangle those beyond its edges: (corner 0, corner 1), (1, 2), (2, 0); −1 where there
/// is none. Corners at one place are one corner, so that a flat map's cut surface goes on across
/// its seam; where more than two triangles share an edge, those that follow each other in the mesh
/// are neighbours. Indices must be in range. O(n log n); thread-safe.
std::vector<glm::ivec3> neighboursOf(const TriMesh& wall);

/// Which triangles count as seen: those that are (not 0 in `seen`), and each that is not, but has
/// neighbours of which at least one is seen and none is unseen: a hole of one triangle between seen
/// ones is how pictures sample the wall, not something that a reader missed. `bridged` (not 0: no
/// wall; empty: all is wall) are neither seen nor unseen. 0 or 1 each, 0 for bridges. O(n).
std::vector<std::uint8_t> withoutSingles(std::span<const glm::ivec3> neighbours,
                                         std::span<const std::uint8_t> seen,
                                         std::span<const std::uint8_t> bridged = {});

/// Unseen triangles that join each other edge by edge.
struct MissedPatch {
    double areaMm2 = 0.0;
    /// The place of the patch nearest to the mean of its triangles' middles by area; LPS.
    glm::dvec3 centerMm{0.0};
    int centerTriangle = -1;  ///< that the centre lies in
    glm::dvec3 inward{0.0};   ///< unit, into the lumen, of the wall within a few mm of the centre
    /// On the centerline, from the rectum: the sample nearest to the centre of those that lie on
    /// the wall's inner side there, so that a loop that touches from outside is not taken; where
    /// that one is farther than a colon is wide (60 mm), the nearest of all.
    double arcMm = 0.0;
    std::vector<std::int32_t> triangles;  ///< ascending
};

/// The patches of a wall (counter-clockwise seen from outside) that withoutSingles leaves unseen,
/// bridges aside, the largest first; of equal areas the one with the lowest triangle first. Areas
/// add up to that of all unseen triangles. `neighbours` are neighboursOf(wall), which stay the same
/// whatever is seen; without a centerline all arcs are 0. Smaller ones than `leastMm2` are left
/// out. Sizes must fit. O(n + unseen log unseen + patches · samples); thread-safe.
std::vector<MissedPatch> missedPatches(const TriMesh& wall, std::span<const glm::ivec3> neighbours,
                                       std::span<const std::uint8_t> seen,
                                       std::span<const std::uint8_t> bridged,
                                       const Centerline& centerline, double leastMm2 = 0.0);

}  // namespace haustra
