// What may be in the bowel: gas, tagged fluid and stool, and the levels between them.
#pragma once

#include "core/ct_scan.h"
#include "core/tissue.h"
#include "segmentation/air_fluid_levels.h"
#include "segmentation/field_of_view.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haustra::segmentation {

/// One byte a voxel.
enum class Content : std::uint8_t {
    tissue = 0,
    gas,        ///< in the body, and no lung
    tagged,     ///< tagged fluid or stool, contrast, or bone
    interface,  ///< at an air–fluid level: partial volume, and the last voxels of gas and fluid
    outside,    ///< the room's air
    lung,
    untagged,  ///< fluid that took no tagging, under a level (untagged_pools.h)
    beyond,    ///< padding around a round field of view (field_of_view.h)
};

/// Air of the room that tissue encloses in every slice that it lies in, and that the rest of it
/// reaches from others, 100 ml and more: of bowel that a stoma opens, or of a hollow table.
struct EnclosedRoomAir {
    /// Where the rest of the room's air begins; a loop stoma has two.
    struct Mouth {
        glm::dvec3 placeMm{0.0};  ///< its middle
        double areaMm2 = 0.0;
    };
    glm::dvec3 placeMm{0.0};  ///< its middle
    double ml = 0.0;
    std::vector<Mouth> mouths;  ///< one or more
};

struct BowelContents {
    Volume<std::uint8_t> content;  ///< Content
    std::vector<EnclosedRoomAir> enclosedRoomAir;
    std::vector<Level> levels;
    GravityAxis down;
    glm::dvec3 gravity{0.0};  ///< unit, LPS: as the levels show it
    double gasHu = -1000.0, gasSdHu = 0.0;
    std::vector<std::string> warnings;  ///< where a reader must know of it
    std::vector<std::string> notes;
};

/// Sorts the voxels of a scan of this field, taken in this position, by HU and place; a wall that a
/// person set up may stand in it. The room's air is what can
/// be reached from the scan's sides through places where a cube of 4 mm fits, and 6 mm more: so a
/// tube in the rectum, open to the room, does not make the colon a part of it. Of a side it is what
/// lies in a corner of the slices, or from the first to the last; of a round field's border, which
/// has no corners, what reaches the first slice or the last. Other air there is gas that a narrow
/// field cuts. Lung is air of a mean HU more than 60 above gas in cubes of 4 mm, where such cubes
/// lie three deep, in bodies of 50 ml and more that come within 40 mm of the scan's cranial end, or
/// of 500 ml. Levels as of findLevels, for the direction of gravity that shows most of them; a
/// warning says where that is not the told one.
BowelContents findContents(const Volume<std::int16_t>& hu, const FieldOfView& field,
                           PatientPosition position, const TissueModel& tissue, int threads);

}  // namespace haustra::segmentation
