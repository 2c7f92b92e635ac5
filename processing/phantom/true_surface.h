// The true surface of a phantom's lumen, and how far a place is from it.
#pragma once

#include "core/volume.h"
#include "phantom/cell_grid.h"
#include "phantom/phantom.h"

#include <functional>
#include <vector>

namespace haustra::phantom {

/// A point of the surface. The area that it stands for is that of the surface over its density
/// among the crossings of a grid's edges (Crofton's formula), so the areas add up to the surface's.
struct SurfaceSample {
    glm::dvec3 positionMm{0.0};
    glm::dvec3 outward{0.0};  ///< unit; zero where the field has no gradient
    double areaMm2 = 0.0;
};

/// The zero set of a field, known near a grid's voxels. The field need not be a distance, nor be
/// continuous everywhere; its sign counts.
class TrueSurface {
public:
    struct Implicit {
        /// Negative in the lumen, positive outside; about a distance (mm) near the surface.
        std::function<double(glm::dvec3 patientMm)> field;
        /// Where the truth says nothing of a surface, as in a collapsed stretch. May be empty.
        std::function<bool(glm::dvec3 patientMm)> leftOut;
    };

    /// Samples the surface wherever a voxel of `inside` and one of its six neighbours differ, to
    /// within a micrometre by bisection of the edge between them. Both functions must be
    /// thread-safe. O(voxels + samples · log).
    TrueSurface(Implicit implicit, const Volume<std::uint8_t>& inside, int threads);

    const std::vector<SurfaceSample>& samples() const { return samples_; }
    bool leftOut(glm::dvec3 p) const { return implicit_.leftOut && implicit_.leftOut(p); }
    double areaMm2() const;

    /// Unsigned distance from p (mm): to the nearest sample, then over the surface toward the foot
    /// of p, then to whatever lies on p's other side nearer than that. Right to about 0.01 mm, at
    /// creases to 0.06 mm. Infinity where there are no samples. Thread-safe; about a hundred
    /// evaluations of the field.
    double distanceMm(glm::dvec3 p) const;
    /// The distance to the nearest sample: never less than distanceMm, and cheap.
    double atMostMm(glm::dvec3 p) const;
    /// distanceMm, negative in the lumen.
    double signedDistanceMm(glm::dvec3 p) const;

private:
    CellGrid::Nearest nearestSample(glm::dvec3 p) const;
    glm::dvec3 gradient(glm::dvec3 p, double atP) const;
    SurfaceSample crossing(glm::dvec3 in, glm::dvec3 out, const Grid& grid) const;
    glm::dvec3 slide(glm::dvec3 p, glm::dvec3 start) const;
    bool probe(glm::dvec3 p, bool inLumen, glm::dvec3 direction, glm::dvec3& foot) const;

    Implicit implicit_;
    std::vector<SurfaceSample> samples_;
    CellGrid near_;  ///< of the samples
};

/// The lumen's surface of the phantom with these options, folds, polyps and untagged stool outside
/// it, what is tagged inside. Its pieces smaller than a millilitre, cut off behind folds, are left
/// out, and so is the stretch where a colon is collapsed. `truthLabels` are that phantom's. Seconds
/// at full size.
TrueSurface trueLumenSurface(const PhantomOptions& options,
                             const Volume<std::uint8_t>& truthLabels);

}  // namespace haustra::phantom
