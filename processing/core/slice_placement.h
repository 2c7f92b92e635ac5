// Where the pixels of a slice lie in the patient: what is drawn there, and what crosshairs and
// clicks on it mean.
#pragma once

#include "core/grid.h"
#include "core/view.h"

namespace haustra {

/// Where a scan's voxels reach to along the patient's axes, mm (LPS): a grid that is oblique leaves
/// corners of this empty.
struct ScanBounds {
    glm::dvec3 low, high;
    bool contains(glm::dvec3 mm) const {
        return glm::all(glm::lessThanEqual(low, mm)) && glm::all(glm::lessThanEqual(mm, high));
    }
};
/// Of the grid's outer faces, half a voxel outside its voxels' centres.
ScanBounds boundsMm(const Grid& grid);

/// The centre of pixel (x, y) is topLeftMm + x·rightMm + y·downMm. Right and down are perpendicular
/// and of one length.
struct SlicePlacement {
    glm::dvec3 topLeftMm{0.0};
    glm::dvec3 rightMm{1.0, 0.0, 0.0};
    glm::dvec3 downMm{0.0, 1.0, 0.0};

    double pixelMm() const { return glm::length(rightMm); }
    /// Unit: right × down.
    glm::dvec3 normal() const { return glm::normalize(glm::cross(rightMm, downMm)); }
    glm::dvec3 patientFromPixel(glm::dvec2 pixel) const {
        return topLeftMm + pixel.x * rightMm + pixel.y * downMm;
    }
    /// Of the point's projection onto the slice.
    glm::dvec2 pixelFromPatient(glm::dvec3 patientMm) const;
};

/// Where a slab's samples lie about a place of its plane: at n·stepMm, n from −aside to aside.
struct SlabSamples {
    int aside = 0;
    glm::dvec3 stepMm{0.0};
    int count() const { return 2 * aside + 1; }
};
/// The middles of equal layers, which are no thicker than half the smallest distance between
/// voxels: no voxel is passed over, and their mean is the integral by the midpoint rule. Their
/// number is odd, so that the plane itself is among them: a slab's maximum is never below the
/// slice's value, and a slab as thin as one layer is the slice. At most maxSamplesAside on a side:
/// finer scans than 1/20 mm, which CT has not, are sampled more coarsely. `normal` is not zero.
SlabSamples slabSamples(const Slab& slab, glm::dvec3 normal, const Grid& grid);
inline constexpr int maxSamplesAside = 2000;

/// Fails (badInput) unless the plane is a slice, zoom, window, pan and slab are in range, and width
/// and height positive. Slices are planes of patient space also where the grid is oblique.
Result<SlicePlacement> placeSlice(const SliceView& view, const Grid& grid, int width, int height);

/// Fails (badInput) on directions that span no plane, height, window or slab out of range, or a
/// picture without pixels.
Result<SlicePlacement> placeSlice(const ObliqueView& view, int width, int height);

}  // namespace haustra
