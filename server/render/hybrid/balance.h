// How the hybrid raycaster shares its work between CPU and GPU (dissertation §5.3.4).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace haustra::render {

/// The four controls, as the dissertation numbers them: how much of the way through empty space the
/// CPU walks for the GPU, and how long it follows the rays.
struct HybridControls {
    /// 1: the level of the octree at which a ray begins (l_min): at the first node of this level
    /// that is not empty.
    int entryLevel = 1;
    /// 2: from there the ray goes on to the first sample that may be visible.
    bool toBoundary = false;
    /// 3: likewise from behind, where the ray leaves the volume; −1: it ends there.
    int exitLevel = -1;
    /// 4: a tile is followed no longer when fewer of its quads than this share go on: their rays
    /// are left to the filling of holes, where each goes to its own end without the CPU. (In the
    /// dissertation, which had no loops in fragment programs that end by themselves, that meant
    /// work for the CPU; here it means less.)
    double leftToFilling = 0.25;
    bool operator==(const HybridControls&) const = default;
};

/// From the least work for the CPU to the most. Each rung does a little more of one control.
inline constexpr std::array<HybridControls, 9> hybridLadder = {{
    {4, false, -1, 1.01},
    {3, false, -1, 0.75},
    {2, false, -1, 0.5},
    {1, false, -1, 0.25},
    {0, false, -1, 0.125},
    {0, false, 2, 0.125},
    {0, false, 1, 0.0625},
    {0, false, 0, 0.0},
    {0, true, 0, 0.0},
}};

/// Which rung to stand on, by what pictures cost. It begins on the lowest, which costs about what a
/// single pass does, and stands at home on the best that it knows. Now and then another rung is
/// asked: its pictures are drawn in turns with home's, so that a view or a machine that changes
/// meanwhile changes both, and the medians of up to `mostPairs` of each decide. One that is faster
/// by `gain` is home from then on. No slope is followed from rung to rung: costs need not rise and
/// fall but once along the ladder, and where the GPU is the CPU's own cores they do not.
///
/// Whom it asks: those never asked, first towards where the longer of the CPU's and the GPU's times
/// says (the dissertation equalises the two; here they only give the direction); then whoever was
/// not asked for the longest, where the waiting of those that were slow counts less, down to a
/// quarter; but that of the lowest rung and of home's neighbours counts whole. What asking loses
/// against home is bounded: `share` of a picture for each picture, of which up to `mostCredit` may
/// be saved, and at most one asking beyond.
///
/// Where home's times have changed by `stirring` in proportion to each other, what is known of the
/// other rungs is doubted, and the lowest is asked first. Belongs to one thread.
class HybridBalance {
public:
    /// Pairs of a guest's and home's pictures: from the third on, a guest that is slower by
    /// median / median > `worse` is dismissed; from the fifth on, one whose slowest is faster than
    /// home's fastest wins; the seventh decides. A first picture that takes `hopeless` times home's
    /// is enough.
    static constexpr int mostPairs = 7, pairsToWin = 5, pairsToLose = 3;
    static constexpr double gain = 0.03, hopeless = 2.0, worse = 1.1;
    static constexpr double share = 1.0 / 32.0, mostCredit = 8.0;  ///< in pictures of home's
    static constexpr double tolerance = 1.25;  ///< over it the CPU's time is the longer
    static constexpr double stirring = 1.6;
    /// Home's pictures from asking to asking, once all were asked: ever more, until another wins.
    static constexpr int shortestRest = 8, longestRest = 32;

    /// For the next picture.
    int rung() const { return guestsTurn_ ? guest_ : home_; }
    const HybridControls& controls() const { return hybridLadder[std::size_t(rung())]; }
    /// The rung that it holds for the best.
    int home() const { return home_; }
    /// Of a picture that was drawn with controls(): the CPU's part, the GPU's, and what it took in
    /// all, which is to become least.
    void drew(double cpuMs, double gpuMs, double pictureMs);
    /// The next picture shows something else: the last ones' times are no measure for it.
    void elsewhere();

private:
    static constexpr int rungs = int(hybridLadder.size());
    struct Asked {
        bool ever = false;
        long at = 0;          // in pictures_
        double excess = 0.0;  // over home's time, in proportion to it
    };
    /// The last few values.
    class Few {
    public:
        void add(double value);
        void clear() { values_.clear(); }
        int count() const { return int(values_.size()); }
        double median() const;
        double least() const { return *std::min_element(values_.begin(), values_.end()); }
        double most() const { return *std::max_element(values_.begin(), values_.end()); }

    private:
        std::vector<double> values_;
    };
    void drewHome(double cpuMs, double gpuMs, double pictureMs);
    void drewGuest(double pictureMs);
    void doubt();
    int nextGuest() const;
    void judge();
    void endAsking(bool won, double ratio);

    int home_ = 0, guest_ = -1;
    bool guestsTurn_ = false;
    Few homeMs_, guestMs_, cpuPerGpu_;
    std::array<Asked, rungs> asked_{};
    long pictures_ = 0, doubtedAt_ = 0;
    int rest_ = 0, nextRest_ = shortestRest;
    double credit_ = mostCredit;
    double knownCpuPerGpu_ = 0.0;  // 0: not yet
};

}  // namespace haustra::render
