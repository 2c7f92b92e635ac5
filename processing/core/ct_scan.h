// The CT scan as the stages see it, and the labels they give its voxels.
#pragma once

#include "core/volume.h"

namespace haustra {

/// A CT scan in Hounsfield units. Padding outside the scanner's field of view holds −1024 or less.
struct CtScan {
    Volume<std::int16_t> hu;
    PatientPosition position = PatientPosition::unknown;
};

/// The `lumen` product's labels, one byte a voxel.
enum class LumenLabel : std::uint8_t {
    outside = 0,
    air = 1,       ///< air-filled lumen
    tagged = 2,    ///< tagged fluid or stool inside the lumen, and its interface with the air
    bridge = 3,    ///< tissue in a collapsed stretch, taken in so that the lumen is one piece
    untagged = 4,  ///< fluid that took no tagging, whose wall shows little contrast; and the wall
                   ///< of what stands in the lumen, as a catheter's balloon
};

}  // namespace haustra
