// Gas that stands within the lumen, behind a wall of its own.
#pragma once

#include "core/volume.h"
#include "segmentation/tube_pieces.h"

#include <cstdint>
#include <vector>

namespace haustra::segmentation {

struct EnclosedGas {
    glm::dvec3 placeMm{0.0};           ///< its mean
    double volumeMl = 0.0;             ///< without its wall
    double facing = 0.0;               ///< share of its surface that faces the lumen
    std::vector<std::int32_t> pieces;  ///< that it has voxels of; ascending
};

/// Takes into `labels` (LumenLabel) what the lumen encloses: gas at least 6 mm wide, behind a wall
/// of at most 3 mm that has lumen on its other side, over three quarters of its surface; the wall
/// and the gas that it blurs become LumenLabel::untagged. That is the balloon of a rectal catheter:
/// bowel that lies against the colon is joined to more bowel, and to its mesentery. Surface towards
/// other gas that is no lumen, such as the catheter's bore, does not count. The largest first; less
/// than 5 ml is left: the bore of a catheter without a balloon, whose wall is as bright as bone.
/// O(voxels).
std::vector<EnclosedGas> takeInEnclosedGas(const Volume<std::uint8_t>& content,
                                           const TubePieces& cut, Volume<std::uint8_t>& labels,
                                           int threads);

/// Takes into `labels` walls of at most 3 mm between lumen in the pieces `balloons` and lumen in
/// the pieces `rectum`, as LumenLabel::untagged: of a balloon that fills the rectum. What parts
/// either from other pieces stays. O(voxels).
void takeInBalloons(const std::vector<std::int32_t>& balloons,
                    const std::vector<std::int32_t>& rectum, const Volume<std::uint8_t>& content,
                    const TubePieces& cut, Volume<std::uint8_t>& labels, int threads);

}  // namespace haustra::segmentation
