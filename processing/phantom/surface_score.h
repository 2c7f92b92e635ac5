// How near a mesh comes to the true surface of a phantom's lumen.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"
#include "phantom/true_surface.h"

#include <algorithm>

namespace haustra::phantom {

/// Distances from places of one surface to the other, weighted by the area that each stands for.
struct SurfaceDistances {
    double meanMm = 0.0, p95Mm = 0.0;
    double maxMm = 0.0;
    glm::dvec3 farthestMm{0.0};   ///< the place of the largest distance
    double areaMm2 = 0.0;         ///< that was judged
    double leftOutAreaMm2 = 0.0;  ///< where the truth tells of no surface
};

struct SurfaceScore {
    SurfaceDistances fromMesh;   ///< from the mesh to the truth
    SurfaceDistances fromTruth;  ///< from the truth to the mesh
    double biasMm = 0.0;  ///< mean signed distance of the mesh: positive where it lies outside
    /// Of both ways: the mean of the means, the larger 95 % point and maximum.
    double meanMm() const { return 0.5 * (fromMesh.meanMm + fromTruth.meanMm); }
    double p95Mm() const { return std::max(fromMesh.p95Mm, fromTruth.p95Mm); }
    double hausdorffMm() const { return std::max(fromMesh.maxMm, fromTruth.maxMm); }
};

struct SurfaceScoreOptions {
    int samples = 100'000;  ///< of the mesh, spread evenly over its area
    int threads = 0;
};

/// Fails where the mesh has no area or the truth no samples. The vertices of the mesh count toward
/// its maximum, too, so that a spike between the samples is seen. The same for any number of
/// threads. O(samples) distances to the truth, O(truth samples) to the mesh.
Result<SurfaceScore> scoreSurface(const TriMesh& mesh, const TrueSurface& truth,
                                  const SurfaceScoreOptions& options = {});

}  // namespace haustra::phantom
