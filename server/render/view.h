// What a picture shows: cameras, slices, transfer functions. No GL here.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "core/result.h"

namespace haustra::render {

/// Rows from the top, 3 bytes a pixel.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// A perspective camera in patient space (LPS mm). The field of view is vertical.
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

/// 1-D, post-classification. Points sorted by HU, at least two.
struct TransferFunction {
    std::vector<TransferFunctionPoint> points;
};

/// Built-in transfer functions: "mucosa" (opaque wall), "translucent".
const std::vector<std::string>& transferFunctionPresets();
Result<TransferFunction> transferFunctionPreset(const std::string& name);
/// Sorts nothing and mends nothing: says what is wrong.
Result<void> checkTransferFunction(const TransferFunction& transferFunction);

enum class View { endoscopic, axial, coronal, sagittal };
Result<View> viewFromString(const std::string& text);
const char* toString(View view);

struct EndoscopicView {
    Camera camera;
    TransferFunction transferFunction;
};

/// A slice through `positionMm`, radiological convention: axial seen from the feet (patient's
/// left on the picture's right), coronal from the front, sagittal from the patient's left.
/// At zoom 1 the whole slice fits the picture with square millimetres.
struct SliceView {
    View plane = View::axial;
    glm::dvec3 positionMm{0.0};
    double zoom = 1.0;
    WindowLevel window;
};

}  // namespace haustra::render
