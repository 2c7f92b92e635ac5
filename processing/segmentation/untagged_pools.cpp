#include "segmentation/untagged_pools.h"

#include "core/connected_labels.h"
#include "core/crop.h"
#include "core/flood_fill.h"
#include "core/quantile.h"
#include "segmentation/hu_range_lumen.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace haustra::segmentation {
namespace {

constexpr double smoothMm = 1.5, centerSmoothMm = 3.0;
constexpr double centerShare = 0.8;    // of the way to another tissue, at a ball's centre
constexpr double mostOverHu = 60.0;    // of weakly tagged fluid, its level's
constexpr double aboveMm = 20.0;       // the level, where leaks are looked for
constexpr double blurMm = 3.0;         // of partial volume at a level
constexpr double blurredWallMm = 1.0;  // taken for fluid beside fat
constexpr double overBoneMm = 2.5, besideBoneMm = 1.0;  // where a pool ends
constexpr std::array<double, 5> ballsMm{3.0, 4.0, 5.0, 6.5, 8.0};
constexpr double mostRisen = 0.15, leastFilled = 0.5, leastPoolMl = 1.0;

/// How far from its level a pool is sought: a haustrum's first, then a part of the colon's.
struct Reach {
    double asideMm, deepMm;
};
constexpr std::array<Reach, 2> reaches{{{45.0, 80.0}, {160.0, 160.0}}};

/// Why balls found no pool: where they came to the end of the reach, or into what is no fluid.
enum class NoPool { cutOff, leaked };

/// The surroundings of one level, and what of them may be its fluid.
class PoolSearch {
public:
    PoolSearch(const Volume<std::int16_t>& hu, const TissueModel& tissue,
               const BowelContents& contents, const UntaggedLevel& level, Reach reach, int threads)
        : level_(level),
          isWeak_(level.fluidHu > tissue.meanHu[int(Tissue::soft)]),
          down_(contents.down),
          tissue_(tissue),
          threads_(threads) {
        const Grid& whole = hu.grid();
        glm::ivec3 lo = level.columns.front(), hi = lo;
        for (const glm::ivec3 v : level.columns)
            lo = glm::min(lo, v), hi = glm::max(hi, v);
        glm::dvec3 before(reach.asideMm), after(reach.asideMm);
        before[down_.axis] = down_.sign > 0 ? aboveMm : reach.deepMm;
        after[down_.axis] = down_.sign > 0 ? reach.deepMm : aboveMm;
        const glm::dvec3 spacing = whole.spacingMm();
        lo = glm::max(lo - glm::ivec3(glm::ceil(before / spacing)), glm::ivec3(0));
        hi = glm::min(hi + glm::ivec3(glm::ceil(after / spacing)), whole.size - 1);
        box_ = {lo, hi - lo + 1};
        hu_ = cropped(hu, box_, threads);
        content_ = cropped(contents.content, box_, threads);
        planeMm_ = level.heightMm - down_.sign * spacing[down_.axis] * double(lo[down_.axis]);
        sort(tissue);
        distanceMm_ = topology::distanceToBoundaryMm(inside_, threads);
    }

    /// The pool that balls of this radius find, on the box's grid.
    tl::expected<Volume<std::uint8_t>, NoPool> open(double ballMm) const {
        Volume<std::uint8_t> pool = reached(ballMm);
        fillBlur(pool);
        const Grid& grid = pool.grid();
        std::size_t voxels = 0, risen = 0, underGas = 0;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            if (!pool[n]) continue;
            ++voxels;
            const glm::ivec3 v = grid.voxelAt(n);
            const double mm = depthMm(v);
            if (atSide(v)) return tl::make_unexpected(mm < 0.0 ? NoPool::leaked : NoPool::cutOff);
            risen += mm < -blurMm && mm >= -blurMm - stepMm();
            underGas += mm >= blurMm && mm < blurMm + stepMm() && isUnderGas(pool, v);
        }
        std::size_t filled = 0;
        for (const glm::ivec3 column : level_.columns)
            filled += fillsBelow(pool, column - box_.lo);
        const bool sound = double(voxels) * grid.voxelVolumeMm3() / 1000.0 > leastPoolMl &&
                           double(risen) < mostRisen * double(underGas) &&
                           double(filled) > leastFilled * double(level_.columns.size());
        if (!sound) return tl::make_unexpected(NoPool::leaked);
        trim(pool);
        const Gradient gradient = gradientUnder(pool);
        keepOverBone(pool);
        keepAsideOfBone(pool);
        add(gradient, pool);
        return pool;
    }

