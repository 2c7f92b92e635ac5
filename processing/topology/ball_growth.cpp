#include "topology/ball_growth.h"

#include "core/simple_point.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace haustra::topology {
namespace {

static_assert(maxGridSide < 1 << 16);

// Priorities are whole ticks, finer than any two distances need be told apart.
constexpr double ticksPerVoxel = 1024.0;
constexpr int greatestPriority = 1 << 18;  // all that is 256 voxels deep is alike

constexpr std::array<glm::ivec3, 6> faceSteps{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

/// A voxel in one word: coordinates are below 2¹⁵ (maxGridSide).
class PackedVoxel {
public:
    explicit PackedVoxel(glm::ivec3 v)
        : bits_(std::uint64_t(v.x) | std::uint64_t(v.y) << 16 | std::uint64_t(v.z) << 32) {}
    glm::ivec3 voxel() const {
        return {int(bits_ & 0xffffu), int(bits_ >> 16 & 0xffffu), int(bits_ >> 32)};
    }

private:
    std::uint64_t bits_;
};

/// The greatest priority first, of equals the first to join. One list for each priority, and two
/// levels of bits that tell which of them hold something. A heap would miss the cache at each of
/// its steps, for most of a lumen's voxels lie at a few small distances.
class GrowthQueue {
public:
    bool empty() const { return waiting_ == 0; }

    void push(int priority, PackedVoxel voxel) {
        const auto at = std::size_t(std::max(priority, 0));
        if (at >= lists_.size()) {
            lists_.resize(at + 1);
            used_.resize(at / 64 + 1, 0);
            usedWords_.resize(at / 4096 + 1, 0);
        }
        lists_[at].voxels.push_back(voxel);
        used_[at / 64] |= bit(at);
        usedWords_[at / 4096] |= bit(at / 64);
        ++waiting_;
    }

    struct First {
        int priority;
        PackedVoxel voxel;
    };
    /// Of a queue that is not empty.
    First pop() {
        std::size_t word = usedWords_.size() - 1;
        while (usedWords_[word] == 0)
            --word;
        word = word * 64 + highestBit(usedWords_[word]);
        const std::size_t at = word * 64 + highestBit(used_[word]);
        List& list = lists_[at];
        const First first{int(at), list.voxels[list.next++]};
        if (list.next == list.voxels.size()) {
            list.voxels.clear();
            list.next = 0;
            used_[word] &= ~bit(at);
            if (used_[word] == 0) usedWords_[word / 64] &= ~bit(word);
        }
        --waiting_;
        return first;
    }

private:
    static std::uint64_t bit(std::size_t n) { return std::uint64_t(1) << (n % 64); }
    static std::size_t highestBit(std::uint64_t word) {
        return std::size_t(63 - std::countl_zero(word));
    }

    struct List {
        std::vector<PackedVoxel> voxels;
        std::size_t next = 0;
    };
    std::vector<List> lists_;
    std::vector<std::uint64_t> used_, usedWords_;
    std::size_t waiting_ = 0;
};

class BallGrowth {
public:
    BallGrowth(const BitMask& domain, const Volume<float>& distanceMm, const Progress& progress)
        : domain_(domain),
          distanceMm_(distanceMm),
          progress_(progress),
          step_(std::max(1, int(std::lround(priorityStep * ticksPerVoxel)))),
          threshold_(int(std::lround(priorityThreshold * ticksPerVoxel))),
          untouched_(domain),
          ball_(domain.size()) {
        const glm::dvec3 spacing = distanceMm.grid().spacingMm();
        ticksPerMm_ = float(ticksPerVoxel / std::min({spacing.x, spacing.y, spacing.z}));
    }

    BitMask grow(const std::vector<glm::ivec3>& path) && {
        add(path.front());
        for (const glm::ivec3 v : path) {
            if (!ball_.test(v) && domain_.test(v) && isSimpleEitherWay(ball_.around(v))) add(v);
        }
        do {
            runQueue();
            takeLeftovers();
        } while (!queue_.empty());
        return std::move(ball_);
    }

private:
    int priorityOf(glm::ivec3 v) const {
        return int(std::min(distanceMm_.at(v) * ticksPerMm_, float(greatestPriority)));
    }

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
        const std::size_t all = progress_ ? domain_.count() : 0;
        std::size_t added = 0;
        while (!queue_.empty()) {
            const GrowthQueue::First first = queue_.pop();
            const glm::ivec3 v = first.voxel.voxel();
            if (ball_.test(v)) continue;  // the path has been here
            if (isSimpleEitherWay(ball_.around(v))) {
                add(v);
                if (progress_ && ++added % 65536 == 0)
                    progress_(std::min(1.0, double(added) / double(all)));
            } else if (const int again = first.priority - step_; again > threshold_) {
                queue_.push(again, first.voxel);
            } else {
                leftovers_.push_back(v);
            }
        }
    }

    /// Adds what has become simple, the deepest first, over and over until nothing is.
    void takeLeftovers() {
        std::stable_sort(leftovers_.begin(), leftovers_.end(),
                         [&](glm::ivec3 a, glm::ivec3 b) { return priorityOf(a) > priorityOf(b); });
        const auto takeIfSimple = [&](glm::ivec3 v) {
            const bool simple = isSimpleEitherWay(ball_.around(v));
            if (simple) add(v);
            return simple;
        };
        while (std::erase_if(leftovers_, takeIfSimple) > 0) {
        }
    }

    const BitMask& domain_;
    const Volume<float>& distanceMm_;
    const Progress& progress_;
    int step_, threshold_;  // δ and T_th in ticks
    float ticksPerMm_ = 1.0f;
    BitMask untouched_;  // of the domain, what has not been in the queue
    BitMask ball_;
    GrowthQueue queue_;
    std::vector<glm::ivec3> leftovers_;
};

}  // namespace

BitMask growBall(const BitMask& domain, const Volume<float>& distanceMm,
                 const std::vector<glm::ivec3>& path, const Progress& progress) {
    return BallGrowth(domain, distanceMm, progress).grow(path);
}

}  // namespace haustra::topology
