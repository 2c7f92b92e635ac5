// The two-sided distance between what simplification began with and what it has.
#pragma once

#include "simplification/mesh.h"
#include "simplification/near.h"

#include <span>
#include <vector>

namespace haustra::simplification {

/// The input's surface, held by samples: its vertices, the midpoints of its edges and the centres
/// of its triangles. Each sample is attached to one triangle of the working mesh that is within the
/// bound of it; a patch of triangles may take the place of another only if the samples of the old
/// find such a triangle in the new, and the new patch's own samples lie within the bound of the
/// input's triangles.
class ErrorBound {
public:
    ErrorBound(const CornerMesh& input, double errorMm);

private:
    friend class AttachedSamples;

    enum class On : char { vertex, edge, triangle };

    bool nearTrianglesOf(int sample, const glm::vec3& p) const;
    bool nearInputTriangle(int triangle, const glm::vec3& p) const;

    float errorSquared_;
    std::vector<glm::vec3> inputPlace_;  ///< of the input's vertices
    std::vector<int> inputVertex_, inputOpposite_;
    std::vector<glm::vec3> place_;  ///< by the input's triangles, so that neighbours lie together
    std::vector<On> on_;
    std::vector<int> corner_;  ///< of a sample in the input: at the vertex, facing the edge, or any
    std::vector<int> first_;   ///< of a working triangle: its first sample, or −1
    std::vector<int> next_;    ///< of a sample: the next on the same working triangle, or −1
};

/// The samples attached to one region's triangles, copied for one thread to work on.
class AttachedSamples {
public:
    /// Room for one thread's questions.
    struct Patch {
        std::vector<int> samples;
        std::vector<int> ends;  ///< of the lists of samples that are being gathered
        PointArrays points;     ///< the samples' places
        std::vector<NearTriangle> triangles;
        std::vector<int> triangleOf;  ///< of each sample: its place in `triangles`
        std::vector<float> heightSquared;
    };

    /// Of the working triangles `slots`, here numbered in that order; those numbered −1 are left
    /// out.
    AttachedSamples(const ErrorBound& bound, std::span<const int> slots);

    /// Takes the samples attached to `oldTriangles` into the patch.
    void gather(std::span<const int> oldTriangles, Patch& patch) const;
    /// Whether `p` is within the bound of an input triangle beside the patch's nearest sample.
    bool nearInput(const glm::vec3& p, const Patch& patch) const;
    /// Whether each of the patch's samples is within the bound of one of patch.triangles;
    /// finds which, triangleOf.
    bool findTriangles(Patch& patch) const;
    /// Attaches the patch's samples to the triangles `newTriangles` (parallel to patch.triangles).
    void reattach(std::span<const int> oldTriangles, std::span<const int> newTriangles,
                  const Patch& patch);
    /// Attaches the samples to the same triangles there, numbered by `slots` as at first.
    void writeTo(ErrorBound& bound, std::span<const int> slots) const;

private:
    struct Sample {
        glm::vec3 place;
        int next;  ///< on the same triangle, or −1
    };

    const ErrorBound& bound_;
    std::vector<Sample> sample_;
    std::vector<int> number_;  ///< of a sample in the bound
    std::vector<int> first_;   ///< of a triangle: its first sample, or −1
};

}  // namespace haustra::simplification
