// A hole with a smooth rim, cut through the triangles of a surface.
#pragma once

#include "flatten/tube/tip_function.h"

#include <optional>
#include <utility>
#include <vector>

namespace haustra::flatten {

/// What takes the place of the triangles around a hole. Vertices from the surface's count on are
/// new ones.
struct RimCut {
    std::vector<int> replaced;                      ///< triangles of the surface; the others stay
    std::vector<glm::ivec3> triangles;              ///< what is left of them
    std::vector<int> source;                        ///< per triangle: the one that it is a part of
    std::vector<std::pair<int, glm::dvec3>> moved;  ///< vertices, onto the rim
    std::vector<glm::dvec3> added;
    std::vector<int> rim;  ///< the rim's vertices, in order along it
    double rimLengthMm = 0.0;
    double removedMm2 = 0.0;
    double leastAngleDegrees = 0.0;  ///< of the triangles that were cut or have moved
};

/// Takes away what is below `level`. Corners within `snapShare` of an edge from the level line move
/// onto it along that edge; of the triangles, what the rim would pinch off goes with the hole.
/// Nothing where so much snapping breaks the surface: turns a triangle over, or leaves anything but
/// one rim. O(n) to find the place.
std::optional<RimCut> cutRim(const TriMesh& closed, const TipFunction& function, double level,
                             double snapShare);

}  // namespace haustra::flatten
