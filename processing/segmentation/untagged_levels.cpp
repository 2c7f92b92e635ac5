#include "segmentation/untagged_levels.h"

#include "core/ct_scan.h"
#include "core/flood_fill.h"
#include "core/parallel.h"
#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace haustra::segmentation {
namespace {

constexpr double leastMm2 = 100.0;
constexpr double flatMm = 0.3, flatShare = 0.6;
constexpr double discMm = 9.0, discShare = 0.85;      // as no floor of a lumen is flat
constexpr double gentleSlope = 0.6;                   // of a floor that goes on
constexpr double edgeMm = 4.0;                        // of blur between gas and what is beneath
constexpr double beneathMm = 1.5, deepestMm = 6.0;    // where the fluid's own HU shows
constexpr double unlikeDown = 10.0, unlikeUp = 25.0;  // HU off soft tissue's
constexpr double sharpMm = 2.6;  // from gas to tagged where nothing but blur lies between
constexpr double gradedShare = 0.6;

/// Where a column of gas ends.
struct Floor {
    int across, z;
    int voxel;        ///< the last of gas, along the gravity axis
    double heightMm;  ///< of the middle between gas and soft tissue, along the axis
    double huBeneath;
    int samples;
    bool rises;  ///< to the tagging's HU, farther beneath than blur reaches
};

class Floors {
public:
    Floors(const Volume<std::int16_t>& hu, const TissueModel& tissue,
           const Volume<std::uint8_t>& labels, GravityAxis down)
        : hu_(hu),
          labels_(labels),
          down_(down),
          stepMm_(hu.grid().spacingMm()[down.axis]),
          softHu_(tissue.meanHu[int(Tissue::soft)]),
          middleHu_(0.5 * (softHu_ + tissue.meanHu[int(Tissue::air)])),
          tissue_(tissue) {}

    std::vector<Floor> ofSlice(int z) const {
        const Grid& grid = hu_.grid();
        const int across = 1 - down_.axis, length = grid.size[down_.axis];
        std::vector<Floor> floors;
        glm::ivec3 v(0, 0, z);
        for (int n = 0; n < grid.size[across]; ++n) {
            v[across] = n;
            for (int at = 0; at + 1 < length; ++at) {
                v[down_.axis] = down_.sign > 0 ? at : length - 1 - at;
                if (LumenLabel(labels_.at(v)) != LumenLabel::air) continue;
                glm::ivec3 next = v;
                next[down_.axis] += down_.sign;
                if (LumenLabel(labels_.at(next)) != LumenLabel::outside) continue;
                if (const auto floor = below(v)) floors.push_back(*floor);
            }
        }
        return floors;
    }

private:
    std::optional<Floor> below(glm::ivec3 gas) const {
        const Grid& grid = hu_.grid();
        Floor floor{gas[1 - down_.axis], gas.z, gas[down_.axis], 0.0, 0.0, 0, false};
        glm::ivec3 v = gas;
        double last = hu_.at(v), crossedMm = -1.0;
        glm::ivec3 crossed = gas;
        for (int step = 1; crossedMm < 0.0; ++step) {
            v[down_.axis] += down_.sign;
            if (!grid.contains(v) || step * stepMm_ > edgeMm + stepMm_) return {};
            const double here = hu_.at(v);
            crossed = v;
            if (here > middleHu_)
                crossedMm =
                    stepMm_ *
                    (step - 1 + (last < middleHu_ ? (middleHu_ - last) / (here - last) : 0.0));
            last = here;
        }
        floor.heightMm = down_.sign * stepMm_ * gas[down_.axis] + crossedMm;
        double sum = 0.0;
        for (int step = int(std::ceil((crossedMm + beneathMm) / stepMm_));
             step * stepMm_ <= crossedMm + deepestMm; ++step) {
            v = gas, v[down_.axis] += step * down_.sign;
            if (!grid.contains(v) || hu_.at(v) > tissue_.taggedAboveHu) break;
            sum += hu_.at(v), ++floor.samples;
        }
        const auto steps = stepsToTagged(hu_, tissue_, crossed, down_);
        floor.rises = steps && *steps * stepMm_ > sharpMm &&
                      riseMm(hu_, tissue_, crossed, down_) >= slowRiseMm;
        // What rises fast has few voxels to measure, and is known by that it rises.
        if (floor.samples == 0 && floor.rises) {
            floor.huBeneath = tissue_.taggedAboveHu;
            return floor;
        }
        if (floor.samples == 0) return {};
        floor.huBeneath = sum / floor.samples;
        return floor;
    }

