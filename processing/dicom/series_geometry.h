// How the slices of a series stack into one volume: order, spacing, holes, gantry tilt. Pure
// geometry; knows nothing of files but their names.
#pragma once

#include "core/grid.h"
#include "core/result.h"

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::dicom {

/// One slice, in LPS mm.
struct Slice {
    std::string name;            ///< for messages: the file, and the frame where it has several
    std::string instanceUid;     ///< equal for two copies of one slice
    glm::dvec3 positionMm{0.0};  ///< centre of its first pixel
    glm::dvec3 rowDirection{1, 0, 0};
    glm::dvec3 columnDirection{0, 1, 0};
    glm::dvec2 pixelSpacingMm{1.0};
    glm::ivec2 matrix{0};
    double thicknessMm = 0.0;  ///< 0: unknown
};

/// The volume that the slices make, and how each gets there.
struct SliceStack {
    std::vector<std::size_t> order;  ///< indices of the slices kept, along the normal row × column
    /// Of slices left out as copies the slice that was kept.
    struct Copy {
        std::size_t slice = 0, kept = 0;
    };
    std::vector<Copy> copies;
    /// Where the stack is sheared (gantry tilt): the pixel (i, j) of slice order[k] belongs at
    /// pixel (i, j) + shiftPixels[k] of the result. Empty where the slices already sit squarely.
    std::vector<glm::dvec2> shiftPixels;
    /// Where the spacing varies: depth of slice order[k] in slices of the result, ascending from 0.
    /// Empty where it is uniform.
    std::vector<double> depthSlices;
    Grid grid;                       ///< of the result
    std::vector<std::string> notes;  ///< corrections, for a person
};

/// Stacks at least one slice, in any order. Fails, naming the slices, where orientation, matrix or
/// pixel spacing differ, two different slices share a position, a slice is missing (a gap 1.5
/// times both its neighbours, or 1.5 times the usual one and alone or with one neighbour as wide),
/// a slice stands between two that are as far apart as those before and behind, gaps exceed 10 mm,
/// or slices are displaced sideways other than by a tilt. Gaps that vary without a hole are
/// resampled to the smallest, or to half the median if that is more. Deterministic; O(n log n).
Result<SliceStack> stackSlices(const std::vector<Slice>& slices);

}  // namespace haustra::dicom
