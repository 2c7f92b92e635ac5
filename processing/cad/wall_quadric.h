// The wall around a place, continued across it.
#pragma once

#include "cad/wall_evidence.h"

#include <cstdint>
#include <optional>
#include <span>

#include <glm/glm.hpp>

namespace haustra::cad {

/// z = c₀ + c₁x + c₂y + c₃x² + c₄xy + c₅y², so with the wall's own curvature, in a frame of its
/// own: the origin on or near the wall, z lumenward.
struct WallQuadric {
    glm::dmat3 frameFromPatient{1.0};
    glm::dvec3 originMm{0.0};
    double terms[6] = {};
    /// Mean distance of the samples that it was fitted to, along z, each at most 3 mm.
    double roughMm = 0.0;

    glm::dvec3 placeOf(glm::dvec3 patientMm) const {
        return frameFromPatient * (patientMm - originMm);
    }
    /// Of a place in the frame, lumenward.
    double heightMm(glm::dvec3 place) const;
    /// The lesser second derivative, 1/mm: negative where it bends away from the lumen, as a fold.
    double leastBend() const;
};

/// A sample, brought from the simplified mesh to the scan's surface by the first derivative.
glm::dvec3 onScanSurface(const WallEvidence& evidence, std::uint32_t sample);

/// The quadric that fits best, z along `axis`, a unit, of those of `around` that face along it, and
/// that somebody saw with no untagged fluid before them. Iteratively reweighted, as by a Cauchy
/// distribution: a fold or a lesion among them pulls little. None where fewer than thirty are left.
/// O(samples around).
std::optional<WallQuadric> quadricThrough(const WallEvidence& evidence,
                                          std::span<const std::uint32_t> around, glm::dvec3 axis,
                                          glm::dvec3 originMm);

}  // namespace haustra::cad