    const Volume<std::int16_t>& hu_;
    const Volume<std::uint8_t>& labels_;
    const GravityAxis down_;
    const double stepMm_, softHu_, middleHu_;
    const TissueModel& tissue_;
};

/// The height that most floors of a patch share, and how many do.
std::pair<double, std::size_t> commonHeight(const std::vector<Floor>& patch) {
    std::vector<double> heights;
    for (const Floor& floor : patch)
        heights.push_back(floor.heightMm);
    std::sort(heights.begin(), heights.end());
    std::pair<double, std::size_t> best{0.0, 0};
    for (std::size_t first = 0, last = 0; first < heights.size(); ++first) {
        while (last < heights.size() && heights[last] <= heights[first] + 2.0 * flatMm)
            ++last;
        if (last - first > best.second) best = {heights[(first + last) / 2], last - first};
    }
    return best;
}

/// Columns of one height, as a picture over both axes across gravity.
class FlatArea {
public:
    FlatArea(const std::vector<Floor>& patch, double heightMm, glm::dvec2 stepMm)
        : reach_(discMm / stepMm), stepMm_(stepMm) {
        lo_ = glm::ivec2(patch.front().across, patch.front().z);
        glm::ivec2 hi = lo_;
        for (const Floor& floor : patch)
            lo_ = glm::min(lo_, placeOf(floor)), hi = glm::max(hi, placeOf(floor));
        size_ = hi - lo_ + 1;
        flat_.assign(std::size_t(size_.x) * std::size_t(size_.y), 0);
        for (const Floor& floor : patch) {
            if (std::abs(floor.heightMm - heightMm) > flatMm) continue;
            if (!flat_[index(placeOf(floor) - lo_)]) places_.push_back(placeOf(floor) - lo_);
            flat_[index(places_.back())] = 1;
        }
    }

    /// Of each column of the patch, whether a flat disc covers it.
    std::vector<bool> covered(const std::vector<Floor>& patch) const {
        std::vector<char> cover(flat_.size(), 0);
        for (const glm::ivec2 place : places_) {
            int flat = 0, all = 0;
            visitDisc(place,
                      [&](glm::ivec2 at) { ++all, flat += contains(at) && flat_[index(at)]; });
            if (double(flat) < discShare * double(all)) continue;
            visitDisc(place, [&](glm::ivec2 at) {
                if (contains(at)) cover[index(at)] = 1;
            });
        }
        std::vector<bool> is;
        for (const Floor& floor : patch)
            is.push_back(cover[index(placeOf(floor) - lo_)] != 0);
        return is;
    }

private:
    static glm::ivec2 placeOf(const Floor& floor) { return {floor.across, floor.z}; }
    std::size_t index(glm::ivec2 at) const {
        return std::size_t(at.x) + std::size_t(size_.x) * std::size_t(at.y);
    }
    bool contains(glm::ivec2 at) const {
        return at.x >= 0 && at.y >= 0 && at.x < size_.x && at.y < size_.y;
    }
    template <class Visit>
    void visitDisc(glm::ivec2 center, const Visit& visit) const {
        for (int z = -reach_.y; z <= reach_.y; ++z) {
            for (int n = -reach_.x; n <= reach_.x; ++n) {
                if (glm::length(stepMm_ * glm::dvec2(n, z)) <= discMm)
                    visit(center + glm::ivec2(n, z));
            }
        }
    }

