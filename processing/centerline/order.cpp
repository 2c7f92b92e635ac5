#include "centerline/order.h"

#include <cmath>
#include <limits>

namespace haustra::centerline {
namespace {

// How many mm of gap it is worth to end one mm further to the patient's right.
constexpr double cecumPenaltyPerMm = 0.1;

glm::dvec3 entrance(const SegmentEnds& ends, bool reversed) {
    return reversed ? ends.lastMm : ends.firstMm;
}
glm::dvec3 exitOf(const SegmentEnds& ends, bool reversed) {
    return reversed ? ends.firstMm : ends.lastMm;
}

}  // namespace

double rectumPenaltyMm(glm::dvec3 endMm, glm::dvec3 lumenMiddleMm) {
    return endMm.z - 0.5 * endMm.y + 0.5 * std::abs(endMm.x - lumenMiddleMm.x);
}

std::vector<SegmentVisit> orderSegments(const std::vector<SegmentEnds>& segments,
                                        glm::dvec3 lumenMiddleMm,
                                        std::optional<SegmentVisit> rectum,
                                        std::optional<SegmentVisit> cecum) {
    // A state is the set of segments visited with the last visit, as 2 · segment + reversed.
    const std::size_t visits = 2 * segments.size(), sets = std::size_t(1) << segments.size();
    const auto bit = [](std::size_t visit) { return std::size_t(1) << (visit / 2); };
    const auto ends = [&](std::size_t visit) -> const SegmentEnds& { return segments[visit / 2]; };
    const auto is = [](std::size_t visit, const SegmentVisit& wanted) {
        return visit / 2 == wanted.segment && (visit % 2 != 0) == wanted.reversed;
    };
    constexpr double unreached = std::numeric_limits<double>::infinity();
    std::vector<double> cost(sets * visits, unreached);
    std::vector<std::size_t> before(cost.size(), 0);
    for (std::size_t start = 0; start < visits; ++start) {
        if (rectum && !is(start, *rectum)) continue;
        cost[bit(start) * visits + start] =
            rectumPenaltyMm(entrance(ends(start), start % 2), lumenMiddleMm) - ends(start).lengthMm;
    }
    double least = unreached;
    std::size_t bestSet = 0, bestLast = 0;
    for (std::size_t set = 1; set < sets; ++set) {
        for (std::size_t last = 0; last < visits; ++last) {
            const double soFar = cost[set * visits + last];
            if (soFar == unreached) continue;
            const glm::dvec3 from = exitOf(ends(last), last % 2);
            const double total = soFar + cecumPenaltyPerMm * (from.x - lumenMiddleMm.x);
            if (total < least && (!cecum || is(last, *cecum)))
                least = total, bestSet = set, bestLast = last;
            for (std::size_t next = 0; next < visits; ++next) {
                if (set & bit(next)) continue;
                const double through = soFar + glm::distance(from, entrance(ends(next), next % 2)) -
                                       ends(next).lengthMm;
                double& known = cost[(set | bit(next)) * visits + next];
                if (through >= known) continue;
                known = through;
                before[(set | bit(next)) * visits + next] = last;
            }
        }
    }
    std::vector<SegmentVisit> order;
    for (std::size_t set = bestSet, last = bestLast; set != 0;) {
        order.insert(order.begin(), {last / 2, last % 2 != 0});
        const std::size_t previous = before[set * visits + last];
        set &= ~bit(last);
        last = previous;
    }
    return order;
}

}  // namespace haustra::centerline
