#include "topology/ball_growth.h"

#include "topology/simple_point.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::topology {
namespace {

constexpr std::array<glm::ivec3, 6> faceSteps{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

/// A voxel that waits to be added, in one word: coordinates are below 2¹³ (checkGrid).
class PackedVoxel {
public:
    explicit PackedVoxel(glm::ivec3 v)
        : bits_(std::uint64_t(v.x) | std::uint64_t(v.y) << 13 | std::uint64_t(v.z) << 26) {}
    glm::ivec3 voxel() const {
        return {int(bits_ & 8191u), int(bits_ >> 13 & 8191u), int(bits_ >> 26)};
    }

private:
    std::uint64_t bits_;
};

struct Waiting {
    float priority;
    std::uint32_t turn;  ///< when it joined the queue
    PackedVoxel voxel;
    /// Comes after `other`: std::push_heap keeps the greatest in front.
    bool operator<(const Waiting& other) const {
        return priority != other.priority ? priority < other.priority : turn > other.turn;
    }
};

/// The greatest priority first, of equals the first to join. Priorities fall into buckets of a
/// quarter of a voxel, each a heap of its own: small heaps stay in the cache.
class GrowthQueue {
public:
    void push(float priority, PackedVoxel voxel) {
        const auto bucket = std::size_t(std::clamp(priority * 4.0f, 0.0f, 4095.0f));
        if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
        top_ = std::max(top_, bucket);
        buckets_[bucket].push_back({priority, turn_++, voxel});
        std::push_heap(buckets_[bucket].begin(), buckets_[bucket].end());
    }
    bool empty() {
        while (top_ > 0 && buckets_[top_].empty())
            --top_;
        return buckets_.empty() || buckets_[top_].empty();
    }
    /// Of a queue that is not empty.
    Waiting pop() {
        std::vector<Waiting>& bucket = buckets_[top_];
        std::pop_heap(bucket.begin(), bucket.end());
        const Waiting first = bucket.back();
        bucket.pop_back();
        return first;
    }

private:
    std::vector<std::vector<Waiting>> buckets_;
    std::size_t top_ = 0;
    std::uint32_t turn_ = 0;
};

class BallGrowth {
public:
    BallGrowth(const BitMask& domain, const Volume<float>& distanceMm,
               const BallGrowthOptions& options)
        : options_(options),
          distanceMm_(distanceMm),
          domain_(domain),
          untouched_(domain),
          ball_(domain.size()) {
        const glm::dvec3 spacing = distanceMm.grid().spacingMm();
        perMm_ = float(1.0 / std::min({spacing.x, spacing.y, spacing.z}));
    }

    BitMask grow(const std::vector<glm::ivec3>& path) && {
        add(path.front());
        for (const glm::ivec3 v : path) {
            if (!ball_.test(v) && domain_.test(v) && isSimple(ball_.around(v))) add(v);
        }
        do {
            runQueue();
            takeLeftovers();
        } while (!queue_.empty());
        return std::move(ball_);
    }

private:
    float priorityOf(glm::ivec3 v) const { return std::min(distanceMm_.at(v), 1e6f) * perMm_; }

    void add(glm::ivec3 v) {
        ball_.set(v);
        untouched_.reset(v);
        for (const glm::ivec3 step : faceSteps) {
            const glm::ivec3 next = v + step;
            if (!untouched_.test(next)) continue;
            untouched_.reset(next);
            queue_.push(priorityOf(next), PackedVoxel(next));
        }
    }

    void runQueue() {
        const std::size_t all = options_.progress ? domain_.count() : 0;
        std::size_t done = 0;
        while (!queue_.empty()) {
            const Waiting first = queue_.pop();
            const glm::ivec3 v = first.voxel.voxel();
            if (ball_.test(v)) continue;  // the path has been here
            if (isSimple(ball_.around(v))) {
                add(v);
                if (options_.progress && ++done % 65536 == 0)
                    options_.progress(std::min(1.0, double(done) / double(all)));
                continue;
            }
            const float again = first.priority - float(options_.priorityStep);
            if (again > float(options_.priorityThreshold))
                queue_.push(again, first.voxel);
            else
                leftovers_.push_back(v);
        }
    }

    /// Adds what has become simple, the deepest first, over and over until nothing is.
    void takeLeftovers() {
        std::stable_sort(leftovers_.begin(), leftovers_.end(),
                         [&](glm::ivec3 a, glm::ivec3 b) { return priorityOf(a) > priorityOf(b); });
        for (bool any = true; any;) {
            any = false;
            std::erase_if(leftovers_, [&](glm::ivec3 v) {
                if (!isSimple(ball_.around(v))) return false;
                add(v);
                return any = true;
            });
        }
    }

    const BallGrowthOptions& options_;
    const Volume<float>& distanceMm_;
    const BitMask& domain_;
    BitMask untouched_;  // of the domain, what has not been in the queue
    BitMask ball_;
    GrowthQueue queue_;
    std::vector<glm::ivec3> leftovers_;
    float perMm_ = 1.0f;
};

}  // namespace

BitMask growBall(const BitMask& domain, const Volume<float>& distanceMm,
                 const std::vector<glm::ivec3>& path, const BallGrowthOptions& options) {
    return BallGrowth(domain, distanceMm, options).grow(path);
}

}  // namespace haustra::topology