    /// What a graded level's fluid is above the tagging, on the box's grid; empty where that is not
    /// flat.
    std::optional<Volume<std::uint8_t>> gradient() const {
        Volume<std::uint8_t> pool(hu_.grid(), std::uint8_t(0));
        const auto in = pool.writable();
        for (const glm::ivec3 column : level_.columns) {
            const std::size_t n = hu_.grid().index(below(column - box_.lo));
            in[n] = isTissue(n);
        }
        const Gradient gradient = gradientUnder(pool);
        if (2 * gradient.columns < level_.columns.size()) return std::nullopt;
        add(gradient, pool);
        return pool;
    }

    const VoxelBox& box() const { return box_; }

private:
    double stepMm() const { return hu_.grid().spacingMm()[down_.axis]; }
    double depthMm(glm::ivec3 v) const {
        return down_.sign * stepMm() * double(v[down_.axis]) - planeMm_;
    }
    glm::ivec3 below(glm::ivec3 v, int steps = 1) const {
        v[down_.axis] += steps * down_.sign;
        return v;
    }
    bool isGas(std::size_t n) const { return Content(content_[n]) == Content::gas; }
    bool isUntagged(std::size_t n) const { return Content(content_[n]) == Content::untagged; }
    bool isTissue(std::size_t n) const { return Content(content_[n]) == Content::tissue; }
    /// Of weakly tagged fluid some voxels, by noise, are bright enough for tagged ones.
    bool mayBeFluid(std::size_t n) const {
        return isTissue(n) || (isWeak_ && Content(content_[n]) == Content::tagged);
    }
    /// Sediment, or bone; not what is so bright in weakly tagged fluid by noise.
    bool isTagged(std::size_t n) const {
        return Content(content_[n]) == Content::tagged && !(isWeak_ && fluid_[n]);
    }
    bool isTagged(glm::ivec3 v) const {
        return hu_.grid().contains(v) && isTagged(hu_.grid().index(v));
    }
    int voxelsOf(double mm, int axis) const {
        return std::max(1, int(std::lround(mm / hu_.grid().spacingMm()[axis])));
    }
    /// Where a pool that goes on would be cut off.
    bool atSide(glm::ivec3 v) const {
        return glm::any(glm::equal(v, glm::ivec3(0))) ||
               glm::any(glm::equal(v, hu_.grid().size - 1));
    }

