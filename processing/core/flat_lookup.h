// From the flat view to the patient and back (dissertation §4.3.1, §6.3.2).
#pragma once

#include "core/centerline.h"
#include "core/flat_map.h"

#include <memory>
#include <optional>
#include <vector>

namespace haustra {

/// One place of the wall, in every way that Haustra names it.
struct WallPlace {
    glm::dvec2 flat{0.0};         ///< x in [0, 1), y in [0, height]
    glm::dvec3 positionMm{0.0};   ///< on the surface, LPS
    int flatTriangle = -1;        ///< of FlatMap::surface
    int sourceTriangle = -1;      ///< of the closed surface
    glm::dvec3 barycentric{0.0};  ///< in `flatTriangle`; sums to 1
    double arcMm = 0.0;           ///< of the camera, between cameras by interpolation
    glm::dvec3 cameraMm{0.0};     ///< where the camera stands, LPS
};

/// Without a flat map: `positionMm` is the place, `cameraMm` and `arcMm` are of the centerline's
/// point nearest to it, which may be in a loop that touches from outside; without a centerline the
/// place and 0. What tells of a map stays unset.
WallPlace placeByCenterline(const Centerline& centerline, glm::dvec3 wallMm);

/// A stretch between two places as it lies on the surface.
struct WallPath {
    std::vector<glm::dvec3> pointsMm;  ///< the ends, and where it crosses triangles' edges
    double lengthMm = 0.0;             ///< along the surface
    double straightMm = 0.0;           ///< from end to end through space: a polyp's diameter
};

/// Finds places in a flat map. Immutable; any number of threads. Memory about 100 bytes a triangle.
class FlatLookup {
public:
    /// The map must be sound: indices in range, one flat coordinate and camera a vertex, at least
    /// one triangle and one camera. O(n).
    explicit FlatLookup(std::shared_ptr<const FlatMap> map);
    ~FlatLookup();
    FlatLookup(FlatLookup&&) noexcept;
    FlatLookup& operator=(FlatLookup&&) noexcept;

    const FlatMap& map() const;

    /// The most circumferences that a line or polygon may span.
    static constexpr double mostTurns = 64.0;

    /// The place at a flat coordinate; x is taken modulo 1. Empty where y is beyond the strip or
    /// either is not finite. Where rounding leaves a hair between two triangles, the nearer of
    /// them. O(log n) expected.
    std::optional<WallPlace> at(glm::dvec2 flat) const;
    /// The place of the surface nearest to a point: a place that `at` gave is found again, also
    /// where another stretch of wall nearly touches it. O(log n) expected near the wall; exact.
    WallPlace nearest(glm::dvec3 positionMm) const;

    /// The 3-D curve of a straight line in the flat plane (x may leave [0, 1]: it wraps, and the
    /// line is not the shorter way round unless the ends say so). Points beyond the strip are
    /// clamped to it. Empty where an end is not finite, or the line runs around more than mostTurns
    /// times. O(triangles crossed).
    WallPath path(glm::dvec2 from, glm::dvec2 to) const;
    /// Area on the surface, mm², of a closed polygon in the flat plane (x may leave [0, 1], the
    /// polygon must not wrap around the colon onto itself). Even–odd where it crosses itself; 0
    /// where it has fewer than three corners, one that is not finite, or is wider than mostTurns.
    /// O(corners² + triangles met by it).
    double areaMm2(const std::vector<glm::dvec2>& polygon) const;

private:
    struct Index;
    std::unique_ptr<const Index> index_;
};

}  // namespace haustra
