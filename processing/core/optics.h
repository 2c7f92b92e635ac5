// The optical model of every raycaster: what a sample of the volume sends to the eye and keeps from
// it (dissertation §5.1). The client, which
// edits it, and the server, which draws by it, share these types.
#pragma once

#include "core/result.h"

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// One control point; between points colour and opacity are linear in HU. Opacity is for a way of
/// 1 mm. Colours 0…1 as displayed (sRGB), not multiplied by opacity.
struct TransferFunctionPoint {
    double hu = 0.0;
    glm::dvec3 color{1.0};
    double opacity = 0.0;
    bool operator==(const TransferFunctionPoint&) const = default;
};

/// What a 2-D transfer function shows where the volume is this steep.
struct GradientRow {
    double gradientHuPerMm = 0.0;
    std::vector<TransferFunctionPoint> points;
    bool operator==(const GradientRow&) const = default;
};

/// Points sorted by HU, at least two. Below the first and above the last point these two go on. Two
/// points at one HU make a step.
struct TransferFunction {
    /// 1-D; of a 2-D one, the row at gradient magnitude 0.
    std::vector<TransferFunctionPoint> points;
    /// Empty of a 1-D one. Else density × gradient magnitude (in the patient, HU/mm, by central
    /// differences over one voxel to either side): further rows, at growing magnitudes over 0;
    /// between rows colour and opacity are linear in the magnitude, and the last row goes on.
    /// Compositions other than emissionAbsorption take no notice of them.
    std::vector<GradientRow> rows = {};
    bool operator==(const TransferFunction&) const = default;
};

/// Of points as a TransferFunction has them: what holds at `hu`. Where two make a step it is the
/// second, and beyond the outermost two these themselves are returned.
TransferFunctionPoint pointAt(const std::vector<TransferFunctionPoint>& points, double hu);

/// How a ray's samples make its pixel. Samples lie at whole steps n ≥ 0 from the eye (orthographic:
/// from the camera's plane) between the volume's outer faces, half a voxel outside the outermost
/// voxels' centres; values are interpolated trilinearly, and clamped at the outermost centres. A
/// backdrop takes away those at n · stepMm over its depth.
enum class Composition {
    /// Front to back, equation 5.1; opaque walls and translucent tissue alike. A ray ends where its
    /// opacity has reached terminationOpacity, and then counts as opaque: its colour is divided by
    /// its opacity.
    emissionAbsorption,
    /// The colour of the greatest value among the samples, times its 1-mm opacity; unlit.
    maximumIntensity,
    /// The place where the 1-mm opacity first reaches firstHitOpacity: between the first sample n
    /// that does and sample n − 1 by firstHitBisections halvings, each keeping the half whose far
    /// end does; at n where it is the ray's first. Opaque; lit by the gradient there.
    firstHit,
};

/// The lamp at the camera, in Blinn-Phong terms of linear light: at depth d mm a surface whose
/// normal makes the angle a with the ray sends back
/// (color·(ambient + diffuse·|cos a|) + specular·max(cos 2a, 0)^shininess) / (1 + (d /
/// halfDepthMm)²).
struct Headlight {
    double halfDepthMm, ambient, diffuse, specular, shininess;
    bool operator==(const Headlight&) const = default;
};
/// Mild fall-off, so that the far lumen stays readable; little gloss, as of a moist wall.
inline constexpr Headlight headlight{65.0, 0.05, 0.95, 0.08, 20.0};

/// Bounds of what checkOptics passes.
inline constexpr std::size_t mostTransferPoints = 256;  ///< of a row
inline constexpr std::size_t mostGradientRows = 64;
/// Of all rows together: one message of the protocol holds them.
inline constexpr std::size_t mostTransferPointsInAll = 1024;
inline constexpr double lowestTransferHu = -32768.0, highestTransferHu = 32767.0;

inline constexpr double terminationOpacity = 0.95;
inline constexpr double firstHitOpacity = 0.5;
inline constexpr int firstHitBisections = 8;

/// Longest sampling distance of pre-integrated optics, voxels.
inline constexpr double longestPreIntegratedStep = 1.0;

struct Optics {
    TransferFunction transferFunction;
    Composition composition = Composition::emissionAbsorption;
    /// emissionAbsorption's transfer function is integrated over the values between two samples
    /// instead of looked up at each [Engel et al. 2001]: sample n stands for the segment from n − 1
    /// to n, along which the value runs linearly; a ray's first sample, for a segment of its own
    /// value (transfer_table.h). Lit by the gradient and at the depth of the segment's middle,
    /// n − ½. Not of a 2-D transfer function; the other compositions take no notice of it.
    bool preIntegrated = false;
    bool shading = true;  ///< else the transfer function's colours, unlit
    Headlight light = headlight;
    bool operator==(const Optics&) const = default;
};

/// Sort nothing and mend nothing: say what is wrong (2…256 points, HU −32768…32767 and not
/// falling, colours and opacities 0…1; at most 64 rows at growing magnitudes up to 65536, of
/// 1024 points together; a lamp that shines: half depth over 0, shares 0…10, shininess 1…1000).
/// Fail (badInput).
Result<void> checkTransferFunction(const TransferFunction& transferFunction);
Result<void> checkOptics(const Optics& optics);

}  // namespace haustra
