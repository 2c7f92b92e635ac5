// The way of a colonoscope's lens through the colon (dissertation §2.3).
#pragma once

#include "core/centerline.h"
#include "core/result.h"
#include "core/volume.h"

namespace haustra::coverage {

/// A path that hugs the corners, and how much of it is narrower than the tip.
struct CornerPath {
    Centerline path;        ///< from the rectum; radiusMm: distance to the wall; gap: in a bridge
    double narrowMm = 0.0;  ///< length nearer to the wall than the clearance
};

/// The shortest path from the rectum's end of `centerline` to the cecum's through the voxels that
/// lie at least `clearanceMm` from the wall by `distanceMm` (the product distance: mm to the
/// lumen's boundary, 0 outside), over a graph of 26-connected voxels whose edges are as long as
/// their voxels are apart: Dijkstra's, as §2.3 has it; Wan et al., Medical Physics 2002;29:2907.
///
/// The source's colons are wide enough everywhere. A real one is not: the tip goes through where it
/// is narrower, and through bridges over collapses, and there this path follows the centerline,
/// which has the most room. So the graph has the centerline's samples besides, each joined to the
/// next and to the voxel that it lies in; their edges count farFromVoxels-fold, so that voxels are
/// left only where they do not go on. It starts and ends where the centerline first and last has
/// the clearance: the lens does not touch the cecum's end. Where it nowhere has, the path is the
/// centerline.
///
/// The voxels' steps turn by 45° and more: places are then averaged along the path over
/// ±smoothingMm, which moves none into tissue that is nearer than the clearance (such stay). Fails
/// (noResult) where the centerline has no sample. O(voxels with the clearance · log), seconds, and
/// some 20 bytes for each of them; thread-safe.
Result<CornerPath> cornerPath(const Volume<float>& distanceMm, const Centerline& centerline,
                              double clearanceMm);

inline constexpr double farFromVoxels = 100.0, smoothingMm = 3.0;

/// The same place looking along the path, or back: `count` cameras at equal distances from end to
/// end (one: in the middle). Of a colonoscope each looks along its path's tangent. Antegrade looks
/// towards the cecum, as a colonoscope's lens does on its way in and on its way out; retrograde
/// towards the rectum (core's FlightDirection, after §2.1: "antegrade (from rectum to cecum) and
/// retrograde (from cecum to rectum)"; the caption of figure 2.6 has a "retrograde navigation from
/// rectum to cecum", which is the way that a real colonoscope looks). Needs a sample and count > 0.
std::vector<CenterlineCamera> scopeCameras(const Centerline& path, int count,
                                           FlightDirection direction);
/// Of virtual colonoscopy: the cameras of a reader's flight (core's cameraAtArc).
std::vector<CenterlineCamera> flightCameras(const Centerline& centerline, int count,
                                            FlightDirection direction);

}  // namespace haustra::coverage
