#include "segmentation/thin_walls.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace haustra::segmentation {
namespace {

/// A direction on the grid and how many steps stay within reach.
struct Ray {
    glm::ivec3 step;
    std::ptrdiff_t offset;
    int steps;
};

std::array<Ray, 13> raysOf(const Grid& grid, double reachMm) {
    std::array<Ray, 13> rays;
    std::size_t count = 0;
    for (int n = 14; n < 27; ++n) {
        const glm::ivec3 step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        const double lengthMm = glm::length(grid.spacingMm() * glm::dvec3(step));
        rays[count++] = {
            step,
            step.x + std::ptrdiff_t(grid.size.x) * (step.y + std::ptrdiff_t(grid.size.y) * step.z),
            std::max(1, int(reachMm / lengthMm))};
    }
    return rays;
}

/// HU smoothed by about `sdMm`, but by no more than (1 2 1)/4 along an axis: noise falls, while a
/// sheet, which is as wide as the point spread anyway, keeps most of its height.
Volume<std::int16_t> smoothed(const Volume<std::int16_t>& hu, double sdMm, int threads) {
    const Grid& grid = hu.grid();
    const glm::dvec3 share =
        glm::min(0.5 * sdMm * sdMm / (grid.spacingMm() * grid.spacingMm()), glm::dvec3(0.25));
    const glm::vec3 side(share), middle(1.0 - 2.0 * share);
    Volume<std::int16_t> out(grid);
    const auto written = out.writable();
    const std::size_t row = std::size_t(grid.size.x), slice = row * std::size_t(grid.size.y);
    parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t first, std::size_t last) {
        std::vector<float> across(slice), lines(row);
        for (std::size_t k = first; k < last; ++k) {
            const std::size_t below = k > 0 ? k - 1 : k,
                              above = std::min(k + 1, std::size_t(grid.size.z) - 1);
            const std::int16_t* a = &hu.voxels()[below * slice];
            const std::int16_t* b = &hu.voxels()[k * slice];
            const std::int16_t* c = &hu.voxels()[above * slice];
            for (std::size_t n = 0; n < slice; ++n)
                across[n] = side.z * float(a[n] + c[n]) + middle.z * float(b[n]);
            for (std::size_t j = 0; j < std::size_t(grid.size.y); ++j) {
                const float* up = &across[(j > 0 ? j - 1 : j) * row];
                const float* here = &across[j * row];
                const float* down = &across[std::min(j + 1, std::size_t(grid.size.y) - 1) * row];
                for (std::size_t i = 0; i < row; ++i)
                    lines[i] = side.y * (up[i] + down[i]) + middle.y * here[i];
                for (std::size_t i = 0; i < row; ++i) {
                    const float left = lines[i > 0 ? i - 1 : i],
                                right = lines[std::min(i + 1, row - 1)];
                    written[k * slice + j * row + i] =
                        std::int16_t(std::lround(side.x * (left + right) + middle.x * lines[i]));
                }
            }
        }
    });
    return out;
}

/// Noise of a content: the median of |v − (v₋ + v₊)/2| with neighbours four voxels off, all deep in
/// it. 0 where there is none.
double noiseSd(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& contents,
               Content content) {
    constexpr int away = 4;
    const Grid& grid = hu.grid();
    std::vector<std::size_t> histogram(2048, 0);
    std::size_t count = 0;
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j < grid.size.y; ++j) {
            const std::size_t row = grid.index(0, j, k);
            for (int i = 2 * away; i + 2 * away < grid.size.x; ++i) {
                const std::size_t n = row + std::size_t(i);
                bool deep = true;
                for (int d = -2 * away; d <= 2 * away && deep; d += 2)
                    deep = Content(contents[std::size_t(std::ptrdiff_t(n) + d)]) == content;
                if (!deep) continue;
                const int off = std::abs(int(hu[n]) - (int(hu[n - away]) + int(hu[n + away])) / 2);
                ++histogram[std::size_t(std::min(off, 2047))];
                ++count;
            }
        }
    }
    if (count < 200) return 0.0;
    std::size_t below = 0, median = 0;
    while (2 * (below += histogram[median]) < count)
        ++median;
    return (double(median) + 0.5) / 0.6745 / std::sqrt(1.5);
}

class Search {
public:
    Search(const Volume<std::int16_t>& hu, const BowelContents& contents,
           const ThinWallOptions& options)
        : hu_(hu),
          content_(contents.content),
          grid_(hu.grid()),
          rays_(raysOf(grid_, options.reachMm)) {
        const double gasSd = noiseSd(hu, contents.content, Content::gas);
        taggedSdsHu_ = options.leastSds * std::clamp(noiseSd(hu, contents.content, Content::tagged),
                                                     gasSd, 1.5 * gasSd);
        gasRiseHu_ = std::max(options.leastShare * (options.softHu - contents.gasHu),
                              options.leastSds * gasSd);
        softHu_ = options.softHu, share_ = options.leastShare;
        gasHu_ = contents.gasHu;
    }

