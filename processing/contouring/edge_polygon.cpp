#include "contouring/edge_polygon.h"

#include <algorithm>

namespace haustra::contouring {
namespace {

// Strictly inside by this share, far above the rounding of coordinates in mm.
constexpr double strictly = 1e-6;

double across(glm::dvec3 a, glm::dvec3 b) {
    return a.y * b.z - a.z * b.y;
}
bool strictlyWithin(double share) {
    return share > strictly && share < 1.0 - strictly;
}

/// Whether triangles (from, near, to) and (from, to, far) keep within the tetrahedra, `near` being
/// the corner on whose side of the edge the diagonal passes.
bool keepsWithin(glm::dvec3 from, glm::dvec3 to, glm::dvec3 near, glm::dvec3 far) {
    // The diagonal must pass between the edge and `near`: through the triangle that they span.
    const double a = across(near, from), b = across(near, to);
    if (a == b) return false;
    const glm::dvec3 pass = from + a / (a - b) * (to - from);
    const double outwards =
        (pass.y * near.y + pass.z * near.z) / (near.y * near.y + near.z * near.z);
    if (outwards < 0.0 || outwards > 1.0 - strictly) return false;
    if (!strictlyWithin((pass.x - outwards * near.x) / (1.0 - outwards))) return false;
    // The edge must pass through the other triangle.
    const double u = across(to, far), v = across(far, from), w = across(from, to);
    const double sum = u + v + w;
    return sum != 0.0 && strictlyWithin((u * from.x + v * to.x + w * far.x) / sum);
}

/// Area over the squared sides: greatest for the equilateral triangle.
double roundness(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::dvec3 ab = b - a, bc = c - b, ca = a - c;
    return glm::length(glm::cross(ab, ca)) /
           (glm::dot(ab, ab) + glm::dot(bc, bc) + glm::dot(ca, ca));
}

}  // namespace

std::optional<int> envelopeDiagonal(const std::array<glm::dvec3, 4>& corners,
                                    const std::array<glm::dvec3, 4>& cornersMm) {
    std::optional<int> best;
    double bestRoundness = -1.0;
    for (int diagonal = 0; diagonal < 2; ++diagonal) {
        const int n[4] = {diagonal, diagonal + 1, diagonal + 2, (diagonal + 3) % 4};
        const glm::dvec3 from = corners[n[0]], to = corners[n[2]];
        const bool passesSecond = across(from, to) >= 0.0;
        const glm::dvec3 near = corners[passesSecond ? n[1] : n[3]];
        const glm::dvec3 far = corners[passesSecond ? n[3] : n[1]];
        if (!keepsWithin(from, to, near, far)) continue;
        const double rounder =
            std::min(roundness(cornersMm[n[0]], cornersMm[n[1]], cornersMm[n[2]]),
                     roundness(cornersMm[n[0]], cornersMm[n[2]], cornersMm[n[3]]));
        if (rounder > bestRoundness) bestRoundness = rounder, best = diagonal;
    }
    return best;
}

}  // namespace haustra::contouring
