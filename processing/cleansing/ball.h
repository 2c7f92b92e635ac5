// The surroundings of a voxel in millimetres, whatever its size.
#pragma once

#include "core/grid.h"

#include <cstddef>
#include <vector>

namespace haustra::cleansing {

/// Farther than this from a border the scanner's blur does not reach, mm.
inline constexpr double blurReachMm = 1.6;

/// Voxels along each axis that are nearest to `mm`, at least 1.
glm::ivec3 voxelsIn(const Grid& grid, double mm);

/// How many voxels along each axis make a step of 0.7 mm, at least 1. The "neighbours" of a voxel,
/// for differences and averages, are those one such step away, and wider surroundings are sampled
/// by such steps too: results and cost hardly depend on the size of the voxels.
inline glm::ivec3 neighbourStep(const Grid& grid) {
    return voxelsIn(grid, 0.7);
}

/// Voxels along each axis that the blur reaches from within a border's own voxel.
glm::ivec3 blurReachVoxels(const Grid& grid);

/// The surroundings of a voxel of a grid, sampled by neighbour steps.
class Ball {
public:
    /// An ellipsoid of these radii but the centre, always with the six along the axes.
    Ball(const Grid& grid, glm::dvec3 radiusMm);

    /// Whether `holds(index)` at every voxel around `v` that is within the grid.
    template <class Predicate>
    bool everywhere(glm::ivec3 v, const Predicate& holds) const {
        const std::size_t here = grid_.index(v);
        const bool inside = glm::all(glm::greaterThanEqual(v, reach_)) &&
                            glm::all(glm::lessThan(v, grid_.size - reach_));
        for (const Step& step : steps_) {
            if ((inside || grid_.contains(v + step.voxels)) &&
                !holds(std::size_t(std::ptrdiff_t(here) + step.indices)))
                return false;
        }
        return true;
    }

private:
    struct Step {
        glm::ivec3 voxels;
        std::ptrdiff_t indices;
    };

    Grid grid_;
    glm::ivec3 reach_{0};
    std::vector<Step> steps_;  ///< the farthest first: they are the likeliest to fail
};

/// Large enough that where all of it holds one material, no other material's blur reaches its
/// centre: the blur's reach, and half a voxel, as a border may lie anywhere within its voxel.
inline Ball blurBall(const Grid& grid) {
    return {grid, blurReachMm + 0.5 * grid.spacingMm()};
}

/// That, and `mm` more.
inline Ball widerBall(const Grid& grid, double mm) {
    return {grid, blurReachMm + mm + 0.5 * grid.spacingMm()};
}

/// Of a row each `every`th voxel is looked at, voxel `one` (0 and more) among them: the first of
/// these.
inline int firstSample(int one, int every) {
    return one % every;
}

/// Calls visit(v + n · step), n whole numbers for each axis, for those voxels that are in the grid
/// and no farther from `v` than `reach` along each axis.
template <class Visit>
void eachStep(const Grid& grid, glm::ivec3 v, glm::ivec3 reach, glm::ivec3 step,
              const Visit& visit) {
    const glm::ivec3 lo = glm::min(reach, v) / step, hi = glm::min(reach, grid.size - 1 - v) / step;
    for (int k = -lo.z; k <= hi.z; ++k) {
        for (int j = -lo.y; j <= hi.y; ++j) {
            for (int i = -lo.x; i <= hi.x; ++i)
                visit(v + glm::ivec3(i, j, k) * step);
        }
    }
}

}  // namespace haustra::cleansing
