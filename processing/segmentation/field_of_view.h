// What of a scan's slices was reconstructed: all of them, or a circle with padding around it.
#pragma once

#include "core/ct_scan.h"

#include <cstdint>
#include <vector>

namespace haustra::segmentation {

/// Of the columns of voxels (i, j) through all slices, i fastest.
struct FieldOfView {
    bool round = false;                ///< a circle about the middle of the slices
    std::vector<std::uint8_t> beyond;  ///< 1: padding
    std::vector<std::uint8_t> rim;     ///< 1: in the field, and at its border
};

/// Scanners pad what lies outside the circle that they reconstruct with one value. So the field is
/// round where the columns that hold the corners' value in every slice are those outside a circle
/// about the slices' middle, to two voxels; one voxel within, which may be a mean of both, is
/// counted with the padding. Else it is all of the slices.
FieldOfView fieldOfView(const Volume<std::int16_t>& hu, int threads);

}  // namespace haustra::segmentation