    void sort(const TissueModel& tissue) {
        const Grid& grid = hu_.grid();
        const double softHu = tissue.meanHu[int(Tissue::soft)],
                     fatHu = tissue.meanHu[int(Tissue::fat)];
        // Fluid lies between fat and soft tissue in HU; with some tagging, over soft tissue.
        const double fromHu = 0.5 * (level_.fluidHu + (isWeak_ ? softHu : fatHu)),
                     toHu = isWeak_ ? level_.fluidHu + std::min(mostOverHu, level_.fluidHu - softHu)
                                    : 0.5 * (level_.fluidHu + softHu);
        fluid_ = looksLike(smoothMm, fromHu, toHu, fatHu);
        centers_ = looksLike(centerSmoothMm, glm::mix(level_.fluidHu, fromHu, centerShare),
                             glm::mix(level_.fluidHu, toHu, centerShare), fatHu);
        inside_ = Volume<std::uint8_t>(grid, std::uint8_t(0));
        blur_ = Volume<std::uint8_t>(grid, std::uint8_t(0));
        const auto inside = inside_.writable(), blur = blur_.writable();
        for (std::size_t n = 0; n < inside.size(); ++n) {
            const double mm = depthMm(grid.voxelAt(n));
            // Balls may reach into the gas over the level, but not climb along the wall beside it.
            inside[n] = fluid_[n] || (isGas(n) && mm <= 0.0 && mm > -ballsMm.front());
        }
        for (const glm::ivec3 column : level_.columns) {
            for (glm::ivec3 v = below(column - box_.lo);
                 grid.contains(v) && depthMm(v) < blurMm && isTissue(grid.index(v)); v = below(v))
                inside[grid.index(v)] = blur[grid.index(v)] = 1;
        }
    }
    /// What may be fluid and whose HU, smoothed among such alone, lie between these.
    Volume<std::uint8_t> looksLike(double sdMm, double fromHu, double toHu, double fatHu) const {
        constexpr int one = 1000, leastWeight = 200;
        const Grid& grid = hu_.grid();
        Volume<std::int16_t> value(grid, std::int16_t(0)), weight(grid, std::int16_t(0));
        const auto values = value.writable(), weights = weight.writable();
        for (std::size_t n = 0; n < values.size(); ++n) {
            if (!mayBeFluid(n) || hu_[n] < 2.0 * fatHu) continue;
            values[n] = hu_[n], weights[n] = one;
        }
        value = segmentation::smoothHu(value, sdMm, threads_);
        weight = segmentation::smoothHu(weight, sdMm, threads_);
        Volume<std::uint8_t> like(grid, std::uint8_t(0));
        const auto out = like.writable();
        for (std::size_t n = 0; n < out.size(); ++n) {
            if (isUntagged(n)) out[n] = 1;  // another level's pool, open to this one
            if (!mayBeFluid(n) || weight[n] < leastWeight) continue;
            const double meanHu = double(one) * value[n] / weight[n];
            out[n] = meanHu > fromHu && meanHu < toHu;
        }
        return like;
    }

    /// Where centres of balls that fit come from the level, and what those balls cover less a wall.
    Volume<std::uint8_t> reached(double ballMm) const {
        const Grid& grid = hu_.grid();
        Volume<std::uint8_t> beyond(grid, std::uint8_t(1));
        const auto out = beyond.writable();
        std::vector<std::uint32_t> front;
        const auto take = [&](std::size_t n) {
            if (out[n] == 0 || !fluid_[n] || !centers_[n] || !(distanceMm_[n] > ballMm))
                return false;
            out[n] = 0;
            return true;
        };
        for (const glm::ivec3 column : level_.columns) {
            for (glm::ivec3 v = below(column - box_.lo);
                 grid.contains(v) && depthMm(v) < ballMm + blurMm; v = below(v)) {
                if (take(grid.index(v))) front.push_back(std::uint32_t(grid.index(v)));
            }
        }
        floodFill(front, faceNeighbours(grid), take);
        Volume<std::uint8_t> pool(grid, std::uint8_t(0));
        if (front.empty()) return pool;
        const Volume<float> awayMm = topology::distanceToBoundaryMm(beyond, threads_);
        const auto in = pool.writable();
        for (std::size_t n = 0; n < in.size(); ++n)
            in[n] = (fluid_[n] || blur_[n]) && awayMm[n] <= ballMm - blurredWallMm;
        return pool;
    }

    /// The partial volume between the pool and the gas over it, and the sediment under it.
    void fillBlur(Volume<std::uint8_t>& pool) const {
        const auto in = pool.writable();
        eachColumn([&](const std::vector<std::size_t>& column) {
            enum class Over { other, gas, fluid } over = Over::other;
            std::vector<std::size_t> between;
            for (const std::size_t m : column) {
                const bool mayBlur = double(between.size()) * stepMm() < blurMm && mayBeFluid(m);
                const bool ends = isGas(m) || in[m] || isTagged(m);
                if (ends) {
                    const bool fills = over == Over::gas     ? in[m] != 0
                                       : over == Over::fluid ? !isGas(m)
                                                             : false;
                    for (const std::size_t gap : between)
                        in[gap] = in[gap] || fills;
                    between.clear();
                    over = isGas(m) ? Over::gas : in[m] ? Over::fluid : Over::other;
                } else if (over != Over::other && mayBlur && (over == Over::fluid || blur_[m])) {
                    between.push_back(m);
                } else {
                    over = Over::other, between.clear();
                }
            }
        });
    }

