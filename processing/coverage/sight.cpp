#include "coverage/sight.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <thread>

namespace haustra::coverage {
namespace {

constexpr std::int32_t leafTriangles = 32;
/// How far, in radians, a ray may pass a triangle's edge by and yet meet it in floats.
constexpr float edgeRadians = 1e-5f;
constexpr float roundingMm = 0.01f;

/// The directions from an eye that lie in a triangle which faces it: n·d ≥ 0 for three planes
/// through the eye and an edge each.
struct Outline {
    explicit Outline(const std::array<glm::vec3, 3>& c)
        : planes{glm::cross(c[0], c[1] - c[0]), glm::cross(c[1], c[2] - c[1]),
                 glm::cross(c[2], c[0] - c[2])} {
        for (int n = 0; n < 3; ++n)
            edges[n] = edgeRadians * glm::length(planes[n]);
    }
    /// 1 within, 0 on an edge as far as floats tell, −1 outside.
    int holds(glm::vec3 d) const {
        const float a = glm::dot(planes[0], d), b = glm::dot(planes[1], d),
                    c = glm::dot(planes[2], d);
        if (a < -edges[0] || b < -edges[1] || c < -edges[2]) return -1;
        return a >= edges[0] && b >= edges[1] && c >= edges[2];
    }
    glm::vec3 planes[3];
    float edges[3];
};

std::array<glm::vec3, 3> cornersFrom(const WallRays::Facet& facet, const Pose& pose) {
    return {pose.toCamera(facet.corners[0] - pose.eye), pose.toCamera(facet.corners[1] - pose.eye),
            pose.toCamera(facet.corners[2] - pose.eye)};
}

/// The triangle that a pixel shows, −1: none; what is out of focus counts as another's.
int pixelShows(const WallRays& rays, const Eyepiece& eyepiece, const Pose& pose,
               std::size_t pixel) {
    const auto hit = rays.firstMet(pose.eye, pose.toWorld(eyepiece.directions()[pixel]), 0.0f,
                                   eyepiece.farthestMm());
    if (hit.triangle < 0 || hit.distanceMm < eyepiece.nearestMm() ||
        !rays.faces(std::size_t(hit.triangle), pose.eye))
        return -1;
    return hit.triangle;
}

/// Of a triangle that faces the camera: what the picture shows of it, `shows` telling which
/// triangle a pixel sees.
template <class Shows>
Visibility visibilityOf(const WallRays::Facet& facet, int triangle, const Eyepiece& eyepiece,
                        const Pose& pose, bool tellFully, const Shows& shows) {
    const auto corners = cornersFrom(facet, pose);
    const PixelBox box = eyepiece.boxOf(corners);
    const Outline outline(corners);
    const glm::vec3* directions = eyepiece.directions().data();
    int total = 0, observed = 0;
    for (int y = box.low.y; y <= box.high.y; ++y) {
        const std::size_t row = std::size_t(y) * std::size_t(eyepiece.size().x);
        for (int x = box.low.x; x <= box.high.x; ++x) {
            const std::size_t pixel = row + std::size_t(x);
            const glm::vec3 direction = directions[pixel];
            if (direction == glm::vec3(0.0f)) continue;
            const int held = outline.holds(direction);
            if (held < 0) continue;
            const bool sees = shows(pixel) == triangle;
            observed += sees;
            // On an edge either neighbour may be met: the pixel counts where this one is.
            total += held > 0 || sees;
            if (sees && !tellFully) return Visibility::partly;
        }
    }
    if (observed == 0) return Visibility::unseen;
    return observed == total ? Visibility::fully : Visibility::partly;
}

/// 0 … count − 1, far apart first: by the reversed bits of each number. What is seen at all is soon
/// seen, and then costs no rays in the pictures between.
std::vector<std::size_t> coarseToFine(std::size_t count) {
    std::vector<std::size_t> order;
    int bits = 0;
    while ((std::size_t(1) << bits) < count)
        ++bits;
    for (std::size_t n = 0; n < std::size_t(1) << bits; ++n) {
        std::size_t reversed = 0;
        for (int bit = 0; bit < bits; ++bit)
            reversed |= (n >> bit & 1) << (bits - 1 - bit);
        if (reversed < count) order.push_back(reversed);
    }
    return order;
}

/// What all threads know of the wall while they go from picture to picture. Who leaves out what
/// another has found to be seen changes nothing: what is seen only grows.
class Known {
public:
    Known(const SightTree& tree, std::vector<Visibility> seen, bool tellFully)
        : tree_(tree),
          seen_(std::move(seen)),
          enough_(tellFully ? Visibility::fully : Visibility::partly),
          left_(tree.nodes().size(), 0) {
        const auto& nodes = tree.nodes();
        for (std::size_t n = nodes.size(); n-- > 0;) {
            if (!nodes[n].leaf) {  // its children have been counted
                left_[n] = left_[n + 1] + left_[std::size_t(nodes[n + 1].after)];
                continue;
            }
            for (std::int32_t t = nodes[n].first; t < nodes[n].first + nodes[n].count; ++t) {
                const auto triangle = std::size_t(tree.order()[std::size_t(t)]);
                left_[n] += seen_[triangle] < enough_ &&
                            tree.rays().facet(triangle).inward != glm::vec3(0.0f);
            }
        }
    }

