// The surface that is simplified, and the regions of space in which that is done at once.
#pragma once

#include "simplification/bound.h"
#include "simplification/mesh.h"
#include "simplification/quadric.h"

#include <cstdint>
#include <vector>

namespace haustra::simplification {

/// simplify() takes no vertex farther from the origin along any axis.
inline constexpr double farthestMm = 1e6;

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

/// What all regions share.
struct Simplification {
    CornerMesh mesh;
    ErrorBound bound;
    std::vector<Quadric> quadric;     ///< of a vertex: the input's planes that it stands for
    std::vector<char> settled;        ///< of a vertex: nothing more to gain at it
    std::vector<int> numberInRegion;  ///< of a vertex, in the region that holds it
    std::vector<int> slotInRegion;    ///< of a triangle with all its vertices in one region
    double minAngleDegrees;
};

/// A copy of the surface in a region's box with numbers of its own, small enough to stay in a
/// core's cache and free to be thrown away. The box's vertices come first, then those outside of
/// the triangles that reach out of it. Walks around a vertex are open to the movable alone: only
/// their triangles know all their neighbours (`opposite` is −1 across edges that reach out).
class RegionPart {
    const Region& region_;
    std::vector<int> innerSlots_;  ///< the triangles' slots in the whole; −1 where they reach out

    /// Whether the edge that faces the corner has both its ends in the box.
    bool facesInside(int corner) const;

public:
    /// Several may be made at once, and written to, for different regions of one partition.
    RegionPart(Simplification& whole, const Region& region);

    /// Puts what was made of it in its place.
    void writeTo(Simplification& whole) const;

    const Box& box() const { return region_.box; }
    /// The vertices in the box are numbered 0 … insideCount() − 1, in the whole's order.
    int insideCount() const { return int(region_.vertices.size()); }

    CornerMesh mesh;
    AttachedSamples samples;
    std::vector<Quadric> quadric;
    std::vector<std::uint32_t> version;  ///< of a vertex: counts its changes
    std::vector<char> settled;           ///< of a vertex: nothing more to gain at it
    std::vector<char> disturbed;         ///< of a vertex: a triangle at it changed recently
    std::vector<char> movable;           ///< of a vertex: all its triangles lie in the box
    std::vector<char> changed;           ///< of a triangle
};

}  // namespace haustra::simplification
