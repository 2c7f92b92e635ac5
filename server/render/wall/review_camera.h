// From where a patch of the wall is seen: one that was missed, or a finding.
#pragma once

#include "core/camera.h"
#include "core/centerline.h"
#include "core/missed_patches.h"
#include "render/wall/wall_sight.h"

#include <optional>

namespace haustra::render {

/// The camera that shows the most of the patch's area in a square picture, by 64 of its triangles
/// at most, of those that stand on the path up to 30 mm before and behind the patch's arc, and of
/// those that stand before its centre: straight, and slanting by 25° and 50° to eight sides, as far
/// from it as shows all of it, but in the nearer six tenths of the way to the wall across. They
/// look at the centre, the colon's direction towards the cecum up. What is shown is as WallCoverage
/// counts it, whatever the picture's size. Of equally good ones one on the path is taken. `patch`
/// is of this wall. A millisecond or two.
Camera reviewCamera(const WallSight& sight, const MissedPatch& patch, const Centerline& centerline);

/// Of a patch that is to be looked at from the path, at its arc: reviewCamera, where a look at its
/// centre from there shows less than half of what that shows, as a fold or a tube stands between,
/// or the place lies on a fold's far side. None where it is seen from there, or from nowhere, or
/// there is no path.
std::optional<Camera> viewBesidePath(const WallSight& sight, const MissedPatch& patch,
                                     const Centerline& centerline);

}  // namespace haustra::render