    /// Takes off columns that rise over the level, and what blur adds at the level.
    void trim(Volume<std::uint8_t>& pool) const {
        const auto in = pool.writable();
        eachColumn([&](const std::vector<std::size_t>& column) {
            bool leaked = false;
            for (const std::size_t m : column) {
                const double mm = depthMm(hu_.grid().voxelAt(m));
                leaked = in[m] && (leaked || mm < -blurMm);
                if (leaked || (mm <= 0.0 && !blur_[m])) in[m] = 0;
            }
        });
    }

    /// Of each column, where it meets what is bright, as a place along the column.
    class BrightFloors {
    public:
        static constexpr double none = -1.0;

        BrightFloors(const Grid& grid, GravityAxis down)
            : grid_(grid),
              across_(1 - down.axis),
              stepMm_(grid.spacingMm()[down.axis]),
              at_(std::size_t(grid.size[across_]) * std::size_t(grid.size.z), none) {}

        double& at(glm::ivec3 v) { return at_[index(v[across_], v.z)]; }

        /// Whether most of the floors 4 to 16 mm off along both axes, of `least` and more, are as
        /// high as the one here.
        bool isFlat(glm::ivec3 v, double mostOffMm, int least) const {
            return isLevel(v, across_, mostOffMm, least) && isLevel(v, 2, mostOffMm, least);
        }

    private:
        std::size_t index(int n, int z) const {
            return std::size_t(n) + std::size_t(grid_.size[across_]) * std::size_t(z);
        }
        bool isLevel(glm::ivec3 v, int axis, double mostOffMm, int least) const {
            constexpr std::array<double, 4> asideMm{4.0, 8.0, 12.0, 16.0};
            const double here = at_[index(v[across_], v.z)];
            int met = 0, level = 0;
            for (const double mm : asideMm) {
                const int step = std::max(1, int(std::lround(mm / grid_.spacingMm()[axis])));
                for (const int sign : {-1, 1}) {
                    glm::ivec3 w = v;
                    w[axis] += sign * step;
                    if (!grid_.contains(w)) continue;
                    const double floor = at_[index(w[across_], w.z)];
                    if (floor == none) continue;
                    ++met;
                    level += std::abs(floor - here) * stepMm_ <= mostOffMm;
                }
            }
            return met >= least && (met == 0 || 2 * level > met);
        }

        const Grid& grid_;
        const int across_;
        const double stepMm_;
        std::vector<double> at_;  ///< in voxels from the column's upper end
    };

    /// Fluid that rises to the tagging beneath it: what is heavier sank.
    struct Gradient {
        std::vector<std::size_t> voxels;
        std::size_t columns = 0;
    };

