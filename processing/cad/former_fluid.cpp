#include "cad/former_fluid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haustra::cad {

FormerFluid::FormerFluid(std::span<const glm::dvec3> places, std::span<const std::uint8_t> wet) {
    glm::dvec3 low(1e30), high(-1e30);
    for (std::size_t n = 0; n < places.size(); ++n)
        if (wet[n]) low = glm::min(low, places[n]), high = glm::max(high, places[n]);
    if (low.x > high.x) return;
    lowMm_ = low;
    cells_ = glm::ivec3((high - low) / cellMm) + 1;
    begin_.assign(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z) + 1, 0);
    for (std::size_t n = 0; n < places.size(); ++n)
        if (wet[n]) ++begin_[indexOf(cellOf(places[n])) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    places_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t n = 0; n < places.size(); ++n)
        if (wet[n]) places_[next[indexOf(cellOf(places[n]))]++] = places[n];
}

double FormerFluid::distanceMm(glm::dvec3 placeMm) const {
    double least = farthestMm;
    const glm::ivec3 low = glm::max(cellOf(placeMm - farthestMm), glm::ivec3(0)),
                     high = glm::min(cellOf(placeMm + farthestMm), cells_ - 1);
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) {
                const glm::ivec3 cell(x, y, z);
                const glm::dvec3 near = lowMm_ + cellMm * glm::dvec3(cell);
                const glm::dvec3 off =
                    glm::max(glm::max(near - placeMm, placeMm - near - cellMm), glm::dvec3(0.0));
                if (glm::dot(off, off) >= least * least) continue;
                const std::size_t at = indexOf(cell);
                for (std::uint32_t n = begin_[at]; n < begin_[at + 1]; ++n)
                    least = std::min(least, glm::distance(places_[n], placeMm));
            }
        }
    }
    return least;
}

glm::ivec3 FormerFluid::cellOf(glm::dvec3 placeMm) const {
    return glm::ivec3(glm::floor((placeMm - lowMm_) / cellMm));
}

std::size_t FormerFluid::indexOf(glm::ivec3 cell) const {
    return std::size_t(cell.x) +
           std::size_t(cells_.x) *
               (std::size_t(cell.y) + std::size_t(cells_.y) * std::size_t(cell.z));
}

}  // namespace haustra::cad
