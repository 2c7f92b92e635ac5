// What a ray of the endoscopic view meets where the case has no flattened wall to ask, or before
// it.
#pragma once

#include "core/tri_mesh.h"
#include "core/volume.h"

#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

namespace haustra::session {

/// From `fromMm` along a direction, finite and not zero; patient space.
struct PickRay {
    glm::dvec3 fromMm{0.0};
    glm::dvec3 direction{0.0, 0.0, 1.0};
};

struct MetTriangle {
    int triangle = -1;
    glm::dvec3 positionMm{0.0};
};
/// The first triangle that a ray meets, from whichever side; empty where it meets none (Möller,
/// Trumbore 1997). O(triangles): some 10 ms for a million.
std::optional<MetTriangle> firstMet(const TriMesh& mesh, const PickRay& ray);

/// Where the mucosa's surface is drawn: midway between air and soft tissue.
inline constexpr double wallHu = -480.0;
/// Where the scan first reaches wallHu along a ray, by steps of half the smallest distance between
/// voxels, and within a step by interpolation; where the ray begins or enters the scan in tissue,
/// that place. Empty where there is none.
std::optional<glm::dvec3> firstTissue(const Volume<std::int16_t>& scan, const PickRay& ray);

}  // namespace haustra::session
