// How far one looks around a voxel: in millimetres, whatever its size.
#pragma once

#include "core/grid.h"

#include <cstddef>
#include <vector>

namespace haustra::cleansing {

/// Farther than this from a border the scanner's blur does not reach, mm.
inline constexpr double blurReachMm = 1.6;

/// Voxels along each axis that are nearest to `mm`, at least 1.
glm::ivec3 voxelsIn(const Grid& grid, double mm);

/// Voxels along each axis to a step of 0.7 mm, at least 1: what looks at a voxel's neighbours looks
/// this far. Looks over a wider place go by such steps too, so that smaller voxels make no look
/// dearer.
inline glm::ivec3 lookStep(const Grid& grid) {
    return voxelsIn(grid, 0.7);
}

/// Voxels along each axis that the blur reaches from within a border's own voxel.
glm::ivec3 blurReachVoxels(const Grid& grid);

/// What lies around a voxel of a grid, by look steps.
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

/// Where all of it holds one material no other's blur reaches, wherever the border lies within its
/// voxel.
inline Ball blurBall(const Grid& grid) {
    return {grid, blurReachMm + 0.5 * grid.spacingMm()};
}

/// Of every `every`th voxel of a scan's row from `first` on, the first that is not before voxel
/// `from`, counted from there.
inline int firstSample(int first, int from, int every) {
    return ((first - from) % every + every) % every;
}

/// Calls visit(voxel) for those of the grid within `reach` voxels of `v` along each axis, from it
/// by `step`.
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
