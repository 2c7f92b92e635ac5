// The classification as a picture: what reviewers of digital cleansing compare the scans with.
#pragma once

#include "core/tissue.h"
#include "core/volume.h"
#include "render/scene/picture.h"

namespace haustra::render {

/// Colours of Figure 3.1 of the dissertation, sRGB.
inline constexpr glm::u8vec3 airColor{255, 0, 0}, softColor{0, 255, 0}, taggedColor{0, 0, 255},
    interfaceColor{255, 105, 180};

/// The colour of a voxel by what it holds (dissertation §3.2). Shares of 5 % and less count as
/// none, so that a voxel with over 95 % of one tissue has that tissue's pure colour. Otherwise the
/// mean of its tissues' colours, weighted by their shares, where air and tagged material in one
/// voxel both count as interface: one that holds only these two is the pure colour of interfaces.
glm::u8vec3 tissueColor(TissueFractions fractions);

/// The slice that `view` places (its scan and window count for nothing), each pixel in the colour
/// of the voxel that it lies in; black outside. Fails as placeSlice does. O(pixels). Any thread.
Result<Image> tissuePicture(const Volume<TissueFractions>& mixture, const SliceView& view,
                            int width, int height);

}  // namespace haustra::render
