// Where the pixels of a slice lie in the patient: what is drawn there, and what crosshairs and
// clicks on it mean.
#pragma once

#include "core/grid.h"
#include "core/view.h"

namespace haustra {

/// The centre of pixel (x, y) is topLeftMm + x·rightMm + y·downMm. Right and down are perpendicular
/// and of one length.
struct SlicePlacement {
    glm::dvec3 topLeftMm{0.0};
    glm::dvec3 rightMm{1.0, 0.0, 0.0};
    glm::dvec3 downMm{0.0, 1.0, 0.0};

    double pixelMm() const { return glm::length(rightMm); }
    glm::dvec3 patientFromPixel(glm::dvec2 pixel) const {
        return topLeftMm + pixel.x * rightMm + pixel.y * downMm;
    }
    /// Of the point's projection onto the slice.
    glm::dvec2 pixelFromPatient(glm::dvec3 patientMm) const;
};

/// Fails (badInput) unless the plane is a slice, zoom and window are in range, and width and height
/// positive. Slices are planes of patient space also where the grid is oblique.
Result<SlicePlacement> placeSlice(const SliceView& view, const Grid& grid, int width, int height);

/// Fails (badInput) on directions that span no plane, height or window out of range, or a picture
/// without pixels.
Result<SlicePlacement> placeSlice(const ObliqueView& view, int width, int height);

}  // namespace haustra
