// Where the body's walls and bones are, in phantom coordinates: LPS mm, x = 0 on the midline,
// z = 0 at the lowest slice (upper thigh), z = 420 at the highest (lung bases).
#pragma once

#include "core/grid.h"

namespace haustra::phantom {

/// The plan that both the anatomy and the colon's path respect. `position` matters: lying prone
/// flattens the belly, lying supine the back.
struct BodyPlan {
    PatientPosition position = PatientPosition::supine;
    double widthScale = 1.0;  ///< of this patient, about 1
    double fatMm = 14.0;      ///< subcutaneous fat

    /// Signed distance to the skin (first order), negative inside.
    double skin(glm::dvec3 p) const;
    /// Signed distance to the wall of the abdominal and pelvic cavity, negative inside.
    double cavity(glm::dvec3 p) const;
    /// Signed distance to the wing of the nearer hip bone.
    static double iliacWing(glm::dvec3 p);
    /// Signed distance to the spine, sacrum and coccyx as one smooth column (a keep-out zone).
    static double spineColumn(glm::dvec3 p);
    /// y of the middle of the vertebral bodies, or of the sacrum, at a height.
    static double spineY(double z);
    /// Height of the diaphragm's dome; lung above, abdomen below.
    static double diaphragmZ(double x, double y);
};

}  // namespace haustra::phantom
