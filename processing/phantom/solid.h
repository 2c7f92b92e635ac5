// Solids of one tissue, painted into a volume one over the other.
#pragma once

#include "phantom/colon_field.h"

#include <functional>
#include <span>
#include <vector>

namespace haustra::phantom {

/// A solid within a box. What it is made of may depend on the place and the depth under its
/// surface (HU of a shell of cortical bone, a gas–fluid level …).
struct Solid {
    glm::dvec3 lowMm{0.0}, highMm{0.0};            ///< bounds; the solid may be cut off at them
    std::function<double(glm::dvec3 p)> distance;  ///< signed, mm, first order
    std::function<double(glm::dvec3 p, double distance)> hu;
    double clearOfColonMm = -1e9;  ///< keeps this far from the colon's lumen
    std::uint8_t site =
        0;  ///< Site of its voxels that are at least `siteBelowMm` under its surface
    double siteBelowMm = 0.0;
};

/// One tissue with a little texture.
std::function<double(glm::dvec3, double)> tissue(double hu, double textureHu, std::uint64_t seed,
                                                 double featureMm = 9.0);
/// Cortical bone over spongy bone.
std::function<double(glm::dvec3, double)> bone(double cortexMm, double cortexHu, double spongyHu,
                                               std::uint64_t seed);

/// Paints slice k (grid.size.x × grid.size.y values) with each solid in order, partial volume at
/// the surfaces, and says in `sites` what the voxels' centres lie in; `colon` has the slice as its
/// slice `colonK`. Thread-safe for different slices.
void paintSlice(const std::vector<Solid>& solids, const Grid& grid, const ColonField& colon,
                int colonK, int k, float* slice, std::uint8_t* sites);

}  // namespace haustra::phantom
