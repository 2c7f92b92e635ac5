#include "segmentation/thin_walls.h"

#include "core/flood_fill.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <vector>

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
        const glm::ivec3 step = cornerStep(n);
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
/// Only in rows that hold gas or tagged material; 0 in others.
Volume<std::int16_t> smoothed(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& content,
                              double sdMm, int threads) {
    const Grid& grid = hu.grid();
    const glm::dvec3 share =
        glm::min(0.5 * sdMm * sdMm / (grid.spacingMm() * grid.spacingMm()), glm::dvec3(0.25));
    const glm::vec3 side(share), middle(1.0 - 2.0 * share);
    Volume<std::int16_t> out(grid, std::int16_t(0));
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
            float* const mixed = across.data();
            for (std::size_t n = 0; n < slice; ++n)
                mixed[n] = side.z * float(a[n] + c[n]) + middle.z * float(b[n]);
            for (std::size_t j = 0; j < std::size_t(grid.size.y); ++j) {
                const std::uint8_t* const contents = &content.voxels()[k * slice + j * row];
                if (std::none_of(contents, contents + row, [](std::uint8_t kind) {
                        return Content(kind) == Content::gas || Content(kind) == Content::tagged;
                    }))
                    continue;
                const float* up = &across[(j > 0 ? j - 1 : j) * row];
                const float* here = &across[j * row];
                const float* down = &across[std::min(j + 1, std::size_t(grid.size.y) - 1) * row];
                float* const line = lines.data();
                std::int16_t* const made = &written[k * slice + j * row];
                for (std::size_t i = 0; i < row; ++i)
                    line[i] = side.y * (up[i] + down[i]) + middle.y * here[i];
                for (std::size_t i = 0; i < row; ++i) {
                    const float left = line[i > 0 ? i - 1 : i],
                                right = line[std::min(i + 1, row - 1)];
                    made[i] =
                        std::int16_t(std::lround(side.x * (left + right) + middle.x * line[i]));
                }
            }
        }
    });
    return out;
}

/// Noise of a content: the median of |v − (v₋ + v₊)/2| with neighbours four voxels off, all deep in
/// it. 0 where there is none.
double noiseSd(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& contents,
               Content content, int threads) {
    constexpr int away = 4;
    const Grid& grid = hu.grid();
    std::vector<std::size_t> histogram(2048, 0);
    std::mutex mutex;
    parallelFor(std::size_t(grid.size.z), 16, threads, [&](std::size_t first, std::size_t last) {
        std::vector<std::size_t> own(histogram.size(), 0);
        for (std::size_t k = first; k < last; ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                const std::size_t row = grid.index(0, j, int(k));
                for (int i = 2 * away; i + 2 * away < grid.size.x; ++i) {
                    const std::size_t n = row + std::size_t(i);
                    bool deep = Content(contents[n]) == content;
                    for (int d = -2 * away; d <= 2 * away && deep; d += 2)
                        deep = Content(contents[std::size_t(std::ptrdiff_t(n) + d)]) == content;
                    if (!deep) continue;
                    const int off =
                        std::abs(int(hu[n]) - (int(hu[n - away]) + int(hu[n + away])) / 2);
                    ++own[std::size_t(std::min(off, 2047))];
                }
            }
        }
        const std::lock_guard lock(mutex);
        for (std::size_t n = 0; n < own.size(); ++n)
            histogram[n] += own[n];
    });
    const std::size_t count = std::accumulate(histogram.begin(), histogram.end(), std::size_t(0));
    if (count < 200) return 0.0;
    std::size_t below = 0, median = 0;
    while (2 * (below += histogram[median]) < count)
        ++median;
    return (double(median) + 0.5) / 0.6745 / std::sqrt(1.5);
}

glm::ivec3 reachOf(const std::array<Ray, 13>& rays) {
    glm::ivec3 reach(1);
    for (const Ray& ray : rays)
        reach = glm::max(reach, ray.steps * glm::abs(ray.step));
    return reach;
}

/// The brightest tagged HU near a voxel: over blocks as long as the reach, and those around.
class BrightestTagged {
public:
    BrightestTagged(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& content,
                    glm::ivec3 reach, int threads)
        : block_(reach) {
        const Grid& grid = hu.grid();
        Grid blocks;
        blocks.size = (grid.size + reach - 1) / reach;
        Volume<std::int16_t> own(blocks, std::int16_t(-32768));
        const auto most = own.writable();
        parallelFor(
            std::size_t(blocks.size.z), 1, threads, [&](std::size_t first, std::size_t last) {
                const std::size_t depth = std::size_t(reach.z);
                visitSlices(grid, first * depth, std::min(last * depth, std::size_t(grid.size.z)),
                            [&](std::size_t n, glm::ivec3 v) {
                                if (Content(content[n]) != Content::tagged) return;
                                std::int16_t& here = most[blocks.index(v / reach)];
                                here = std::max(here, hu[n]);
                            });
            });
        near_ = Volume<std::int16_t>(blocks);
        const auto near = near_.writable();
        forVoxels(blocks, threads, [&](std::size_t n, glm::ivec3 block) {
            near[n] = own[n];
            visitBox(glm::max(block - 1, glm::ivec3(0)), glm::min(block + 1, blocks.size - 1),
                     [&](glm::ivec3 beside) { near[n] = std::max(near[n], own.at(beside)); });
        });
    }
    double near(glm::ivec3 v) const { return near_.at(v / block_); }

private:
    const glm::ivec3 block_;
    Volume<std::int16_t> near_;  ///< on the blocks
};

