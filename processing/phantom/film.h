// Tagged residue that clings to the wall in a thin film: over a polyp, or over the bare mucosa.
#pragma once

#include "phantom/colon_shape.h"
#include "phantom/growth_options.h"

#include <cstdint>
#include <vector>

namespace haustra::phantom {

/// Whatever the wall's form within its radius, be it a neighbouring loop's, the film lies on it,
/// thins out with the distance from its centre and is uneven; under fluid it is none. Flat polyps
/// carry one oftener than not, 1.5 mm thick in the mean, SD 0.6 (Kim et al., Eur Radiol
/// 2014; 24: 940).
struct Film {
    glm::dvec3 center{0.0};
    double radiusMm = 8.0;
    double thicknessMm = 1.5;  ///< at its centre, in the mean
    double hu = 500.0;
    std::uint64_t seed = 0;  ///< of its unevenness
    int growth = -1;         ///< which of the shape's it coats; −1: none

    /// Its thickness on the wall near p, mm; 0 beyond its edge.
    double thicknessAt(glm::dvec3 p) const;
    /// It ends nearer to its centre.
    double reachMm() const { return 1.3 * radiusMm; }
    /// How much of what a voxel holds of the lumen is film: the voxel's centre is at p, at signed
    /// distance `lumenMm` of the lumen's boundary, and it is `widthMm` wide. 0…1.
    double share(glm::dvec3 p, double lumenMm, double widthMm) const;
};

/// The films that the options ask for: over growths that are not stool, of which GrowthOptions
/// tells the share, and on the bare wall. Deterministic in the seed.
std::vector<Film> makeFilms(const ColonShape& shape, std::uint64_t seed,
                            const GrowthOptions& options);

}  // namespace haustra::phantom
