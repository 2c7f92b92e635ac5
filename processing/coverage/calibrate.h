// Calibration of an endoscope from pictures of a flat board (dissertation §2.2; Kannala and Brandt,
// IEEE PAMI 2006;28:1335).
#pragma once

#include "core/result.h"
#include "coverage/board.h"
#include "coverage/fisheye_lens.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::coverage {

/// What of a FisheyeLens is sought.
struct LensModel {
    const char* name;     ///< for the command line and files
    const char* formula;  ///< of r
    Projection projection;
    int coefficients;  ///< of k, from the first; all others are 0
    bool decentring;   ///< p₁ and p₂ too
    bool firstIsOne;   ///< k₁ = 1: the focal lengths in pixels are m_u and m_v, as in OpenCV

    /// The widest nominal field of view, degrees; the narrowest is leastFieldDegrees.
    double mostFieldDegrees() const {
        return projection == Projection::perspective ? 179.0 : 360.0;
    }
    static constexpr double leastFieldDegrees = 1.0;
};
/// kannala-brandt (k₁ and k₂, the source's), kannala-brandt-4, stereographic, equidistance,
/// equisolid, orthogonal, opencv-fisheye, brown, brown-radial (without decentring).
const std::vector<LensModel>& lensModels();
/// None of another name.
const LensModel* findLensModel(std::string_view name);

struct CalibrationOptions {
    const LensModel* model = nullptr;
    glm::ivec2 pictureSize{0};
    /// The pictures' open part; else the nominal field is taken to reach the picture's corners.
    std::optional<FieldEllipse> field;
    /// Nominal whole field of view; where it is not known, several are tried.
    std::optional<double> fieldDegrees;
    /// Pictures show only the products m·k. m_u is held where it is known; else k₁ is held at the
    /// nominal focal length, or at 1, so that k is in focal lengths.
    std::optional<double> pixelsPerMm, focalMm;
    /// What the lens is nominally built to: k₁… begin as the best fit to f·s(θ) of it.
    Projection nominal = Projection::equidistance;
    /// Begin here, instead of at nominal values and the field's ellipse.
    std::optional<FisheyeLens> start;
};

/// A number of a lens: 0…4 are k, then m_u, m_v, u₀, v₀, p₁, p₂.
inline constexpr std::size_t lensNumbers = 11;
std::array<double, lensNumbers> numbersOf(const FisheyeLens& lens);
/// "k1" … "k5", "m_u", "m_v", "u0", "v0", "p1", "p2".
const std::array<const char*, lensNumbers>& lensNumberNames();

/// One picture's part of a calibration.
struct ViewFit {
    glm::dmat3 cameraFromBoard{1.0};    ///< rotation
    glm::dvec3 originMm{0.0};           ///< of the board, in the camera's frame
    std::vector<glm::dvec2> residuals;  ///< found less shown, pixels, in the view's order
    double rmsPixels = 0.0, largestPixels = 0.0;
};

struct Calibration {
    FisheyeLens lens;
    /// Of each number one standard error; 0 for what is held.
    std::array<double, lensNumbers> standardErrors{};
    std::size_t held = 0;  ///< which number fixes the scale between k and m: 0 (k₁) or 5 (m_u)
    double focalPixels = 0.0, focalError = 0.0;  ///< k₁·m_u, which no scale changes
    double rmsPixels = 0.0;  ///< root of the mean squared distance, as OpenCV has it
    /// The same after steps 1 to 3, before all projection errors are minimised together.
    double startRmsPixels = 0.0;
    double largestAngle = 0.0;  ///< of any point from the axis, radians
    /// Of dots: how far their pictures' centres lie off their centres' pictures, at most, pixels,
    /// and their radius; both 0 of checkerboards.
    double largestBiasPixels = 0.0, dotRadiusMm = 0.0;
    std::vector<ViewFit> views;
};

/// The source's four steps:
///  1. Internals from nominal values: k as the least-squares fit to the nominal projection over the
///     field, m, u₀ and v₀ so that the field's edge is the ellipse.
///  2. The board and each picture's rays (its pixels through the internals) are related by a
///     homography, by the direct linear transform; homographies and internals are refined together
///     on the projection error, each homography held near a rotation's two columns (Zhang's two
///     conditions), without which it would hide a focal length. Of several nominal fields the one
///     that fits best goes on.
///  3. Externals from the homographies, at fixed internals, and refined so.
///  4. All of it by Levenberg–Marquardt on the projection error (Ceres).
/// Dots' centres are then corrected by how far the picture of a disc of their size (from the areas)
/// has its centre off the centre's picture, and step 4 is done again, until they agree.
/// Standard errors are σ²(JᵀJ)⁻¹ with σ² from the residuals. Fails (badInput) where a view has less
/// than 6 points or its lists differ in length, (noResult) where nothing fits or the pictures do
/// not determine the lens. Linear in the points and cubic in the pictures: a second for 20. The
/// same numbers for any machine load; one thread.
Result<Calibration> calibrate(const std::vector<BoardView>& views,
                              const CalibrationOptions& options);

}  // namespace haustra::coverage
