// How the hybrid raycaster shares its work between CPU and GPU (dissertation §5.3.4).
#pragma once

#include <array>
#include <cstddef>

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

/// Which rung to stand on, by what pictures have cost on average over `patience` of them. Where the
/// CPU takes more than `tolerance` times as long as the GPU, the next pictures stand one rung
/// lower; where the GPU does, one higher; where neither does, one lower for a trial: there is less
/// work in all. A step that has made pictures faster by `gain` is followed by another in its
/// direction; one that has not is taken back, and there the balance stays until the two times have
/// changed by `stirring` in proportion to each other. (The dissertation compares the two times
/// alone. Where the GPU is the CPU's own cores, as with a software device, equal times are no
/// optimum: there the picture's time leads to the rung with the least work in all.) Belongs to one
/// thread.
class HybridBalance {
public:
    static constexpr int patience = 4;
    static constexpr double tolerance = 1.25, gain = 0.02, stirring = 1.6;

    explicit HybridBalance(int rung = 3) : rung_(rung) {}

    int rung() const { return rung_; }
    const HybridControls& controls() const { return hybridLadder[std::size_t(rung_)]; }
    /// Of a picture that was drawn with controls(): the CPU's part, the GPU's, and from its
    /// beginning to its end.
    void drew(double cpuMs, double gpuMs, double pictureMs);

private:
    struct Seen {
        double cpuMs = 0.0, gpuMs = 0.0, pictureMs = 0.0;
        double ratio() const;
    };
    void step(int direction, const Seen& here);

    int rung_;
    int pictures_ = 0;  // on this rung
    Seen sum_;
    int cameFrom_ = -1;
    Seen there_;            // on the rung that it came from
    double settled_ = 0.0;  // the ratio at which it stays; 0: it does not
};

}  // namespace haustra::render
