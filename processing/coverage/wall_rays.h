// Rays against a wall's triangles (Embree).
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::coverage {

/// A wall with a tree of its triangles, in floats that count from originMm(). Immutable; any number
/// of threads. Equal walls give equal answers on one kind of processor.
class WallRays {
public:
    /// Triangles counter-clockwise seen from outside; indices in range. `bridged` (empty: none):
    /// not 0 for triangles that are no wall (core/bridges.h): they stop rays and are never seen.
    /// Fails (badInput) where there is no triangle or the sizes differ, (device) where there is not
    /// enough memory. O(n log n): some seconds and 300 MB for a million triangles.
    static Result<std::shared_ptr<const WallRays>> of(const TriMesh& wall,
                                                      std::vector<std::uint8_t> bridged = {});
    ~WallRays();
    WallRays(const WallRays&) = delete;
    WallRays& operator=(const WallRays&) = delete;

    std::size_t triangles() const { return facets_.size(); }
    glm::dvec3 originMm() const { return originMm_; }

    /// A triangle as rays meet it.
    struct Facet {
        glm::vec3 corners[3];
        glm::vec3 inward;  ///< into the lumen, as long as twice the area; zero: never seen
    };
    const Facet& facet(std::size_t triangle) const { return facets_[triangle]; }
    /// Whether a triangle shows its inner side to an eye, and is wall at all. What it decides is
    /// the same wherever it is asked, so that what it leaves out need not be looked for.
    bool faces(std::size_t triangle, glm::vec3 eye) const {
        const Facet& f = facets_[triangle];
        return glm::dot(f.inward, eye - f.corners[0]) > 0.0f;
    }

    struct Hit {
        int triangle = -1;  ///< −1: none
        float distanceMm = 0.0f;
    };
    /// The first triangle, from whichever side, that a ray meets between two distances, both
    /// included. `along` is unit. A pure function of the ray, to the bit. A third of a microsecond.
    Hit firstMet(glm::vec3 from, glm::vec3 along, float nearestMm, float farthestMm) const;
    /// Up to 16 rays at once, which is faster where they are much alike; of triangles that a ray
    /// meets at one distance to the last bit it may find another one than firstMet.
    void firstMet16(glm::vec3 from, const glm::vec3* along, int count, float nearestMm,
                    float farthestMm, Hit* hits) const;

private:
    struct Tree;
    WallRays();
    glm::dvec3 originMm_{0.0};
    std::vector<Facet> facets_;
    std::unique_ptr<Tree> tree_;
};

}  // namespace haustra::coverage
