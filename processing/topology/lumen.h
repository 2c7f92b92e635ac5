// Finding the colon's lumen in a CT scan.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"
#include "core/tissue.h"

#include <optional>
#include <string>
#include <vector>

namespace haustra::topology {

struct LumenOptions {
    std::vector<glm::dvec3> seedsMm;     ///< the air or fluid at these points is colon
    std::vector<glm::dvec3> excludesMm;  ///< the air or fluid at these points is not
    int threads = 0;
    Progress progress;
};

/// One connected piece of the lumen.
struct LumenSegment {
    double airMl = 0.0;
    double taggedMl = 0.0;
    glm::dvec3 centroidMm{0.0};
};

struct Lumen {
    Volume<std::uint8_t> labels;         ///< LumenLabel
    std::vector<LumenSegment> segments;  ///< largest first
    glm::dvec3 gravity{0.0};             ///< unit, LPS: as the air–fluid levels show it
    std::vector<std::string> notes;  ///< for the log: disagreement with the patient position …
};

/// The colon's air and, through flat air–fluid interfaces, the tagged fluid beneath. Air that
/// reaches the body's outside, lungs, stomach and small-bowel gas are left out.
Result<Lumen> findLumen(const CtScan& scan, const TissueModel& tissue,
                        const LumenOptions& options = {});

}  // namespace haustra::topology
