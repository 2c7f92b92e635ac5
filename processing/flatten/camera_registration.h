// Which place of the centerline each vertex is seen from (dissertation §4.3.1).
#pragma once

#include "core/centerline.h"
#include "core/flat_map.h"
#include "core/result.h"

namespace haustra::flatten {

struct CameraRegistrationOptions {
    double cameraSpacingMm = 1.0;
    int segments = 0;  ///< N; 0: one for each 20 mm of the centerline
    int threads = 0;
};

/// Fills `map.cameras` with equally spaced samples of the centerline's B-spline, and `map.camera`
/// with each vertex's nearest sample among those of its own segment and the two beside it. Segments
/// are equal in flat height; each boundary's contour has its centroid on the surface, and the
/// sample nearest to it (never before that of the boundary below) divides the centerline. Fails
/// (badInput) on fewer than two centerline points. O(vertices · samples a segment).
Result<void> registerCameras(FlatMap& map, const Centerline& centerline,
                             const CameraRegistrationOptions& options = {});

}  // namespace haustra::flatten
