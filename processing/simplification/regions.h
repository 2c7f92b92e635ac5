// Boxes of space whose insides can be worked on at once.
#pragma once

#include "simplification/mesh.h"

#include <vector>

namespace haustra::simplification {

struct Box {
    glm::dvec3 low, high;
};

struct Region {
    Box box;                     ///< half open; boxes of one partition are disjoint
    std::vector<int> vertices;   ///< in the box, ascending
    std::vector<int> triangles;  ///< that touch the box, ascending; shared ones are never changed
};

/// Space in boxes of at most `vertexLimit` vertices each: cut in two along the longest side, again
/// and again, so that the share `share` of the vertices lies below each cut. O(n log n).
std::vector<Region> partition(const CornerMesh& mesh, std::size_t vertexLimit, double share);

}  // namespace haustra::simplification
