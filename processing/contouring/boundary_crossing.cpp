#include "contouring/boundary_crossing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace haustra::contouring {
namespace {

// Crossings keep this far from the centres, as a share of the edge, so that no two coincide.
constexpr double edgeMargin = 0.02;
// Noise may put a voxel on the wrong side of isoHu; the wall is then this much beyond the edge.
constexpr double beyondEdge = 0.5;

}  // namespace

BoundaryCrossings::BoundaryCrossings(const Volume<std::int16_t>& hu, double isoHu,
                                     glm::ivec3 origin)
    : hu_(hu),
      isoHu_(isoHu),
      origin_(origin),
      last_(hu.grid().size - 1),
      mmFromVoxel_(hu.grid().patientFromVoxel),
      covectorMm_(glm::transpose(glm::inverse(mmFromVoxel_))) {}

double BoundaryCrossings::at(glm::ivec3 v) const {
    return hu_.at(glm::clamp(v, glm::ivec3(0), last_));
}

glm::dvec3 BoundaryCrossings::gradient(glm::ivec3 v) const {
    constexpr int smooth[3] = {1, 2, 1}, difference[3] = {-1, 0, 1};
    const glm::ivec3 before = glm::clamp(v - 1, glm::ivec3(0), last_);
    const glm::ivec3 here = glm::clamp(v, glm::ivec3(0), last_);
    const glm::ivec3 after = glm::clamp(v + 1, glm::ivec3(0), last_);
    const int i[3] = {before.x, here.x, after.x};
    const int j[3] = {before.y, here.y, after.y}, k[3] = {before.z, here.z, after.z};
    glm::ivec3 sum(0);
    for (int c = 0; c < 3; ++c) {
        for (int b = 0; b < 3; ++b) {
            const std::int16_t* row = hu_.voxels().data() + hu_.grid().index(0, j[b], k[c]);
            const int low = row[i[0]], middle = row[i[1]], high = row[i[2]];
            const int smoothed = low + 2 * middle + high;
            sum.x += smooth[b] * smooth[c] * (high - low);
            sum.y += difference[b] * smooth[c] * smoothed;
            sum.z += smooth[b] * difference[c] * smoothed;
        }
    }
    return glm::dvec3(sum) / 32.0;
}

Crossing BoundaryCrossings::between(glm::ivec3 inside, glm::ivec3 outside) const {
    const double fromHu = at(inside), rise = at(outside) - fromHu;
    const glm::dvec3 start(inside - origin_), along(outside - inside);
    Crossing crossing;
    double share = 0.5;
    if (rise > 0.0) {
        const double crossed = (isoHu_ - fromHu) / rise;
        if (crossed >= -beyondEdge && crossed <= 1.0 + beyondEdge) {
            const double t = std::clamp(crossed, 0.0, 1.0);
            const glm::dvec3 normal =
                covectorMm_ * ((1.0 - t) * gradient(inside) + t * gradient(outside));
            if (glm::dot(normal, mmFromVoxel_ * along) > 0.0) {
                crossing.normal = glm::normalize(normal);
                crossing.weight = 1.0 - std::abs(crossed - t) / beyondEdge;
                share = crossed;
            }
        }
    }
    crossing.point = start + share * along;
    crossing.onEdge = start + std::clamp(share, edgeMargin, 1.0 - edgeMargin) * along;
    return crossing;
}

}  // namespace haustra::contouring
