// Folds and growths that stand in fluid, by how the HU bend.
#pragma once

#include "core/volume.h"

#include <cstdint>

namespace haustra::cleansing {

/// How surely a voxel lies in tissue that is thin or small beside it, 0…1: the largest eigenvalue
/// of the Hessian, by differences over a neighbour step, is that of a dark sheet (a fold: one
/// large) or a dark cap or ball (a polyp: two or three) in bright contents, beyond what noise of
/// `noiseSd` HU makes (structure-analysis cleansing: Cai et al., Med. Phys. 2008; 35: 3259). 0 at
/// the grid's border.
double structureSignature(const Volume<std::int16_t>& hu, glm::ivec3 voxel, double noiseSd);

}  // namespace haustra::cleansing