    Visibility enough() const { return enough_; }
    bool isFinished(std::size_t node) {
        return std::atomic_ref(left_[node]).load(std::memory_order_relaxed) == 0;
    }
    Visibility of(std::int32_t triangle) {
        return std::atomic_ref(seen_[std::size_t(triangle)]).load(std::memory_order_relaxed);
    }
    /// Whether the triangle, by this, is finished.
    bool add(std::int32_t triangle, Visibility now) {
        std::atomic_ref known(seen_[std::size_t(triangle)]);
        Visibility before = known.load(std::memory_order_relaxed);
        while (before < now &&
               !known.compare_exchange_weak(before, now, std::memory_order_relaxed)) {
        }
        return before < now && now >= enough_;
    }
    /// Of a leaf so many triangles, and of all nodes that it is a part of.
    void finish(std::size_t leaf, int triangles) {
        for (std::size_t n = 0; n <= leaf;) {
            const SightTree::Node& part = tree_.nodes()[n];
            if (leaf >= std::size_t(part.after)) {
                n = std::size_t(part.after);
                continue;
            }
            std::atomic_ref(left_[n]).fetch_sub(triangles, std::memory_order_relaxed);
            ++n;
        }
    }
    std::vector<Visibility> takeSeen() { return std::move(seen_); }

private:
    const SightTree& tree_;
    std::vector<Visibility> seen_;
    Visibility enough_;
    std::vector<std::int32_t> left_;  // of each node: triangles that are not seen enough yet
};

/// One thread's way from picture to picture.
class Onlooker {
public:
    Onlooker(const SightTree& tree, const Eyepiece& eyepiece, Known& known)
        : tree_(tree),
          rays_(tree.rays()),
          eyepiece_(eyepiece),
          known_(known),
          castIn_(eyepiece.directions().size(), 0),
          shows_(eyepiece.directions().size()) {}

    void look(const CenterlineCamera& camera) {
        const Pose pose(camera, rays_.originMm());
        ++picture_;
        const auto& nodes = tree_.nodes();
        for (std::size_t n = 0; n < nodes.size();) {
            const SightTree::Node& node = nodes[n];
            const glm::vec3 fromEye = node.middle - pose.eye;
            const float distance = glm::length(fromEye);
            if (known_.isFinished(n) ||
                distance - node.radius > eyepiece_.farthestMm() + roundingMm ||
                distance + node.radius < eyepiece_.nearestMm() - roundingMm ||
                !eyepiece_.mayShow(pose.toCamera(fromEye), node.radius + roundingMm)) {
                n = std::size_t(node.after);
                continue;
            }
            if (node.leaf) lookAt(n, pose);
            ++n;
        }
    }

private:
    /// Some of the triangle may lie within the depth of field.
    bool inFocus(const WallRays::Facet& facet, glm::vec3 eye) const {
        float farthest = 0.0f, nearest = INFINITY, longest = 0.0f;
        for (int n = 0; n < 3; ++n) {
            const float distance = glm::distance(facet.corners[n], eye);
            farthest = std::max(farthest, distance), nearest = std::min(nearest, distance);
            longest =
                std::max(longest, glm::distance(facet.corners[n], facet.corners[(n + 1) % 3]));
        }
        return farthest >= eyepiece_.nearestMm() - roundingMm &&
               nearest - longest <= eyepiece_.farthestMm() + roundingMm;
    }

