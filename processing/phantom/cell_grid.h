// Items in space by the cells of a regular grid, for the nearest of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::phantom {

/// Axis-aligned, mm.
struct Box {
    glm::dvec3 low{0.0}, high{0.0};
};

/// Which items (by number) reach into which cubic cell. Immutable, so any thread may ask.
class CellGrid {
public:
    static constexpr std::uint32_t none = ~0u;

    struct Nearest {
        std::uint32_t item = none;
        double squaredMm2 = std::numeric_limits<double>::infinity();
    };

    CellGrid() = default;
    /// O(items · cells that each reaches + cells of their common box).
    CellGrid(std::span<const Box> boxes, double cellMm);

    /// The item whose squaredDistance(item) to p is least; of several as near, the one with the
    /// lowest number. The function must measure to the part of the item inside its box.
    template <class SquaredDistance>
    Nearest nearest(glm::dvec3 p, const SquaredDistance& squaredDistance) const;

private:
    glm::ivec3 cellOf(glm::dvec3 p) const { return glm::ivec3(glm::floor((p - lowMm_) / cellMm_)); }

    std::size_t indexOf(glm::ivec3 cell) const {
        return std::size_t(cell.x) +
               std::size_t(cells_.x) * (std::size_t(cell.y) + std::size_t(cells_.y) * cell.z);
    }

    glm::dvec3 lowMm_{0.0};
    double cellMm_ = 1.0;
    glm::ivec3 cells_{0};
    std::vector<std::uint32_t> begin_, items_;  ///< items of cell c: items_[begin_[c]…begin_[c+1])
};

template <class SquaredDistance>
CellGrid::Nearest CellGrid::nearest(glm::dvec3 p, const SquaredDistance& squaredDistance) const {
    Nearest best;
    const auto visit = [&](int i, int j, int k) {
        const std::size_t cell = indexOf({i, j, k});
        for (std::uint32_t n = begin_[cell]; n < begin_[cell + 1]; ++n) {
            const double d = squaredDistance(items_[n]);
            if (d < best.squaredMm2 || (d == best.squaredMm2 && items_[n] < best.item))
                best = {items_[n], d};
        }
    };
    // Shell by shell around p's cell; a shell's cells are no nearer than (ring − 1) cells.
    const glm::ivec3 middle = cellOf(p);
    const glm::ivec3 toLow = middle, toHigh = cells_ - 1 - middle;
    const auto most = [](glm::ivec3 v) { return std::max({v.x, v.y, v.z}); };
    const int first = std::max(0, most(glm::max(-toLow, -toHigh)));
    const int last = most(glm::max(toLow, toHigh));
    for (int ring = first; ring <= last; ++ring) {
        const double least = std::max(0, ring - 1) * cellMm_;
        if (best.squaredMm2 <= least * least) break;
        const glm::ivec3 lo = glm::max(middle - ring, glm::ivec3(0)),
                         hi = glm::min(middle + ring, cells_ - 1);
        for (int k = lo.z; k <= hi.z; ++k) {
            for (int j = lo.y; j <= hi.y; ++j) {
                if (std::abs(k - middle.z) == ring || std::abs(j - middle.y) == ring) {
                    for (int i = lo.x; i <= hi.x; ++i)
                        visit(i, j, k);
                } else {
                    if (middle.x - ring >= 0 && middle.x - ring < cells_.x)
                        visit(middle.x - ring, j, k);
                    if (ring > 0 && middle.x + ring >= 0 && middle.x + ring < cells_.x)
                        visit(middle.x + ring, j, k);
                }
            }
        }
    }
    return best;
}

}  // namespace haustra::phantom