    /// What lies between a pool and the tagging to which its fluid rises, farther than blur
    /// reaches. The tagging there is flat, and from a wall's HU to its own it takes longer than
    /// blur; bone behind a wall is neither. A column that noise keeps from rising does as half of
    /// those around it.
    Gradient gradientUnder(const Volume<std::uint8_t>& pool) const {
        constexpr double flatMm = 1.5;
        constexpr int leastMet = 3;
        constexpr int mostRounds = 8;
        constexpr std::size_t leastAround = 4;
        const Grid& grid = hu_.grid();
        const int across = 1 - down_.axis;
        BrightFloors ends(grid, down_), risen(grid, down_), floors(grid, down_);
        eachColumn([&](const std::vector<std::size_t>& column) {
            int last = -1;
            for (std::size_t at = 0; at < column.size(); ++at)
                if (pool[column[at]]) last = int(at);
            if (last < 0) return;
            const glm::ivec3 v = grid.voxelAt(column[std::size_t(last)]);
            ends.at(v) = last;
            const auto steps = stepsToTagged(hu_, tissue_, v, down_);
            if (!steps) return;
            if (riseMm(hu_, tissue_, v, down_) < slowRiseMm) return;
            risen.at(v) = last + *steps;
        });
        eachColumn([&](const std::vector<std::size_t>& column) {
            const glm::ivec3 v = grid.voxelAt(column.front());
            if (risen.at(v) != BrightFloors::none && risen.isFlat(v, flatMm, leastMet))
                floors.at(v) = risen.at(v);
        });
        const auto around = [&](glm::ivec3 v) {
            std::vector<double> all;
            for (int d = 0; d < 9; ++d) {
                glm::ivec3 w = v;
                w[across] += d % 3 - 1, w.z += d / 3 - 1;
                if (grid.contains(w) && floors.at(w) != BrightFloors::none)
                    all.push_back(floors.at(w));
            }
            return all;
        };
        for (int round = 0; round < mostRounds; ++round) {
            std::vector<std::pair<glm::ivec3, double>> more;
            eachColumn([&](const std::vector<std::size_t>& column) {
                const glm::ivec3 v = grid.voxelAt(column.front());
                if (ends.at(v) == BrightFloors::none || floors.at(v) != BrightFloors::none) return;
                auto beside = around(v);
                if (beside.size() >= leastAround) more.emplace_back(v, medianOf(beside));
            });
            if (more.empty()) break;
            for (const auto& [v, floor] : more)
                floors.at(v) = floor;
        }
        Gradient gradient;
        const int gap = voxelsOf(overBoneMm, down_.axis);
        eachColumn([&](const std::vector<std::size_t>& column) {
            const glm::ivec3 v = grid.voxelAt(column.front());
            const double floor = floors.at(v);
            if (floor == BrightFloors::none) return;
            ++gradient.columns;
            // Of the pool's own what keepOverBone takes; beneath the floor some voxels are dark by
            // noise alone.
            const int first = std::max(0, std::min(int(ends.at(v)), int(floor) - gap));
            const auto end = std::min(column.size(), std::size_t(floor + blurMm / stepMm()) + 1);
            for (std::size_t at = std::size_t(first); at < end; ++at)
                if (double(at) < ends.at(v) ? pool[column[at]] != 0
                                            : isTissue(column[at]) && (double(at) < floor ||
                                                                       isBrightAround(column[at])))
                    gradient.voxels.push_back(column[at]);
        });
        return gradient;
    }

    bool isBrightAround(std::size_t n) const {
        return meanAlongLevel(hu_, hu_.grid().voxelAt(n), down_) > tissue_.taggedAboveHu;
    }

    static void add(const Gradient& gradient, Volume<std::uint8_t>& pool) {
        const auto in = pool.writable();
        for (const std::size_t n : gradient.voxels)
            in[n] = 1;
    }

    /// Sediment lies level under its fluid, along both axes, as far as it reaches; what is bright
    /// under a pool and not level is bone, and the pool ends a wall's width over it.
    void keepOverBone(Volume<std::uint8_t>& pool) const {
        const Grid& grid = hu_.grid();
        const double flatMm = std::max(0.8, 0.6 * stepMm());
        const auto in = pool.writable();
        BrightFloors floors(grid, down_);
        eachColumn([&](const std::vector<std::size_t>& column) {
            for (std::size_t at = 1; at < column.size(); ++at) {
                if (!in[column[at - 1]] || !isTagged(column[at])) continue;
                floors.at(grid.voxelAt(column[at])) = double(at);
            }
        });
        const int gap = voxelsOf(overBoneMm, down_.axis);
        eachColumn([&](const std::vector<std::size_t>& column) {
            const glm::ivec3 first = grid.voxelAt(column.front());
            const double floor = floors.at(first);
            if (floor == BrightFloors::none || floors.isFlat(first, flatMm, 0)) return;
            for (int at = std::max(0, int(floor) - gap); at < floor; ++at)
                in[column[std::size_t(at)]] = 0;
        });
    }

    /// What is bright and stands up beside a pool is no sediment of it.
    void keepAsideOfBone(Volume<std::uint8_t>& pool) const {
        const Grid& grid = hu_.grid();
        const int up = -voxelsOf(overBoneMm, down_.axis);
        const auto standsAt = [&](glm::ivec3 v) { return isTagged(v) && isTagged(below(v, up)); };
        const auto in = pool.writable();
        for (std::size_t n = 0; n < in.size(); ++n) {
            if (!in[n]) continue;
            for (const int axis : {1 - down_.axis, 2}) {
                const int reach = voxelsOf(besideBoneMm, axis);
                glm::ivec3 v = grid.voxelAt(n);
                v[axis] -= reach;
                for (int step = -reach; step <= reach; ++step, ++v[axis])
                    if (standsAt(v)) in[n] = 0;
            }
        }
    }

