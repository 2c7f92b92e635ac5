// Between keeping angles and keeping areas (dissertation §7.2.3).
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "flatten/periodic_map.h"

namespace haustra::flatten {

struct UnifiedOptions {
    double areaWeight =
        0.0;  ///< 0: the conformal map as it is; 1: as nearly area-preserving as can be
    int maxIterations = 200;
    int threads = 0;
    Progress progress;
};

/// Starts from the conformal map of `tube` and lowers the mean over the surface of a distortion
/// that weighs angles against areas by `areaWeight`; the ends stay straight lines, the strip its
/// circumference of 1, and no triangle flips. The height may change. Fails (badInput) where the
/// start has flips.
Result<PeriodicMap> unifiedFlattening(const TriMesh& tube, const PeriodicMap& conformal,
                                      const UnifiedOptions& options);

}  // namespace haustra::flatten
