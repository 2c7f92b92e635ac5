// Labels as one connected body.
#pragma once

#include "core/simple_point.h"
#include "core/volume.h"

#include <cstdint>
#include <functional>

namespace haustra {

struct JoinBodiesOptions {
    double leastMl = 0.05;   ///< smaller bodies are not joined
    bool dropOthers = true;  ///< what is not joined to the largest body becomes 0
};

/// Joins the 6-connected bodies of labels other than 0 to the largest one, each by the way of
/// fewest voxels for which `passable` holds; they get the label `labelOf` says. Returns the volume,
/// ml, of what nothing joins. O(voxels) for each body joined; labels that are one body already cost
/// one sweep.
double joinBodies(Volume<std::uint8_t>& labels, const std::function<bool(std::size_t)>& passable,
                  const std::function<std::uint8_t(std::size_t)>& labelOf,
                  const JoinBodiesOptions& options = {});

/// The voxels around one (and itself) that have a label other than 0; none beyond the grid.
Neighbourhood labelledAround(const Volume<std::uint8_t>& labels, glm::ivec3 voxel);

/// Whether a voxel of label 0 could get another label without joining what is parted around it: one
/// 6-connected body of labels among its neighbours, and of 0 one 18-connected body at most.
bool joinsNothing(const Volume<std::uint8_t>& labels, std::size_t index);

}  // namespace haustra