class Search {
public:
    Search(const Volume<std::int16_t>& hu, const BowelContents& contents,
           const ThinWallOptions& options)
        : hu_(hu),
          content_(contents.content),
          grid_(hu.grid()),
          rays_(raysOf(grid_, options.reachMm)),
          reach_(reachOf(rays_)),
          brightest_(hu, contents.content, reach_, options.threads) {
        const double gasSd = noiseSd(hu, contents.content, Content::gas, options.threads);
        taggedSdsHu_ = options.leastSds *
                       std::clamp(noiseSd(hu, contents.content, Content::tagged, options.threads),
                                  gasSd, 1.5 * gasSd);
        gasRiseHu_ = std::max(options.leastShare * (options.softHu - contents.gasHu),
                              options.leastSds * gasSd);
        softHu_ = options.softHu, share_ = options.leastShare;
        gasHu_ = contents.gasHu;
        for (int dip = lowestHu, least = lowestHu; dip <= highestHu; ++dip) {
            while (least <= highestHu &&
                   least - dip <= std::max(share_ * (least - softHu_), taggedSdsHu_))
                ++least;
            leastAroundDip_.push_back(least);
        }
    }

    bool isWall(glm::ivec3 v) const {
        const std::size_t n = grid_.index(v);
        const Content content = Content(content_[n]);
        if (content == Content::tagged && touchesGas(v)) return true;
        if (content == Content::gas) {
            const int most = hu_[n] - int(std::floor(gasRiseHu_)) - 1;
            return hu_[n] > gasHu_ + gasRiseHu_ &&
                   isSheet(v, n, content, [&](int side) { return side <= most; });
        }
        if (content == Content::tagged) {
            // Most of a fluid lies far under nothing: what is brightest around says so at once.
            const double most = brightest_.near(v), above = hu_[n] - softHu_;
            const bool step = above < half * (most - softHu_);
            const bool sheet =
                most - hu_[n] > taggedSdsHu_ && above < (1.0 - share_) * (most - softHu_);
            const int least = leastAroundDip_[std::size_t(hu_[n] - lowestHu)];
            return (step && isStep(v, n)) ||
                   (sheet && isSheet(v, n, content, [&](int side) { return side >= least; }));
        }
        return false;
    }

private:
    static constexpr double half = 0.45;
    static constexpr int lowestHu = std::numeric_limits<std::int16_t>::min(),
                         highestHu = std::numeric_limits<std::int16_t>::max();

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
    /// Whether on both sides of the voxel there is some of the content whose HU the voxel stands
    /// out from.
    template <class StandsOut>
    bool isSheet(glm::ivec3 v, std::size_t n, Content content,
                 const StandsOut& standsOutFrom) const {
        const bool interior = glm::all(glm::greaterThanEqual(v, reach_)) &&
                              glm::all(glm::lessThan(v, grid_.size - reach_));
        const std::int16_t* const hu = &hu_.voxels()[n];
        const std::uint8_t* const contents = &content_.voxels()[n];
        const auto standsOutOn = [&](const Ray& ray, int side) {
            for (int step = 1; step <= ray.steps; ++step) {
                if (!interior && !grid_.contains(v + side * step * ray.step)) return false;
                const std::ptrdiff_t m = side * step * ray.offset;
                if (standsOutFrom(hu[m]) && Content(contents[m]) == content) return true;
            }
            return false;
        };
        return std::any_of(rays_.begin(), rays_.end(), [&](const Ray& ray) {
            return standsOutOn(ray, 1) && standsOutOn(ray, -1);
        });
    }

    const Volume<std::int16_t>& hu_;
    const Volume<std::uint8_t>& content_;
    const Grid grid_;
    const std::array<Ray, 13> rays_;
    const glm::ivec3 reach_;
    const BrightestTagged brightest_;
    double gasRiseHu_, taggedSdsHu_, softHu_, share_, gasHu_;
    /// By a tagged voxel's HU from `lowestHu` on: what it dips from on both sides is as bright.
    std::vector<int> leastAroundDip_;
};

// Noise makes specks, walls are sheets.
void dropSpecks(Volume<std::uint8_t>& walls, std::size_t smallest, int threads) {
    constexpr std::uint8_t kept = 2;
    const Grid& grid = walls.grid();
    const auto out = walls.writable();
    const auto marked =
        voxelsWhere(grid, threads, [&](std::size_t n, glm::ivec3) { return out[n] != 0; });
    std::vector<std::uint32_t> patch;
    for (const std::uint32_t n : marked) {
        if (out[n] != 1) continue;
        patch.assign(1, n);
        out[n] = kept;
        floodFill(patch, cornerNeighbours(grid), [&](std::size_t m) {
            if (out[m] != 1) return false;
            out[m] = kept;
            return true;
        });
        if (patch.size() >= smallest) continue;
        for (const std::uint32_t m : patch)
            out[m] = 0;
    }
    for (const std::uint32_t n : marked)
        out[n] = out[n] != 0;
}

}  // namespace

Volume<std::uint8_t> findThinWalls(const Volume<std::int16_t>& hu, const BowelContents& contents,
                                   const ThinWallOptions& options) {
    const Grid& grid = hu.grid();
    const Volume<std::int16_t> smooth =
        smoothed(hu, contents.content, options.smoothingMm, options.threads);
    const Search search(smooth, contents, options);
    Volume<std::uint8_t> walls(grid, std::uint8_t(0));
    const auto out = walls.writable();
    forVoxels(grid, options.threads, [&](std::size_t n, glm::ivec3 v) {
        const Content content = Content(contents.content[n]);
        if ((content == Content::gas || content == Content::tagged) && search.isWall(v)) out[n] = 1;
    });
    const double speckMm3 = options.speckMm2 * std::cbrt(grid.voxelVolumeMm3());
    dropSpecks(walls, std::size_t(std::ceil(speckMm3 / grid.voxelVolumeMm3())), options.threads);
    return walls;
}

}  // namespace haustra::segmentation
