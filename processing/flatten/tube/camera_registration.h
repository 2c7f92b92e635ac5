// Which place of the centerline each vertex is seen from (dissertation §4.3.1).
#pragma once

#include "core/centerline.h"
#include "core/flat_map.h"
#include "core/result.h"

#include <vector>

namespace haustra::flatten {

struct CameraRegistrationOptions {
    double cameraSpacingMm = 1.0;
    int segments = 0;  ///< N; 0: one for each 20 mm of the centerline
    /// Per triangle of the map: of a blind pouch, which has no part in the contours; or empty.
    std::vector<char> isPouch{};
    int threads = 0;
};

/// Between the cameras of two neighbouring vertices the centerline is no longer than this many
/// times the edge between them, but for one camera's spacing.
inline constexpr double steepestRegistration = 3.0;

/// Fills `map.cameras` with equally spaced samples of the centerline's B-spline, and `map.camera`
/// with each vertex's nearest sample among those of its own segment and the two beside it. Segments
/// are equal in flat height; each boundary's contour has its centroid on the surface, and the
/// centerline is divided at those samples, in order, that are nearest to the centroids in the sum
/// of squares.
///
/// A camera between those of a triangle's corners must be one that could see it. Where neighbours'
/// nearest samples jump, as they do inside a bend, the registration is therefore levelled until it
/// is no steeper than steepestRegistration: it becomes the mean of the least and the greatest
/// registration of that steepness through all the others, which leaves it as it is where it is not
/// too steep already. Both sides of the seam have the same cameras.
///
/// Fails (badInput) on fewer than two centerline points, or where they have no length, and on an
/// empty map. O(vertices · samples a segment).
Result<void> registerCameras(FlatMap& map, const Centerline& centerline,
                             const CameraRegistrationOptions& options = {});

}  // namespace haustra::flatten
