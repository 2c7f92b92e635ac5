#include "topology/centerline_order.h"

#include <cmath>
#include <limits>

namespace haustra::topology {
namespace {

// How many mm of gap it is worth to end one mm further to the patient's right.
constexpr double cecumPenaltyPerMm = 0.1;

glm::dvec3 entrance(const SegmentEnds& ends, bool reversed) {
    return reversed ? ends.lastMm : ends.firstMm;
}
glm::dvec3 exitOf(const SegmentEnds& ends, bool reversed) {
    return reversed ? ends.firstMm : ends.lastMm;
}

SegmentVisit likeliestRectum(const std::vector<SegmentEnds>& segments, glm::dvec3 middleMm,
                             const std::optional<SegmentVisit>& cecum) {
    SegmentVisit best;
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < segments.size(); ++s) {
        for (const bool reversed : {false, true}) {
            // The journey that ends with the cecum's segment can only begin there if it is the only
            // one.
            if (cecum && cecum->segment == s &&
                (segments.size() > 1 || cecum->reversed != reversed))
                continue;
            const double penalty = rectumPenaltyMm(entrance(segments[s], reversed), middleMm);
            if (penalty < lowest) lowest = penalty, best = {s, reversed};
        }
    }
    return best;
}

}  // namespace

double rectumPenaltyMm(glm::dvec3 endMm, glm::dvec3 lumenMiddleMm) {
    return endMm.z - 0.5 * endMm.y + 0.5 * std::abs(endMm.x - lumenMiddleMm.x);
}

std::vector<SegmentVisit> orderSegments(const std::vector<SegmentEnds>& segments,
                                        glm::dvec3 lumenMiddleMm,
                                        std::optional<SegmentVisit> rectum,
                                        std::optional<SegmentVisit> cecum) {
    const std::size_t count = segments.size();
    if (count == 0) return {};
    const SegmentVisit start = rectum ? *rectum : likeliestRectum(segments, lumenMiddleMm, cecum);
    // State: the segments visited, and the last visit as 2 · segment + reversed.
    const std::size_t states = 2 * count;
    std::vector<double> cost((std::size_t(1) << count) * states,
                             std::numeric_limits<double>::infinity());
    std::vector<std::size_t> before(cost.size(), 0);
    cost[(std::size_t(1) << start.segment) * states + 2 * start.segment + start.reversed] = 0.0;
    for (std::size_t visited = 1; visited < std::size_t(1) << count; ++visited) {
        for (std::size_t last = 0; last < states; ++last) {
            const double soFar = cost[visited * states + last];
            if (std::isinf(soFar)) continue;
            const glm::dvec3 from = exitOf(segments[last / 2], last % 2);
            for (std::size_t next = 0; next < states; ++next) {
                const std::size_t bit = std::size_t(1) << (next / 2);
                if (visited & bit) continue;
                const double through =
                    soFar + glm::distance(from, entrance(segments[next / 2], next % 2));
                double& best = cost[(visited | bit) * states + next];
                if (through < best) {
                    best = through;
                    before[(visited | bit) * states + next] = last;
                }
            }
        }
    }
    std::size_t visited = (std::size_t(1) << count) - 1, last = 2 * start.segment + start.reversed;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t end = 0; end < states; ++end) {
        if (cecum && (end / 2 != cecum->segment || bool(end % 2) != cecum->reversed)) continue;
        const double total =
            cost[visited * states + end] + cecumPenaltyPerMm * exitOf(segments[end / 2], end % 2).x;
        if (total < best) best = total, last = end;
    }
    std::vector<SegmentVisit> order(count);
    for (std::size_t n = count; n-- > 0;) {
        order[n] = {last / 2, last % 2 != 0};
        const std::size_t previous = before[visited * states + last];
        visited &= ~(std::size_t(1) << (last / 2));
        last = previous;
    }
    return order;
}

}  // namespace haustra::topology