    bool isWall(glm::ivec3 v) const {
        const std::size_t n = grid_.index(v);
        const Content content = Content(content_[n]);
        if (content == Content::tagged && touchesGas(v)) return true;
        if (content == Content::gas)
            return hu_[n] > gasHu_ + gasRiseHu_ &&
                   isSheet(v, n, content, 1, [&](int) { return gasRiseHu_; });
        if (content == Content::tagged) {
            return isStep(v, n) || isSheet(v, n, content, -1, [&](int sides) {
                       return std::max(share_ * (sides - softHu_), taggedSdsHu_);
                   });
        }
        return false;
    }

private:
    /// Fluid lies under gas at a level; where they touch elsewhere there is a wall between, or
    /// stool sticks to one.
    bool touchesGas(glm::ivec3 v) const {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int sign : {-1, 1}) {
                glm::ivec3 w = v;
                w[axis] += sign;
                if (grid_.contains(w) && Content(content_[grid_.index(w)]) == Content::gas)
                    return true;
            }
        }
        return false;
    }
    /// Whether the voxel lies between a bright fluid and a dim one, below half the bright one's
    /// height over soft tissue: two fluids so near each other have a wall between them, whose own
    /// HU does not show.
    bool isStep(glm::ivec3 v, std::size_t n) const {
        constexpr double half = 0.45;
        for (const Ray& ray : rays_) {
            std::array<int, 2> highest{-32768, -32768}, tagged{0, 0};
            for (int side = 0; side < 2; ++side) {
                const int direction = side == 0 ? 1 : -1;
                for (int step = 1; step <= ray.steps; ++step) {
                    const glm::ivec3 w = v + direction * step * ray.step;
                    if (!grid_.contains(w)) break;
                    const std::size_t m =
                        std::size_t(std::ptrdiff_t(n) + direction * step * ray.offset);
                    if (Content(content_[m]) != Content::tagged) break;
                    highest[std::size_t(side)] = std::max(highest[std::size_t(side)], int(hu_[m]));
                    ++tagged[std::size_t(side)];
                }
            }
            for (const int bright : {0, 1}) {
                if (tagged[std::size_t(bright)] == 0 || tagged[std::size_t(1 - bright)] < ray.steps)
                    continue;
                if (hu_[n] - softHu_ < half * (highest[std::size_t(bright)] - softHu_) &&
                    highest[std::size_t(1 - bright)] - softHu_ <
                        half * (highest[std::size_t(bright)] - softHu_))
                    return true;
            }
        }
        return false;
    }
    /// Whether HU (times `sign`) falls on both sides of the voxel, before the content ends, by what
    /// `leastHu` asks of the lesser side's HU.
    template <class Least>
    bool isSheet(glm::ivec3 v, std::size_t n, Content content, int sign,
                 const Least& leastHu) const {
        for (const Ray& ray : rays_) {
            std::array<int, 2> lowest{};
            bool both = true;
            for (int side = 0; side < 2 && both; ++side) {
                const int direction = side == 0 ? 1 : -1;
                int low = 1 << 20;
                for (int step = 1; step <= ray.steps; ++step) {
                    const glm::ivec3 w = v + direction * step * ray.step;
                    if (!grid_.contains(w)) break;
                    const std::size_t m =
                        std::size_t(std::ptrdiff_t(n) + direction * step * ray.offset);
                    if (Content(content_[m]) == content) low = std::min(low, sign * hu_[m]);
                }
                lowest[std::size_t(side)] = low;
                both = low < (1 << 20);
            }
            if (!both) continue;
            const int sides = std::max(lowest[0], lowest[1]);
            if (sign * hu_[n] - sides > leastHu(sign * sides)) return true;
        }
        return false;
    }

    const Volume<std::int16_t>& hu_;
    const Volume<std::uint8_t>& content_;
    const Grid grid_;
    const std::array<Ray, 13> rays_;
    double gasRiseHu_, taggedSdsHu_, softHu_, share_, gasHu_;
};

// Noise makes specks, walls are sheets.
void dropSpecks(Volume<std::uint8_t>& walls, std::size_t smallest) {
    constexpr std::uint8_t kept = 2;
    const Grid& grid = walls.grid();
    const auto out = walls.writable();
    std::vector<std::uint32_t> patch;
    for (std::size_t n = 0; n < out.size(); ++n) {
        if (out[n] != 1) continue;
        patch.assign(1, std::uint32_t(n));
        out[n] = kept;
        for (std::size_t head = 0; head < patch.size(); ++head) {
            const glm::ivec3 v = grid.voxelAt(patch[head]);
            for (int s = 0; s < 27; ++s) {
                const glm::ivec3 w = v + glm::ivec3(s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1);
                if (!grid.contains(w) || out[grid.index(w)] != 1) continue;
                out[grid.index(w)] = kept;
                patch.push_back(std::uint32_t(grid.index(w)));
            }
        }
        if (patch.size() >= smallest) continue;
        for (const std::uint32_t m : patch)
            out[m] = 0;
    }
    for (std::uint8_t& wall : out)
        wall = wall != 0;
}

}  // namespace

Volume<std::uint8_t> findThinWalls(const Volume<std::int16_t>& hu, const BowelContents& contents,
                                   const ThinWallOptions& options) {
    const Grid& grid = hu.grid();
    const Volume<std::int16_t> smooth = smoothed(hu, options.smoothingMm, options.threads);
    const Search search(smooth, contents, options);
    Volume<std::uint8_t> walls(grid);
    const auto out = walls.writable();
    parallelFor(std::size_t(grid.size.z), 1, options.threads,
                [&](std::size_t first, std::size_t last) {
                    for (std::size_t k = first; k < last; ++k) {
                        for (int j = 0; j < grid.size.y; ++j) {
                            for (int i = 0; i < grid.size.x; ++i)
                                out[grid.index(i, j, int(k))] = search.isWall({i, j, int(k)});
                        }
                    }
                });
    const double speckMm3 = options.speckMm2 * std::cbrt(grid.voxelVolumeMm3());
    dropSpecks(walls, std::size_t(std::ceil(speckMm3 / grid.voxelVolumeMm3())));
    return walls;
}

}  // namespace haustra::segmentation