    const glm::ivec2 reach_;
    const glm::dvec2 stepMm_;
    glm::ivec2 lo_{0}, size_{0};
    std::vector<char> flat_;
    std::vector<glm::ivec2> places_;
};

/// Takes the columns of a level out of a patch of floors; empty where there is none.
std::vector<Floor> takeLevel(std::vector<Floor>& patch, glm::dvec2 stepMm) {
    std::vector<Floor> level, rest;
    if (double(patch.size()) * stepMm.x * stepMm.y < leastMm2) return level;
    const auto [heightMm, count] = commonHeight(patch);
    if (double(count) * stepMm.x * stepMm.y < leastMm2) return level;
    const bool mostly = double(count) >= flatShare * double(patch.size());
    const std::vector<bool> covered = mostly ? std::vector<bool>(patch.size(), true)
                                             : FlatArea(patch, heightMm, stepMm).covered(patch);
    for (std::size_t n = 0; n < patch.size(); ++n) {
        const bool is = covered[n] && std::abs(patch[n].heightMm - heightMm) <= flatMm;
        (is ? level : rest).push_back(patch[n]);
    }
    patch = mostly ? std::vector<Floor>() : std::move(rest);
    return level;
}

/// All floors, and those of each column by its place in the horizontal plane.
class FloorMap {
public:
    FloorMap(const Grid& grid, GravityAxis down, const std::vector<std::vector<Floor>>& slices)
        : width_(grid.size[1 - down.axis]),
          stepMm_(grid.spacingMm()[1 - down.axis], grid.spacingMm().z) {
        for (const auto& slice : slices) {
            for (const Floor& floor : slice) {
                atPlace_[placeOf(floor.across, floor.z)].push_back(std::uint32_t(floors_.size()));
                floors_.push_back(floor);
            }
        }
    }

    glm::dvec2 stepMm() const { return stepMm_; }

    /// Floors that go on from one another gently, each in one patch.
    std::vector<std::vector<Floor>> patches() const {
        std::vector<bool> seen(floors_.size(), false);
        const auto take = [&](std::uint32_t floor) {
            if (seen[floor]) return false;
            seen[floor] = true;
            return true;
        };
        const auto beside = [&](std::uint32_t floor, const auto& visit) {
            visitBeside(floors_[floor], visit);
        };
        std::vector<std::vector<Floor>> patches;
        for (std::uint32_t seed = 0; seed < floors_.size(); ++seed) {
            if (!take(seed)) continue;
            std::vector<std::uint32_t> members{seed};
            floodFill(members, beside, take);
            patches.emplace_back();
            for (const std::uint32_t n : members)
                patches.back().push_back(floors_[n]);
        }
        return patches;
    }

private:
    std::size_t placeOf(int across, int z) const {
        return std::size_t(across) + std::size_t(width_) * std::size_t(z);
    }

    /// visit(floor) of the eight columns around one that go on from it gently.
    template <class Visit>
    void visitBeside(const Floor& from, const Visit& visit) const {
        for (int d = 0; d < 9; ++d) {
            const int dn = d % 3 - 1, dz = d / 3 - 1, n = from.across + dn, z = from.z + dz;
            if (n < 0 || z < 0 || n >= width_ || d == 4) continue;
            const auto near = atPlace_.find(placeOf(n, z));
            if (near == atPlace_.end()) continue;
            const double mm = std::hypot(dn * stepMm_.x, dz * stepMm_.y);
            for (const std::uint32_t other : near->second) {
                const double rise = std::abs(floors_[other].heightMm - from.heightMm);
                if (rise <= std::max(flatMm, gentleSlope * mm)) visit(other);
            }
        }
    }

