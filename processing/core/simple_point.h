// Simple points and topological numbers of digital topology (Bertrand, Pattern Recognition Letters
// 15:1003, 1994; dissertation §3.3.2.1) for an object of 6-connected voxels in a background of
// 18-connected ones, and of 26-connected ones.
#pragma once

#include <cstdint>

namespace haustra {

/// The object voxels among a voxel's 26 neighbours: bit (dx+1) + 3 (dy+1) + 9 (dz+1) for the
/// neighbour at (dx, dy, dz), bit 13 (the voxel itself) ignored.
using Neighbourhood = std::uint32_t;

/// T₆₊(x, X): 6-connected components of the object in the geodesic neighbourhood N₆³(x, X).
///
/// Against an 18-connected background the order is 3, as Bertrand has it; the dissertation prints
/// his T₆ of order 2, which goes with a 26-connected background. They differ where five voxels
/// around a corner lead from one face of x to another: order 2 would refuse x there, although
/// adding it changes nothing for an 18-connected background.
int topologicalNumber6(Neighbourhood object);
/// T₁₈(x, X̄): 18-connected components of the background in N₁₈²(x, X̄).
int topologicalNumber18(Neighbourhood object);
/// Both are 1: adding x to the object, or taking it away, changes no topology. Bit-parallel, some
/// tens of nanoseconds; any thread.
bool isSimple(Neighbourhood object);

/// T₆(x, X), which goes with a 26-connected background: 6-connected components in N₆²(x, X).
int topologicalNumber6Of26(Neighbourhood object);
/// T₂₆(x, X̄): 26-connected components of the background in N₂₆¹(x, X̄).
int topologicalNumber26(Neighbourhood object);
/// All four are 1: no topology changes whether corners join the background (the (6, 26) pair) or
/// not (the (6, 18) pair).
bool isSimpleEitherWay(Neighbourhood object);

}  // namespace haustra
