// Which end of the lumen is the rectum, and in which order the colon passes its segments.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::centerline {

/// One segment of the lumen: the ends of its path in patient mm (LPS), and the path's length.
struct SegmentEnds {
    glm::dvec3 firstMm{0.0}, lastMm{0.0};
    double lengthMm = 0.0;
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

/// The order from rectum to cecum. Of all orders of all subsets of the segments it has the
/// greatest length of segments less length of gaps between them, less rectumPenaltyMm where it
/// begins, less a little for a far end to the patient's left, as the cecum lies to the right. So a
/// segment that lies farther off the way than it is long, such as gas in the small bowel, is left
/// out. `rectum` and `cecum` fix the first or last visit; where they contradict each other the
/// result is empty. At most 12 segments; Held and Karp's dynamic programme, O(2ⁿ n²).
std::vector<SegmentVisit> orderSegments(const std::vector<SegmentEnds>& segments,
                                        glm::dvec3 lumenMiddleMm,
                                        std::optional<SegmentVisit> rectum = {},
                                        std::optional<SegmentVisit> cecum = {});

}  // namespace haustra::centerline
