// A picture, and what is drawn into it: a view of the case (core/view.h) with the optics, sampling
// and paint that it is drawn by. No GL here.
#pragma once

#include "core/image.h"
#include "core/result.h"
#include "core/view.h"
#include "render/optics/optics.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// How rays are sampled. The defaults are what readers see; the rest serves measurements.
struct MarchOptions {
    double stepVoxels = 0.5;        ///< sampling distance, in the smallest voxel spacing; 0.05…4
    bool emptySpaceLeaping = true;  ///< changes the time, never a pixel
    bool operator==(const MarchOptions&) const = default;
};

/// What lies before the rays' ends, drawn by somebody else: a ray stops at its pixel's depth, and
/// what it lets through is the backdrop's.
struct Backdrop {
    glm::ivec2 size{0};             ///< the whole picture's
    std::vector<glm::vec4> pixels;  ///< rows from the top; rgb: linear light, w: mm along the ray
};

struct WallPaint;

/// What a camera sees of a volume.
struct CameraView {
    Camera camera;
    Optics optics;
    MarchOptions march;
    std::shared_ptr<const Backdrop> backdrop = nullptr;  ///< none: black, and no end
    /// Colours the wall in the finished picture (wall_paint.h), which is CaseRenderer's work; the
    /// case must have a flat map. None: no colour.
    std::shared_ptr<const WallPaint> paint = nullptr;
    /// Over 0: rays end so far behind the wall, or where they come out of it into gas again
    /// (beneath_wall.h); CaseRenderer's work, in place of a backdrop. Where the case has no flat
    /// map they have no end.
    double beneathWallMm = 0.0;
};

/// Fails (badInput) where camera, optics or sampling are out of their bounds, or the backdrop is of
/// another size.
Result<void> checkCameraView(const CameraView& view, glm::ivec2 pictureSize);

/// Fails (badInput) where the sampling distance is out of range, for these optics too.
Result<void> checkMarch(const MarchOptions& march);
Result<void> checkMarch(const MarchOptions& march, const Optics& optics);

/// The colon from outside: the wall's mesh, lit, and the body around it, ray-cast.
struct OverviewView : Overview {
    Optics optics;  ///< of the body: translucent
    /// The body is a soft shadow: samples a voxel apart show all of it.
    MarchOptions march{.stepVoxels = 1.0};
    std::shared_ptr<const WallPaint> paint = nullptr;  ///< as of a CameraView
};

/// A window onto the flattened wall (dissertation §4.3.2). Each pixel's place on the surface is
/// interpolated from the flat map's triangle that covers it, at whatever enlargement, and a ray
/// meets the cleansed scan there:
///  - It comes from the camera that the place is registered with. Where that line of sight would
///    meet the wall from behind or graze it, it is turned towards the wall's normal (mostRayAngle):
///    every place is seen from the lumen, and what is drawn lies at the place, not beside it.
///  - It starts where the way back from the place, at most `backMm` long, is darkest, and
///    looks back no farther than where the scan rises by `riseHu` again: no fold stands between.
///  - It ends `depthMm` behind the wall.
/// The light falls from the camera's side as well, but from a lamp that hangs ahead of the camera
/// by `lampAhead` times its distance to the wall: from the top of the picture, so that bumps and
/// dents look different. It is turned by less (mostLightAngle): the sides of folds lie in shade. It
/// does not fall off. Beyond the seam the picture repeats; beyond the strip's ends it is black.
struct FlatView {
    FlatWindow window;
    Optics optics;
    MarchOptions march;
    std::shared_ptr<const WallPaint> paint = nullptr;  ///< as of a CameraView
};

/// How the rays of flattened views run. An angle a between a direction and the wall's normal
/// becomes a / (1 + (a / most)⁴)^¼, radians: under `most`, and a itself where it is small.
struct FlatRay {
    double mostRayAngle, mostLightAngle, lampAhead, backMm, riseHu, depthMm;
};
inline constexpr FlatRay flatRay{0.8, 1.25, 0.5, 2.0, 200.0, 10.0};

/// Limits of a flattened view: the strip's length in circumferences, the enlargement, and how often
/// one picture may show the circumference.
inline constexpr int maxPixelsPerUnit = 1 << 18, maxCircumferences = 8;

/// Fails (badInput) where a window that is `width` pixels wide is not within the limits.
Result<void> checkFlatWindow(const FlatWindow& window, int width);

/// The whole strip, laid out in columns (layOutStrip).
struct FlatOverview {
    Optics optics;
    MarchOptions march;
    std::shared_ptr<const WallPaint> paint = nullptr;  ///< as of a CameraView
};

/// Grey 0…255 of a value, before rounding: the window's lower end is black, its upper end white.
double windowed(double hu, const WindowLevel& window);

}  // namespace haustra::render
