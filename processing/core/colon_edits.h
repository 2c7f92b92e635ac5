// What a person said of a scan's colon, against what the program would find.
#pragma once

#include "core/result.h"

#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// A ball in which there is no lumen.
struct CutBall {
    glm::dvec3 centerMm{0.0};  ///< patient, LPS
    double radiusMm = 3.0;
    bool operator==(const CutBall&) const = default;
};

/// Whether a ball to cut with may be as large: 0 < r ≤ 100 mm.
inline bool isCutRadius(double mm) {
    return mm > 0.0 && mm <= 100.0;
}

/// Points are the patient's (LPS, mm).
struct ColonEdits {
    /// The tube pieces at these points, from neck to neck, are colon, or are not.
    std::vector<glm::dvec3> seedsMm, excludesMm;
    std::vector<CutBall> cuts;  ///< here is a wall
    /// The colon goes on straight from the first point's piece to the second's.
    std::vector<std::pair<glm::dvec3, glm::dvec3>> joins;
    bool empty() const {
        return seedsMm.empty() && excludesMm.empty() && cuts.empty() && joins.empty();
    }
    bool operator==(const ColonEdits&) const = default;
};

/// The `edits` product: {"seeds_mm":[[x,y,z]…],"excludes_mm":[…],"cuts":[{"center_mm":…,
/// "radius_mm":r}…],"joins_mm":[[[x,y,z],[x,y,z]]…]}. Reads back as the same edits, bit for bit.
std::string editsJson(const ColonEdits& edits);
/// Fails (badInput) where the text is none of these, a point is none of a patient (isPatientPoint)
/// or a ball too large to cut with.
Result<ColonEdits> editsFromJson(const std::string& text);

}  // namespace haustra
