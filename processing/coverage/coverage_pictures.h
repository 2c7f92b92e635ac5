// Pictures of what has been covered (dissertation figure 2.6): the wall's surface, green where it
// has been seen.
#pragma once

#include "core/camera.h"
#include "core/image.h"
#include "coverage/missed_review.h"

namespace haustra::coverage {

/// The wall as an eyepiece shows it, lit from the camera: green where it has been observed, the
/// mucosa's own colour where it has not, grey where it encloses a bridge; black where the picture
/// is dark. Vertices' normals are interpolated. What is out of focus is drawn too. O(pixels).
Image paintedView(const WallRays& rays, const CoverageWall& wall,
                  const std::vector<Visibility>& seen, const Eyepiece& eyepiece,
                  const CenterlineCamera& camera, int threads = 0);

/// The colon from outside, from the patient's front, whole, in a picture of `size`, before white;
/// the path through it is drawn in dark blue over it.
Image paintedOutside(const WallRays& rays, const CoverageWall& wall,
                     const std::vector<Visibility>& seen, const Centerline& path, glm::ivec2 size,
                     double azimuthDegrees = 0.0, int threads = 0);

}  // namespace haustra::coverage
