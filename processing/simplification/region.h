// Simplification inside one box of space.
#pragma once

#include "simplification/contact.h"
#include "simplification/part.h"

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::simplification {

/// Collapses edges in the order of their quadric error and then betters the sharpest corners, both
/// among the vertices whose triangles all lie in the region's box. Of one thread.
class RegionSimplification {
public:
    /// Contacts of the surface with itself are refused in the `guarded` boxes only.
    RegionSimplification(RegionPart& part, double minAngleDegrees,
                         std::span<const FloatBox> guarded);
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
    bool movable(int v) const { return part_.movable[v] && mesh_.cornerOf[v] >= 0; }
    const glm::dvec3& place(const Replacement& replacement, int v) const {
        return replacement.placeOf(mesh_, v);
    }

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
    void commit(const Replacement& replacement);

    RegionPart& part_;
    CornerMesh& mesh_;
    ContactGuard guard_;
    std::vector<Candidate> heap_;
    AttachedSamples::Patch patch_;
    Replacement replacement_;
    double sharpestCosine_;
};

}  // namespace haustra::simplification
