// What pictures show of a wall, triangle by triangle (dissertation §2.3, §2.4): every pixel of
// every picture has its say, but few rays are cast.
#pragma once

#include "core/parallel.h"
#include "core/result.h"
#include "core/wall_visibility.h"
#include "coverage/eyepiece.h"
#include "coverage/wall_rays.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace haustra::coverage {

/// A wall's triangles in a tree of balls. Immutable; any number of threads.
class SightTree {
public:
    /// O(n log n), under a second and 50 MB for a million triangles.
    explicit SightTree(std::shared_ptr<const WallRays> rays);
    const WallRays& rays() const { return *rays_; }

    struct Node {
        glm::vec3 middle;
        float radius;
        std::int32_t first, count;  ///< its triangles in order()
        std::int32_t after;         ///< the node that follows its subtree
        bool leaf;
    };
    const std::vector<Node>& nodes() const { return nodes_; }  ///< children after their parent
    const std::vector<std::int32_t>& order() const { return order_; }

private:
    void build(std::int32_t first, std::int32_t count, std::span<const glm::vec3> middles);
    std::shared_ptr<const WallRays> rays_;
    std::vector<Node> nodes_;
    std::vector<std::int32_t> order_;
};

struct SightOptions {
    /// Tell partly seen triangles from fully seen ones; else all that are observed are partly seen
    /// ("at least partially displayed", §2.3), in less time.
    bool tellFully = false;
    int threads = 0;  ///< ≤ 0: all cores; no result depends on it
    Progress progress = {};
    std::function<bool()> cancelled = {};  ///< asked between pictures, from any thread
};

/// Adds to `seen`, one for each triangle, what pictures from these places show: a triangle is
/// observed where the ray of at least one pixel meets it before any other, within the eyepiece's
/// depth of field, from its inner side. Cameras' directions are finite and not parallel.
///
/// The result is that of casting every ray of every picture (lookByEveryRay), to the bit, whatever
/// the order and the number of threads: a ray is cast only where a pixel's direction lies within a
/// triangle that faces the camera and has not been seen enough yet, once a picture, and tells of
/// that triangle what it would among all rays. Pictures are taken far apart first, so that what can
/// be seen at all has been seen when most of them come.
///
/// Fails (wrongState) where it is cancelled; `seen` is then as it was.
Result<void> look(const SightTree& tree, const Eyepiece& eyepiece,
                  std::span<const CenterlineCamera> cameras, std::vector<Visibility>& seen,
                  const SightOptions& options = {});

/// The same by one ray for each pixel of each picture: what look() is held to. A picture of 200,000
/// pixels costs a tenth of a second.
void lookByEveryRay(const WallRays& rays, const Eyepiece& eyepiece,
                    std::span<const CenterlineCamera> cameras, std::vector<Visibility>& seen,
                    bool tellFully);

/// The triangles that one picture shows, ascending. Rays are cast 16 at once: of triangles that a
/// ray meets at the same distance to the last bit, the one may be here and the other in look().
std::vector<std::int32_t> trianglesSeen(const WallRays& rays, const Eyepiece& eyepiece,
                                        const CenterlineCamera& camera);

}  // namespace haustra::coverage
