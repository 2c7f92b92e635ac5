// The part of a scan that the segmentation works on, and the way back to all of it.
#pragma once

#include "core/crop.h"
#include "core/ct_scan.h"
#include "segmentation/bowel_contents.h"

#include <span>

namespace haustra::segmentation {

/// Voxels along each axis that are taken together: as many as make no more than 0.8 mm. The
/// thinnest walls that a scanner resolves are told at that size by their height over the gas
/// (thin_walls.h).
glm::ivec3 binningOf(const Grid& grid);

/// The grid of blocks of `by` voxels; the last of a row may be cut off.
Grid binned(const Grid& grid, glm::ivec3 by);

/// Means of blocks of `by` voxels; of what there is of a block at the grid's end.
Volume<std::int16_t> binned(const Volume<std::int16_t>& hu, glm::ivec3 by, int threads);

/// Where bowel may lie: the body's gas, but specks, and the points of `alsoMm`, with 60 mm around
/// them and 80 mm towards head and feet: fluid under gas is as deep as the colon is wide, and a
/// section may be full of it to the roof. The whole grid where there is no gas.
VoxelBox bowelBox(const Volume<std::uint8_t>& content, std::span<const glm::dvec3> alsoMm,
                  int threads);

/// Contents of the box, on its grid. All levels of the scan stay, with their HU and area, which
/// tell what its fluid is; of their columns those within the box.
BowelContents cropped(const BowelContents& contents, const VoxelBox& box, int threads);

/// The labels of a scan by those of its binned one: each block has its voxel's label, and then the
/// border of the gas moves to where the scan's own HU cross `airBelowHu`, by simple points alone,
/// at most one block far: components, handles and cavities stay. It does not move into voxels that
/// are 1 in `barred` (of the binned grid), which are rebuilt walls and other bowel. `labels` and
/// `barred` are on the box's grid, `hu` on that of the box times `by`.
Volume<std::uint8_t> atFullResolution(const Volume<std::uint8_t>& labels,
                                      const Volume<std::uint8_t>& barred,
                                      const Volume<std::int16_t>& hu, glm::ivec3 by,
                                      double airBelowHu, int threads);

}  // namespace haustra::segmentation
