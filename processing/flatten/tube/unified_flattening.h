// Between keeping angles and keeping areas (dissertation §7.2.3).
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "flatten/periodic_map.h"

namespace haustra::flatten {

struct UnifiedOptions {
    double areaWeight =
        0.0;  ///< 0: the conformal map as it is; 1: as nearly area-preserving as can be
    int maxIterations = 100;
    /// Ends where a step is to lower the energy by less than this, relative to what is left.
    double tolerance = 1e-3;
    int threads = 0;
    Progress progress;
};

/// Starts from the conformal map of `tube` and lowers the mean over the surface of a distortion
/// that weighs angles against areas by `areaWeight` (strip_energy.h); the ends stay straight lines,
/// along which their vertices may slide, the strip its circumference of 1, and no triangle flips.
/// The height may change. Newton steps on the energy made convex triangle by triangle, no longer
/// than nine tenths of the way to the first flip; one sparse factorisation each; the weight rises
/// to what is asked for in stages. Fails (badInput) where the weight is not in [0, 1] or the start
/// is not a map of `tube` or has flips, (noResult) where rounding leaves a step without a solution.
/// Byte-identical for any number of threads. 10…80 steps; 1.3 KiB a triangle.
Result<PeriodicMap> unifiedFlattening(const TriMesh& tube, const PeriodicMap& conformal,
                                      const UnifiedOptions& options);

}  // namespace haustra::flatten
