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
    /// 4: a tile is followed no longer when fewer of its quads than this costPerPicture go on:
    /// their rays are left to the filling of holes, where each goes to its own end without the CPU.
    /// (In the dissertation, which had no loops in fragment programs that end by themselves, that
    /// meant work for the CPU; here it means less.)
    double leftToFilling = 0.25;
    bool operator==(const HybridControls&) const = default;
};

/// Ways to split the work, from the least for the CPU to the most: each gives it a little more by
/// one control.
inline constexpr std::array<HybridControls, 9> hybridSplits = {{
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

/// Finds the split that draws a picture fastest, by trials while pictures are drawn.
///
/// It begins with split 0, which costs about what a single pass does, and draws with the best one
/// known so far. Now and then another split is the candidate: its pictures alternate with those of
/// the best one, so that a view or a machine that changes meanwhile changes both, and the medians
/// of up to `mostPairs` pictures of each are compared. A candidate that is faster by `gain` becomes
/// the best. There is no descent from split to split: the time need not have one minimum only, and
/// where the GPU is the CPU's own cores it has several.
///
/// The next candidate: splits that were never tried, first towards where the longer of the CPU's
/// and the GPU's times says (the dissertation equalises the two; here they only give the
/// direction); then the one whose last trial was the longest ago. That time counts less, down to a
/// quarter, for splits that were slow, but in full for split 0 and the neighbours of the best. What
/// trials cost is bounded: a budget, in pictures of the best split, grows by `costPerPicture` with
/// each picture up to `mostCredit`; a trial begins only while it is positive.
///
/// Where the ratio of the CPU's to the GPU's time has changed by the factor `mostChange`, earlier
/// trials say little: split 0 is tried next, and all slow ones are as good as any. Belongs to one
/// thread.
class HybridBalance {
public:
    /// A trial compares pairs of pictures, one of the candidate's and one of the best split's. From
    /// the third pair on, a candidate with a ratio of medians over `worse` loses; from the fifth
    /// on, one whose slowest picture is faster than the best split's fastest wins; the seventh
    /// decides. A first picture that takes `hopeless` times as long loses at once.
    static constexpr int mostPairs = 7, pairsToWin = 5, pairsToLose = 3;
    static constexpr double gain = 0.03, hopeless = 2.0, worse = 1.1;
    static constexpr double costPerPicture = 1.0 / 32.0,
                            mostCredit = 8.0;  ///< in pictures of the best
    static constexpr double tolerance = 1.25;  ///< over it the CPU's time is the longer
    static constexpr double mostChange = 1.6;
    /// Pictures of the best split between trials, once all were tried: ever more, until another
    /// wins.
    static constexpr int shortestPause = 8, longestPause = 32;

    /// For the next picture.
    int split() const { return candidatesTurn_ ? candidate_ : best_; }
    const HybridControls& controls() const { return hybridSplits[std::size_t(split())]; }
    /// The fastest split known.
    int best() const { return best_; }
    /// Of a picture that was drawn with controls(): the CPU's part, the GPU's, and what it took in
    /// all, which is to become least.
    void drew(double cpuMs, double gpuMs, double pictureMs);
    /// The next picture shows something else: the last ones' times are no measure for it.
    void elsewhere();

private:
    static constexpr int splits = int(hybridSplits.size());
    struct Trial {
        bool ever = false;
        long at = 0;          // in pictures_
        double excess = 0.0;  // of its time over the best's, in proportion to it
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
    void drewBest(double cpuMs, double gpuMs, double pictureMs);
    void drewCandidate(double pictureMs);
    void distrustTrials();
    int nextCandidate() const;
    void judge();
    void endTrial(bool won, double ratio);

    int best_ = 0, candidate_ = -1;
    bool candidatesTurn_ = false;
    Few bestMs_, candidateMs_, cpuPerGpu_;
    std::array<Trial, splits> trials_{};
    long pictures_ = 0, distrustedAt_ = 0;
    int pause_ = 0, nextPause_ = shortestPause;
    double credit_ = mostCredit;
    double knownCpuPerGpu_ = 0.0;  // 0: not yet
};

}  // namespace haustra::render
