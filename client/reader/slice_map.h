// Where a slice's pixels lie in the patient: what crosshairs and clicks on slices need.
#pragma once

#include "core/grid.h"
#include "core/view.h"

namespace haustra::reader {

/// Maps between patient points (mm) and the pixels of one slice picture, continuous, with the
/// centre of the top left pixel at (0, 0). The rule is the protocol's (PROTOCOL.md, slices): axial
/// is seen from the feet, coronal from the front, sagittal from the patient's left; at zoom 1 the
/// whole scan fits the picture with square millimetres; zooming holds the slice's position where
/// it is.
class SliceMap {
public:
    /// Width and height are positive.
    SliceMap(const SliceView& slice, const Grid& grid, int width, int height);

    glm::dvec3 patientFromPixel(glm::dvec2 pixel) const;
    /// Of the point's projection onto the slice.
    glm::dvec2 pixelFromPatient(glm::dvec3 patientMm) const;
    double pixelMm() const { return pixelMm_; }
    glm::dvec3 normal() const { return glm::cross(right_, down_); }

private:
    glm::dvec3 right_, down_, topLeftMm_;
    double pixelMm_ = 1.0;
};

/// What the four edges of a slice picture are called: left, right, top, bottom.
struct EdgeLetters {
    const char *left, *right, *top, *bottom;
};
EdgeLetters edgeLetters(View view);

/// Unit normal of a slice: the direction in which scrolling goes (towards the head, the front's
/// opposite, the patient's left).
glm::dvec3 sliceNormal(View view);

}  // namespace haustra::reader