    void lookAt(std::size_t leaf, const Pose& pose) {
        const SightTree::Node& node = tree_.nodes()[leaf];
        const auto shows = [&](std::size_t pixel) {
            if (castIn_[pixel] != picture_) {
                castIn_[pixel] = picture_;
                shows_[pixel] = pixelShows(rays_, eyepiece_, pose, pixel);
            }
            return shows_[pixel];
        };
        int finished = 0;
        for (std::int32_t n = node.first; n < node.first + node.count; ++n) {
            const std::int32_t triangle = tree_.order()[std::size_t(n)];
            const WallRays::Facet& facet = rays_.facet(std::size_t(triangle));
            if (known_.of(triangle) >= known_.enough() ||
                !rays_.faces(std::size_t(triangle), pose.eye) || !inFocus(facet, pose.eye))
                continue;
            finished +=
                known_.add(triangle, visibilityOf(facet, triangle, eyepiece_, pose,
                                                  known_.enough() == Visibility::fully, shows));
        }
        if (finished > 0) known_.finish(leaf, finished);
    }

    const SightTree& tree_;
    const WallRays& rays_;
    const Eyepiece& eyepiece_;
    Known& known_;
    std::uint32_t picture_ = 0;
    std::vector<std::uint32_t>
        castIn_;  // of each pixel: the last picture in which its ray was cast
    std::vector<std::int32_t> shows_;
};

}  // namespace

SightTree::SightTree(std::shared_ptr<const WallRays> rays)
    : rays_(std::move(rays)), order_(rays_->triangles()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::vector<glm::vec3> middles;
    for (std::size_t n = 0; n < rays_->triangles(); ++n) {
        const auto& c = rays_->facet(n).corners;
        middles.push_back((c[0] + c[1] + c[2]) / 3.0f);
    }
    build(0, std::int32_t(order_.size()), middles);
}

void SightTree::build(std::int32_t first, std::int32_t count, std::span<const glm::vec3> middles) {
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    glm::vec3 low(INFINITY), high(-INFINITY);
    const auto begin = order_.begin() + first;
    for (auto t = begin; t != begin + count; ++t)
        for (const glm::vec3& corner : rays_->facet(std::size_t(*t)).corners)
            low = glm::min(low, corner), high = glm::max(high, corner);
    const glm::vec3 middle = 0.5f * (low + high), extent = high - low;
    float radius = 0.0f;
    for (auto t = begin; t != begin + count; ++t)
        for (const glm::vec3& corner : rays_->facet(std::size_t(*t)).corners)
            radius = std::max(radius, glm::distance(corner, middle));
    const bool leaf = count <= leafTriangles;
    nodes_[at] = {middle, radius, first, count, 0, leaf};
    if (!leaf) {
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                         : extent.y >= extent.z                       ? 1
                                                                      : 2;
        const std::int32_t half = count / 2;
        std::nth_element(begin, begin + half, begin + count, [&](std::int32_t a, std::int32_t b) {
            const float left = middles[std::size_t(a)][axis], right = middles[std::size_t(b)][axis];
            return left != right ? left < right : a < b;
        });
        build(first, half, middles);
        build(first + half, count - half, middles);
    }
    nodes_[at].after = std::int32_t(nodes_.size());
}

Result<void> look(const SightTree& tree, const Eyepiece& eyepiece,
                  std::span<const CenterlineCamera> cameras, std::vector<Visibility>& seen,
                  const SightOptions& options) {
    const std::vector<std::size_t> order = coarseToFine(cameras.size());
    Known known(tree, seen, options.tellFully);
    std::mutex mutex;
    std::vector<std::unique_ptr<Onlooker>> idle;
    std::atomic<std::size_t> done{0};
    std::atomic<bool> cancelled{false};
    const std::thread::id caller = std::this_thread::get_id();
    parallelFor(cameras.size(), 8, options.threads, [&](std::size_t begin, std::size_t end) {
        std::unique_ptr<Onlooker> onlooker;
        if (const std::lock_guard lock(mutex); !idle.empty()) {
            onlooker = std::move(idle.back());
            idle.pop_back();
        }
        if (!onlooker) onlooker = std::make_unique<Onlooker>(tree, eyepiece, known);
        for (std::size_t n = begin; n < end && !cancelled; ++n) {
            if (options.cancelled && options.cancelled()) {
                cancelled = true;
                break;
            }
            onlooker->look(cameras[order[n]]);
            const std::size_t count = ++done;
            if (options.progress && std::this_thread::get_id() == caller)
                options.progress(double(count) / double(cameras.size()));
        }
        const std::lock_guard lock(mutex);
        idle.push_back(std::move(onlooker));
    });
    if (cancelled) return fail(ErrorKind::wrongState, "interrupted");
    seen = known.takeSeen();
    return {};
}

void lookByEveryRay(const WallRays& rays, const Eyepiece& eyepiece,
                    std::span<const CenterlineCamera> cameras, std::vector<Visibility>& seen,
                    bool tellFully) {
    std::vector<int> shows(eyepiece.directions().size());
    std::vector<std::int32_t> met;
    for (const CenterlineCamera& camera : cameras) {
        const Pose pose(camera, rays.originMm());
        met.clear();
        for (std::size_t pixel = 0; pixel < shows.size(); ++pixel) {
            const bool open = eyepiece.directions()[pixel] != glm::vec3(0.0f);
            shows[pixel] = open ? pixelShows(rays, eyepiece, pose, pixel) : -1;
            if (shows[pixel] >= 0) met.push_back(shows[pixel]);
        }
        std::sort(met.begin(), met.end());
        met.erase(std::unique(met.begin(), met.end()), met.end());
        for (const std::int32_t triangle : met) {
            Visibility now = Visibility::partly;
            if (tellFully)
                now = visibilityOf(rays.facet(std::size_t(triangle)), triangle, eyepiece, pose,
                                   true, [&](std::size_t pixel) { return shows[pixel]; });
            Visibility& known = seen[std::size_t(triangle)];
            known = std::max(known, now);
        }
    }
}

std::vector<std::int32_t> trianglesSeen(const WallRays& rays, const Eyepiece& eyepiece,
                                        const CenterlineCamera& camera) {
    constexpr int packet = 16;
    const Pose pose(camera, rays.originMm());
    std::vector<std::int32_t> seen;
    // Squares of 4 × 4 pixels: rays that go alike.
    glm::vec3 along[packet];
    WallRays::Hit hits[packet];
    const glm::ivec2 size = eyepiece.size();
    for (int top = 0; top < size.y; top += 4) {
        for (int left = 0; left < size.x; left += 4) {
            int count = 0;
            for (int y = top; y < std::min(top + 4, size.y); ++y) {
                for (int x = left; x < std::min(left + 4, size.x); ++x) {
                    const glm::vec3 direction =
                        eyepiece
                            .directions()[std::size_t(y) * std::size_t(size.x) + std::size_t(x)];
                    if (direction != glm::vec3(0.0f)) along[count++] = pose.toWorld(direction);
                }
            }
            if (count == 0) continue;
            rays.firstMet16(pose.eye, along, count, 0.0f, eyepiece.farthestMm(), hits);
            for (int n = 0; n < count; ++n)
                if (hits[n].triangle >= 0 && hits[n].distanceMm >= eyepiece.nearestMm() &&
                    rays.faces(std::size_t(hits[n].triangle), pose.eye))
                    seen.push_back(hits[n].triangle);
        }
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    return seen;
}

}  // namespace haustra::coverage
