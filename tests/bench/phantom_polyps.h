// A phantom's polyps as solids, and where they end on a surface.
#pragma once

#include "core/findings.h"
#include "core/result.h"

#include <functional>
#include <string>
#include <vector>

namespace haustra::bench {

struct PhantomPolyp {
    Finding finding;  ///< as in polyps.json
    /// Whose sign tells what of the lumen's surface is the polyp's, from the solids that the
    /// phantom is made of: nearer to the polyp than to the colon as it is without it, so that a
    /// surface that is off along its normal, or rounds the crease between them, has its border
    /// there too. About a distance (mm) near it, positive away from it.
    std::function<double(glm::dvec3 patientMm)> border;
    /// The same of the half that looks away from the wall: for a polyp on a stalk it ends at the
    /// head's girth, which is what its size is measured at (the stalk does not count) and what is
    /// seen of it from above. At its border with the wall is the stalk's foot.
    std::function<double(glm::dvec3 patientMm)> girth;
};

/// Of the phantom that a phantom.json tells of, in the order of its polyps.json. Seconds at full
/// size. Errors: no such file, or not one of this version.
Result<std::vector<PhantomPolyp>> polypsOfPhantom(const std::string& file);

}  // namespace haustra::bench
