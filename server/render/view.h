// What a picture shows: cameras, slices, transfer functions. No GL here.
#pragma once

#include "core/grid.h"
#include "core/result.h"
#include "core/strip_layout.h"

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// Rows from the top, 3 bytes a pixel.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// A perspective camera in patient space (LPS mm). The field of view is vertical. `forward` and
/// `up` need not be unit or orthogonal, only finite and not parallel.
struct Camera {
    glm::dvec3 positionMm{0.0};
    glm::dvec3 forward{0.0, 0.0, 1.0};
    glm::dvec3 up{0.0, -1.0, 0.0};
    double fovDegrees = 90.0;
};

struct WindowLevel {
    double centerHu = 0.0;
    double widthHu = 2000.0;  ///< wide enough for colon reading: −1000…1000
};

/// One control point; between points colour and opacity are linear in HU. Opacity is for a
/// step of 1 mm. Colours 0…1, not multiplied by opacity.
struct TransferFunctionPoint {
    double hu = 0.0;
    glm::dvec3 color{1.0};
    double opacity = 0.0;
};

/// 1-D, post-classification. Points sorted by HU, at least two. Below the first and above the last
/// point these two go on. Two points at one HU make a step.
struct TransferFunction {
    std::vector<TransferFunctionPoint> points;
};

/// Built-in transfer functions: "mucosa" (opaque wall), "translucent".
const std::vector<std::string>& transferFunctionPresets();
Result<TransferFunction> transferFunctionPreset(const std::string& name);
/// Sorts nothing and mends nothing: says what is wrong (2…256 points, HU −32768…32767 and not
/// falling, colours and opacities 0…1).
Result<void> checkTransferFunction(const TransferFunction& transferFunction);

enum class View { endoscopic, axial, coronal, sagittal };
Result<View> viewFromString(const std::string& text);
const char* toString(View view);

/// How rays are sampled. The defaults are what readers see; the rest serves measurements.
struct MarchOptions {
    double stepVoxels = 0.5;        ///< sampling distance, in the smallest voxel spacing; 0.05…4
    bool emptySpaceLeaping = true;  ///< changes the time, never a pixel
    bool shading = true;            ///< else the transfer function's colours, unlit
};

/// The lamp at the camera, in Blinn-Phong terms of linear light: at depth d mm a surface whose
/// normal makes the angle a with the ray sends back
/// (color·(ambient + diffuse·|cos a|) + specular·max(cos 2a, 0)^shininess) / (1 + (d /
/// halfDepthMm)²).
struct Headlight {
    double halfDepthMm, ambient, diffuse, specular, shininess;
};
/// Mild fall-off, so that the far lumen stays readable; little gloss, as of a moist wall.
inline constexpr Headlight headlight{65.0, 0.05, 0.95, 0.08, 20.0};

/// A ray ends where its opacity has reached this, and then counts as opaque.
inline constexpr double terminationOpacity = 0.95;

struct EndoscopicView {
    Camera camera;
    TransferFunction transferFunction;
    MarchOptions march;
};

/// Says what is wrong with a camera: field of view 1…170°, directions finite and not parallel.
Result<void> checkCamera(const Camera& camera);

/// Which of a case's two scans a slice shows.
enum class Scan { original, cleansed };

/// A slice through `positionMm`, radiological convention: axial seen from the feet (patient's
/// left on the picture's right), coronal from the front, sagittal from the patient's left.
/// At zoom 1 the whole slice fits the picture, centred, with square millimetres; zooming holds
/// `positionMm` where it is in the picture.
struct SliceView {
    View plane = View::axial;
    glm::dvec3 positionMm{0.0};
    double zoom = 1.0;  ///< 1…64
    WindowLevel window;
    Scan scan = Scan::original;
};

/// Where a slice's pixels lie: the centre of pixel (x, y) is topLeftMm + x·rightMm + y·downMm.
struct SlicePlacement {
    glm::dvec3 topLeftMm{0.0};
    glm::dvec3 rightMm{1.0, 0.0, 0.0};
    glm::dvec3 downMm{0.0, 1.0, 0.0};
};

/// Fails unless the plane is a slice, zoom and window are in range, and width and height positive.
/// Slices are planes of patient space also where the grid is oblique.
Result<SlicePlacement> placeSlice(const SliceView& view, const Grid& grid, int width, int height);

/// A window onto the flattened wall (dissertation §4.3.2): each pixel's place on the surface and its
/// camera come from the flat map, and a ray along the camera's line of sight meets the cleansed scan
/// there. It starts close before the wall, so that no fold in between hides the place. Beyond the
/// seam the picture repeats; beyond the strip's ends it is black.
struct FlatView {
    FlatWindow window;
    TransferFunction transferFunction;
    MarchOptions march;
};

/// The whole strip, laid out in columns (layOutStrip).
struct FlatOverview {
    TransferFunction transferFunction;
    MarchOptions march;
};

/// Grey 0…255 of a value, before rounding: the window's lower end is black, its upper end white.
double windowed(double hu, const WindowLevel& window);

}  // namespace haustra::render
