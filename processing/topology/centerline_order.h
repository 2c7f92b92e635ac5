// Which end of the lumen is the rectum, and in which order the colon passes its segments.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::topology {

/// One segment of the lumen, by the ends of its path in patient mm (LPS).
struct SegmentEnds {
    glm::dvec3 firstMm{0.0}, lastMm{0.0};
};

/// One segment in the order of travel; `reversed` means that it is entered by its last end.
struct SegmentVisit {
    std::size_t segment = 0;
    bool reversed = false;
    friend bool operator==(const SegmentVisit&, const SegmentVisit&) = default;
};

/// Anatomy as a length in mm, lowest at the rectum's end: caudal (−z), posterior (+y), and near the
/// midline, for which the middle of the lumen stands (the colon frames the abdomen).
double rectumPenaltyMm(glm::dvec3 endMm, glm::dvec3 lumenMiddleMm);

/// The order from rectum to cecum that crosses the shortest gaps (Held and Karp's dynamic
/// programme, exact), starting at the end with the lowest rectumPenaltyMm; among nearly equal
/// orders the one whose far end lies to the patient's right, as the cecum does. `rectum` and
/// `cecum` fix the first or last visit. At most 12 segments; O(2ⁿ n²).
std::vector<SegmentVisit> orderSegments(const std::vector<SegmentEnds>& segments,
                                        glm::dvec3 lumenMiddleMm,
                                        std::optional<SegmentVisit> rectum = {},
                                        std::optional<SegmentVisit> cecum = {});

}  // namespace haustra::topology
