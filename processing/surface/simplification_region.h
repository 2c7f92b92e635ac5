// Simplification inside one box of space.
#pragma once

#include "surface/simplification_bound.h"
#include "surface/simplification_mesh.h"
#include "surface/simplification_quadric.h"
#include "surface/simplification_regions.h"
#include "surface/triangle_grid.h"
#include "surface/triangle_separation.h"

#include <array>
#include <cstdint>
#include <vector>

namespace haustra::surface {

/// What all regions share; each changes only what lies inside its box.
struct Simplification {
    CornerMesh mesh;
    ErrorBound bound;
    std::vector<Quadric> quadric;        ///< of a vertex: the input's planes that it stands for
    std::vector<std::uint32_t> version;  ///< of a vertex: counts its changes
    std::vector<char> settled;           ///< of a vertex: nothing more to gain at it
    std::vector<char> stirred;           ///< of a vertex: a triangle at it changed of late
    std::vector<char> movable;           ///< of a vertex: all its triangles lie in its region's box
    double minAngleDegrees;
};

/// A patch of triangles and what shall take its place.
struct Replacement {
    std::vector<int> oldTriangles;
    std::vector<int> slots;                   ///< of the new triangles: one each of the old
    std::vector<std::array<int, 3>> corners;  ///< of the new triangles
    int moved = -1;                           ///< the vertex that moves to `place`
    glm::dvec3 place{0.0};
};

/// Collapses edges in the order of their quadric error and then betters the sharpest corners, both
/// among the vertices whose triangles all lie in the region's box. Of one thread; several may run
/// at once on different regions of one partition.
class RegionSimplification {
public:
    RegionSimplification(Simplification& shared, const Region& region);
    void run();

private:
    struct Candidate {
        float error;
        int a, b;  ///< a < b
        std::uint32_t version;
        bool operator<(const Candidate& other) const {
            // std::push_heap keeps the greatest on top; the least error is wanted there.
            if (error != other.error) return error > other.error;
            return a != other.a ? a > other.a : b > other.b;
        }
    };

    enum class Quality { noSharper, better };

    bool inBox(const glm::dvec3& p) const;
    bool starInBox(int v) const;
    bool movable(int v) const { return mesh_.cornerOf[v] >= 0 && shared_.movable[v]; }
    const glm::dvec3& place(const Replacement& replacement, int v) const {
        return v == replacement.moved ? replacement.place : mesh_.position[v];
    }
    FloatBox boxOf(int triangle) const;

    void collapseEdges();
    void push(int a, int b);
    void pushEdgesAround(int v);
    bool collapseEdge(int a, int b, const glm::dvec3& place, Quality quality);
    bool linkCondition(int a, int b, int cornerAtA) const;

    void betterCorners();
    void betterVertex(int v);
    bool relax(int v);
    bool flip(int corner);
    double sharpestAround(int v) const;

    bool permitted(const Replacement& replacement, Quality quality);
    bool shapesPermitted(const Replacement& replacement, Quality quality) const;
    bool withinBound(const Replacement& replacement);
    bool meetsSurface(const Replacement& replacement);
    bool meets(const Replacement& replacement, std::size_t newTriangle,
               const std::array<int, 3>& other) const;
    void removeFromGrid(const Replacement& replacement);
    void commit(const Replacement& replacement);

    Simplification& shared_;
    CornerMesh& mesh_;
    const Region& region_;
    TriangleGrid grid_;
    std::vector<Candidate> heap_;
    ErrorBound::Patch patch_;
    Replacement replacement_;
    std::vector<FloatBox> newBoxes_;
    std::vector<SeparatingPlanes> newPlanes_;
    double sharpestCosine_;
};

}  // namespace haustra::surface