    /// visit(voxels of a column, downwards).
    template <class Visit>
    void eachColumn(const Visit& visit) const {
        const Grid& grid = hu_.grid();
        const int across = 1 - down_.axis, length = grid.size[down_.axis];
        std::vector<std::size_t> column(static_cast<std::size_t>(length));
        for (int k = 0; k < grid.size.z; ++k) {
            for (int n = 0; n < grid.size[across]; ++n) {
                glm::ivec3 v(0, 0, k);
                v[across] = n;
                for (int at = 0; at < length; ++at) {
                    v[down_.axis] = down_.sign > 0 ? at : length - 1 - at;
                    column[std::size_t(at)] = grid.index(v);
                }
                visit(column);
            }
        }
    }

    bool isUnderGas(const Volume<std::uint8_t>& pool, glm::ivec3 v) const {
        const Grid& grid = pool.grid();
        for (v = below(v, -1); grid.contains(v); v = below(v, -1)) {
            const std::size_t n = grid.index(v);
            if (isGas(n)) return true;
            if (!pool[n]) return false;
        }
        return false;
    }
    bool fillsBelow(const Volume<std::uint8_t>& pool, glm::ivec3 column) const {
        const Grid& grid = pool.grid();
        for (glm::ivec3 v = below(column); grid.contains(v) && depthMm(v) < blurMm + stepMm();
             v = below(v)) {
            if (depthMm(v) >= blurMm) return pool.at(v) != 0;
        }
        return false;
    }

    const UntaggedLevel& level_;
    const bool isWeak_;  ///< took some tagging: brighter than soft tissue
    const GravityAxis down_;
    const TissueModel& tissue_;
    const int threads_;
    VoxelBox box_;
    double planeMm_ = 0.0;  ///< the level's height on the box's grid
    Volume<std::int16_t> hu_;
    Volume<std::uint8_t> content_;
    Volume<std::uint8_t> fluid_;    ///< looks like the level's fluid
    Volume<std::uint8_t> centers_;  ///< the same by more of its surroundings, and surer
    Volume<std::uint8_t> blur_;     ///< partial volume between fluid and gas
    Volume<std::uint8_t> inside_;  ///< where no wall stands in a ball's way; gas below is another's
    Volume<float> distanceMm_;
};

}  // namespace

bool markUntaggedPools(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                       const std::vector<UntaggedLevel>& levels, BowelContents& contents,
                       int threads) {
    const Grid& grid = hu.grid();
    const auto content = contents.content.writable();
    const auto put = [&](const PoolSearch& search, const Volume<std::uint8_t>& pool) {
        for (std::size_t n = 0; n < pool.grid().voxelCount(); ++n) {
            if (pool[n] == 0) continue;
            const std::size_t m = grid.index(pool.grid().voxelAt(n) + search.box().lo);
            content[m] = std::uint8_t(Content::untagged);
        }
    };
    const auto poolOf = [&](const PoolSearch& search, double ballMm) -> tl::expected<void, NoPool> {
        const auto pool = search.open(ballMm);
        if (!pool) return tl::make_unexpected(pool.error());
        put(search, *pool);
        return {};
    };
    // The smallest balls that do not leak show most of a pool.
    const auto mark = [&](const UntaggedLevel& level) {
        const PoolSearch near(hu, tissue, contents, level, reaches[0], threads);
        // Else its top is the wall's by its HU, or tagged: balls have nothing to go by.
        const bool showsByHu = !level.likeWall && level.fluidHu < tissue.taggedAboveHu;
        std::optional<PoolSearch> far;
        for (const double ballMm : ballsMm) {
            if (!showsByHu) break;
            const auto marked = poolOf(near, ballMm);
            if (marked) return true;
            if (marked.error() != NoPool::cutOff) continue;
            if (!far) far.emplace(hu, tissue, contents, level, reaches[1], threads);
            if (poolOf(*far, ballMm)) return true;
        }
        if (!level.graded) return false;
        const auto pool = near.gradient();
        if (pool) put(near, *pool);
        return pool.has_value();
    };
    bool any = false;
    for (const UntaggedLevel& level : levels)
        any = mark(level) || any;
    return any;
}

}  // namespace haustra::segmentation