    const int width_;
    const glm::dvec2 stepMm_;  ///< across, and along z
    std::vector<Floor> floors_;
    std::unordered_map<std::size_t, std::vector<std::uint32_t>> atPlace_;
};

/// A surface as a level; none where what is beneath it is like soft tissue or fat.
std::optional<UntaggedLevel> levelOf(const std::vector<Floor>& surface, const Grid& grid,
                                     GravityAxis down, glm::dvec2 stepMm,
                                     const TissueModel& tissue) {
    UntaggedLevel level;
    std::vector<double> beneath, heights;
    glm::dvec3 middle(0.0);
    for (const Floor& floor : surface) {
        glm::ivec3 at(0);
        at[down.axis] = floor.voxel, at[1 - down.axis] = floor.across, at.z = floor.z;
        middle += glm::dvec3(at);
        level.columns.push_back(at);
        beneath.push_back(floor.huBeneath), heights.push_back(floor.heightMm);
    }
    const double softHu = tissue.meanHu[int(Tissue::soft)], fatHu = tissue.meanHu[int(Tissue::fat)];
    level.fluidHu = medianOf(beneath), level.heightMm = medianOf(heights);
    const auto rising =
        std::ranges::count_if(surface, [](const Floor& floor) { return floor.rises; });
    level.graded = double(rising) >= gradedShare * double(surface.size());
    level.likeWall = level.fluidHu > softHu - unlikeDown && level.fluidHu < softHu + unlikeUp;
    if (level.likeWall && !level.graded) return {};
    if (level.fluidHu < 0.5 * (softHu + fatHu)) return {};
    level.areaMm2 = double(surface.size()) * stepMm.x * stepMm.y;
    level.placeMm = grid.patientFromVoxelPoint(middle / double(surface.size()));
    return level;
}

}  // namespace

std::optional<double> stepsToTagged(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                                    glm::ivec3 from, GravityAxis down) {
    const double mostFallHu = 1.5 * tissue.sdHu[int(Tissue::soft)];
    const Grid& grid = hu.grid();
    const int most = int(longestGradientMm / grid.spacingMm()[down.axis]);
    double highest = -1e9, last = highest, first = 0.0;
    int tagged = 0;
    for (int step = 0; step <= most; ++step, from[down.axis] += down.sign) {
        if (!grid.contains(from)) return {};
        const double here = meanAlongLevel(hu, from, down);
        if (here < highest - mostFallHu) return {};
        highest = std::max(highest, here);
        if (here <= tissue.taggedAboveHu) {
            tagged = 0;
        } else if (++tagged == 1) {
            first = step == 0 ? 0.0 : step - (here - tissue.taggedAboveHu) / (here - last);
        } else {
            return first;
        }
        last = here;
    }
    return {};
}

std::vector<UntaggedLevel> findUntaggedLevels(const Volume<std::int16_t>& hu,
                                              const TissueModel& tissue,
                                              const Volume<std::uint8_t>& labels, GravityAxis down,
                                              int threads) {
    const Grid& grid = hu.grid();
    const Floors columns(hu, tissue, labels, down);
    std::vector<std::vector<Floor>> slices(std::size_t(grid.size.z));
    parallelFor(slices.size(), 1, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k)
            slices[k] = columns.ofSlice(int(k));
    });
    const FloorMap floors(grid, down, slices);
    std::vector<UntaggedLevel> levels;
    for (std::vector<Floor>& patch : floors.patches()) {
        for (std::vector<Floor> level; !(level = takeLevel(patch, floors.stepMm())).empty();) {
            if (const auto told = levelOf(level, grid, down, floors.stepMm(), tissue))
                levels.push_back(*told);
        }
    }
    std::stable_sort(
        levels.begin(), levels.end(),
        [](const UntaggedLevel& a, const UntaggedLevel& b) { return a.areaMm2 > b.areaMm2; });
    return levels;
}

}  // namespace haustra::segmentation
