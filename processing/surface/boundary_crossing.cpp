#include "surface/boundary_crossing.h"

#include <algorithm>
#include <cstdint>

namespace haustra::surface {
namespace {

// Crossings keep this far from the centres, as a share of the edge, so that no two coincide.
constexpr double edgeMargin = 0.02;
// Noise may put a voxel on the wrong side of isoHu; the wall is then this much beyond the edge.
constexpr double beyondEdge = 0.5;

}  // namespace

BoundaryCrossings::BoundaryCrossings(const Volume<std::int16_t>& hu, double isoHu)
    : hu_(hu),
      isoHu_(isoHu),
      last_(hu.grid().size - 1),
      mmFromVoxel_(hu.grid().patientFromVoxel),
      covectorMm_(glm::transpose(glm::inverse(mmFromVoxel_))) {}

double BoundaryCrossings::at(glm::ivec3 v) const {
    return hu_.at(glm::clamp(v, glm::ivec3(0), last_));
}

glm::dvec3 BoundaryCrossings::gradient(glm::ivec3 v) const {
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 step(0);
        step[axis] = 1;
        gradient[axis] = 0.5 * (at(v + step) - at(v - step));
    }
    return gradient;
}

Crossing BoundaryCrossings::between(glm::ivec3 inside, glm::ivec3 outside) const {
    const double fromHu = at(inside), rise = at(outside) - fromHu;
    const glm::dvec3 start(inside), along(outside - inside);
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
                share = crossed;
            }
        }
    }
    crossing.point = start + share * along;
    crossing.onEdge = start + std::clamp(share, edgeMargin, 1.0 - edgeMargin) * along;
    return crossing;
}

}  // namespace haustra::surface
