// Calibrated lenses as files: Haustra's own, and OpenCV's.
#pragma once

#include "core/result.h"
#include "coverage/calibrate.h"
#include "coverage/colonoscope.h"
#include "coverage/lens_field.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace haustra::coverage {

/// JSON that colonoscopeOfText reads back number for number; ends with a new line:
///     {"name": "…", "projection": "equidistance", "k": [k₁…k₅], "m_u": …, "m_v": …, "u0": …,
///      "v0": …, "decentring": [p₁, p₂], "picture_size": [w, h], "open_centre": [u, v],
///      "open_radii": [a, b], "field_degrees": …, "depth_of_field_mm": [from, to],
///      "tip_radius_mm": …, "calibration": {…}}
/// The last is for people (model, standard errors, RMS by picture) and is not read; it is left out
/// without a calibration.
std::string lensText(const Colonoscope& scope, const LensModel* model = nullptr,
                     const Calibration* calibration = nullptr);
/// Fails (badInput), naming `place` and the field, where the text is not that; of "decentring" and
/// "calibration" each may be missing.
Result<Colonoscope> colonoscopeOfText(std::string_view text, const std::string& place);

/// Camera parameters as OpenCV's calibration samples write them (cv::FileStorage: XML, YAML or
/// JSON): camera_matrix, distortion_coefficients, image_width, image_height, and fisheye_model,
/// which tells θ_d = θ(1 + k₁θ² + k₂θ⁴ + k₃θ⁶ + k₄θ⁸) from pinhole with Brown's k₁, k₂, p₁, p₂, k₃.
/// The older samples' Camera_Matrix and so on are read likewise. The open part is an ellipse
/// through the picture's corners, the depth of field and the tip table 2.1's. Fails (badInput)
/// where the text is not that, has a skew or coefficients that no lens here has, or is of four
/// coefficients without fisheye_model, which may be either. Any thread.
Result<Colonoscope> lensOfOpenCvText(const std::string& text, const std::string& place);
/// As `ending` (".xml", ".yml", ".yaml" or ".json") says. Fails (unsupported) of a lens that OpenCV
/// does not have: only equidistance without decentring and perspective to s⁷ are.
Result<std::string> openCvText(const Colonoscope& scope, const std::string& ending);

/// The built-in colonoscope of that name ("olympus-cf-q160l"), else a file of either kind.
/// Fails (notFound) where there is neither, and as the above, naming the file.
Result<Colonoscope> readColonoscope(const std::string& nameOrFile);

}  // namespace haustra::coverage
