// Where tagged fluid stood against the wall, and how far that is from a place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

/// Residue lies where fluid has lain: in a pool, on its shore, or a little above it. Immutable.
class FormerFluid {
public:
    /// Farther fluid is as if it were this far.
    static constexpr double farthestMm = 20.0;

    FormerFluid() = default;
    /// `wet`: of each place of the wall, whether tagging stood before it. O(places).
    FormerFluid(std::span<const glm::dvec3> places, std::span<const std::uint8_t> wet);

    /// To the nearest wet place in a straight line, mm; at most farthestMm.
    double distanceMm(glm::dvec3 placeMm) const;

private:
    glm::ivec3 cellOf(glm::dvec3 placeMm) const;
    std::size_t indexOf(glm::ivec3 cell) const;

    static constexpr double cellMm = 5.0;
    glm::dvec3 lowMm_{0.0};
    glm::ivec3 cells_{0};
    std::vector<std::uint32_t> begin_;  ///< of each cell in places_, and the end
    std::vector<glm::dvec3> places_;
};

}  // namespace haustra::cad
