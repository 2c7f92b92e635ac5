// Segmented photographic volumes (dissertation §5.2.3; the Visible Korean's form): a colour, an
// opacity and a label for each voxel.
#pragma once

#include "core/rgba.h"
#include "core/volume.h"

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// Voxels' colour with their opacity for a way of 1 mm, and which organ each belongs to. Immutable;
/// shared between threads.
struct LabelledColorVolume {
    Volume<Rgba> color;
    Volume<std::int16_t> labels;  ///< on the same grid; empty: all 0

    const Grid& grid() const { return color.grid(); }
    std::int16_t labelAt(std::size_t voxel) const {
        return labels.empty() ? std::int16_t(0) : labels[voxel];
    }
};

/// Fails (badInput) where the two are not on one grid or it is not sound.
Result<LabelledColorVolume> makeLabelledColor(Volume<Rgba> color, Volume<std::int16_t> labels);

/// CIE 1976 L*u*v* of a colour as displayed (sRGB, white D65): distances are as the eye sees them.
glm::dvec3 luvOf(Rgba color);

/// How opacity follows from colour alone.
struct ColorOpacity {
    double least = 0.0;          ///< of every voxel with a label
    double gain = 1.0;           ///< opacity where colours differ by `atDifference`
    double atDifference = 40.0;  ///< ΔE*uv over two voxels
    double exponent = 2.0;
    double dark = 15.0;  ///< L* of what is clear, as the block around a body that is sliced
};

/// Opacity by how fast the colour changes in the eye's terms, after Ebert et al. 2002 ("Designing
/// effective transfer functions for volume rendering from photographic volumes"): the length of
/// the gradient of L*u*v*, by central differences, its axes' differences together; gain · (length /
/// atDifference)^exponent, at most 1. What is of one colour is clear but for `least`, and what is
/// darker than `dark` is clear. The colours stay. O(voxels), the same for any number of threads.
Volume<Rgba> withColorOpacity(const Volume<Rgba>& color, const Volume<std::int16_t>& labels,
                              const ColorOpacity& rule, int threads);

/// For each cell of `side` voxels a side, as CellGrid orders them, the labels of the voxels that
/// interpolation in it reads; sorted. O(voxels).
std::vector<std::vector<std::int16_t>> labelsOfCells(const LabelledColorVolume& volume, int side,
                                                     int threads);

}  // namespace haustra::render
