// A reader's way to the patches that a flight has missed (Kreeger et al., SPIE Medical Imaging
// 2002;4683:198; dissertation §2.5).
#pragma once

#include "core/missed_patches.h"
#include "coverage/sight.h"

namespace haustra::coverage {

/// A wall, and what review and planning need to know of it besides its rays.
struct CoverageWall {
    TriMesh mesh;
    std::vector<glm::ivec3> neighbours;  ///< neighboursOf(mesh)
    std::vector<std::uint8_t> bridged;   ///< of each triangle
    Centerline centerline;

    std::vector<MissedPatch> missed(const std::vector<Visibility>& seen) const;
    double areaMm2(std::size_t triangle) const;
};

/// The camera that shows most of a patch, by area, of those that a reader would try: before its
/// centre, along the wall's normal there and 40° to four sides of it, at half and at nine tenths of
/// the way that is free, at most 50 mm; and from the centerline at the patch's arc and 15 mm before
/// and behind it. All look at the patch's centre. None where none of them shows any of it.
/// Deterministic; a dozen pictures of 128² rays.
std::optional<CenterlineCamera> cameraForPatch(const SightTree& tree, const CoverageWall& wall,
                                               const MissedPatch& patch);

struct Review {
    int patches = 0;  ///< that were visited
    int rounds = 0;
    std::vector<CenterlineCamera> cameras;
};

/// Visits each patch of at least `leastMm2`, by one picture of cameraForPatch each, and then those
/// that are still as large, until there is none or a round shows nothing new (at most ten rounds).
/// Adds to `seen`. Fails as look() does.
Result<Review> reviewMissed(const SightTree& tree, const CoverageWall& wall,
                            const Eyepiece& eyepiece, double leastMm2,
                            std::vector<Visibility>& seen, const SightOptions& options);

}  // namespace haustra::coverage
