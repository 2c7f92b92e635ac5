// CGAL's parameterizers of a disc, for comparison.
#pragma once

#include "core/tri_mesh.h"

#include <string>
#include <vector>

namespace haustra::bench {

struct DiscMap {
    std::string failure;           ///< empty where there is a map
    std::vector<glm::dvec2> flat;  ///< per vertex
};

enum class CgalMethod {
    leastSquaresConformal,  ///< free border
    asRigidAsPossible,      ///< free border
    discreteConformal,      ///< to a square with `corners`
};

/// `corners` are four border vertices, in order along it.
DiscMap cgalMap(const TriMesh& disc, CgalMethod method, const int corners[4]);

}  // namespace haustra::bench
