// How dense the tagging, and how dense the soft tissue, is at each place of the colon.
#pragma once

#include "cleansing/noise.h"
#include "cleansing/smooth_field.h"
#include "cleansing/tagged_surroundings.h"
#include "core/ct_scan.h"
#include "core/tissue.h"

namespace haustra::cleansing {

/// Voxels along each axis of the cells that LocalMeans are measured in.
glm::ivec3 cellVoxels(const Grid& grid);

/// What pure contents and pure wall measure near the tagged colon.
struct LocalMeans {
    /// Tagging is uneven: from pool to pool, by depth, in blotches, stool in fluid. HU that each
    /// voxel would have were it all tagged; set in the surroundings only, 0 elsewhere.
    Volume<std::int16_t> taggedHu;
    SmoothField softHu;  ///< the wall, its folds and growths
    SmoothField airHu;   ///< the colon's own gas: scatter from dense fluid lifts it nearby
    NoiseSd noise;
};

/// Means over the voxels that lie deeper inside their material than the scanner's blur reaches
/// (1.6 mm), by normalised convolution: a place that has none nearby takes the mean of a wider
/// neighbourhood, and in the end the class's own. Tagged material is what `segmentation` says it
/// is; `around` is its surroundings. The box of a scan that holds what is within 20 mm of the
/// labels will do, which begins a whole number of cells (cellVoxels) before them. O(labelled
/// voxels); the same for any number of threads.
LocalMeans measureLocalMeans(const CtScan& scan, const TissueModel& tissue,
                             const Volume<std::uint8_t>& segmentation,
                             const TaggedSurroundings& around, int threads);

}  // namespace haustra::cleansing
