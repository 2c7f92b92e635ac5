#include "segmentation/tagged_stool.h"

#include "core/flood_fill.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace haustra::segmentation {
namespace {

constexpr double largestMl = 30.0;
constexpr std::size_t fewestVoxels = 8;
constexpr double smallestContactShare = 0.25;
// Of what is as wide as bowel: a loop that lies against the colon from outside shows it less.
constexpr double smallestBallContactShare = 0.5;
// A film on the wall: so much of it, so thin in the mean, so much of its surface facing gas with no
// wall between.
constexpr double smallestFilmMm3 = 15.0, thickestFilmMm = 4.0, filmShare = 0.3;
// From where gas is half tissue to where tagging begins: blur of 1.3 to 1.6 mm full width takes 0.7
// mm to bright tagging and 1.3 mm to a dim film; with two walls of bowel between, 2 mm thick, it is
// 1.6 mm and more. Narrow voxels tell these apart.
constexpr double widestBlurMm = 1.4, filmVoxelMm = 1.25;
// Beneath a fold's coat there is gas again, as there is across a film from rim to rim: of what
// faces gas, so much may do both.
constexpr double thickestFoldMm = 6.0, mostOverFold = 0.3;
// Facing gas: a ball that rests on the wall does so with more, a layer on the wall with half.
constexpr double standingShare = 0.6, widestCrumbMm = 10.0;
// As far over the threshold as noise is there, times this: what is brighter is no noise.
constexpr double farFromNoise = 2.0;
constexpr double smallestCoreShare = 0.1;
constexpr double wellAboveHu = 60.0;
constexpr int contactVoxels = 2;  // of partial volume between air and stool

/// Bodies of tagged stool beside the air of a lumen, and that lumen's labels, which they join.
class StoolSearch {
public:
    StoolSearch(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                const BowelContents& contents, const TissueModel& tissue)
        : grid_(labels.grid()),
          hu_(hu.voxels()),
          content_(contents.content.voxels()),
          labels_(labels.writable()),
          strides_{1, std::size_t(grid_.size.x),
                   std::size_t(grid_.size.x) * std::size_t(grid_.size.y)},
          largest_(std::size_t(largestMl * 1000.0 / grid_.voxelVolumeMm3())),
          aboveHu_(tissue.taggedAboveHu),
          softHu_(tissue.meanHu[int(Tissue::soft)]),
          airBelowHu_(tissue.airBelowHu),
          noiseSdHu_(contents.gasSdHu),
          barred_(labels_.size(), false),
          seen_(labels_.size(), false) {}

    void bar(std::span<const std::uint32_t> voxels, bool barred) {
        for (const std::uint32_t index : voxels)
            barred_[index] = barred;
    }

    /// Voxels of stool that air of the lumen reaches, ascending.
    std::vector<std::uint32_t> besideAir() const {
        std::vector<std::uint32_t> found;
        for (std::size_t n = 0; n < labels_.size(); ++n) {
            if (labels_[n] != std::uint8_t(LumenLabel::air)) continue;
            bool surface = false;
            visitFaces(grid_, n, [&](std::size_t m, int) { surface = surface || labels_[m] == 0; });
            if (!surface) continue;
            reach(
                n, [&](std::size_t at) { return isStool(at); },
                [&](int, int, int, std::size_t at) { found.push_back(std::uint32_t(at)); });
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    /// Those of `voxels` that are stool and reach air of the lumen.
    std::vector<std::uint32_t> besideAir(std::span<const std::uint32_t> voxels) const {
        std::vector<std::uint32_t> found;
        for (const std::uint32_t index : voxels) {
            if (!isStool(index)) continue;
            bool reached = false;
            reach(
                index, [&](std::size_t at) { return labels_[at] != 0 || isStool(at); },
                [&](int, int, int, std::size_t at) {
                    reached = reached || labels_[at] == std::uint8_t(LumenLabel::air);
                });
            if (reached) found.push_back(index);
        }
        return found;
    }

    /// Bodies that were taken may be taken again.
    void forgetTaken() { std::fill(seen_.begin(), seen_.end(), false); }

    /// The body of a voxel, joined by faces; empty where it was returned before. All of a body is
    /// seen, however large: what is left of bone must not pass for stool.
    std::vector<std::uint32_t> takeBody(std::uint32_t seed) {
        std::vector<std::uint32_t> body;
        const auto take = [&](std::size_t n) {
            if (seen_[n] || !isStool(n)) return false;
            seen_[n] = true;
            return true;
        };
        if (take(seed)) body.push_back(seed);
        floodFill(body, faceNeighbours(grid_), take);
        return body;
    }

    bool hasSizeOfStool(const std::vector<std::uint32_t>& body) const {
        return body.size() >= fewestVoxels && body.size() <= largest_;
    }

    /// A coated fold is thin and no brighter than its blur: stool has an inside, well tagged.
    bool isWellTagged(const std::vector<std::uint32_t>& body) const {
        std::size_t core = 0;
        for (std::uint32_t index : body) {
            int around = 0;
            visitFaces(grid_, index, [&](std::size_t m, int) { around += isStool(m); });
            core += around == 6;
        }
        return double(core) >= smallestCoreShare * double(body.size()) &&
               meanHu(body) >= aboveHu_ + wellAboveHu;
    }

    /// At least `share` of its surface faces the lumen.
    bool liesInLumen(const std::vector<std::uint32_t>& body, double share) const {
        return facing(body, [&](std::size_t at) { return labels_[at] != 0; }) >= share;
    }

    /// What is brighter than any soft tissue, small all ways and has gas around it is residue,
    /// however few its voxels are. A fold that is coated on both sides is no thicker, but wide.
    bool standsInGas(const std::vector<std::uint32_t>& body) const {
        glm::ivec3 lo = grid_.size, hi(0);
        for (const std::uint32_t index : body)
            lo = glm::min(lo, grid_.voxelAt(index)), hi = glm::max(hi, grid_.voxelAt(index));
        const glm::dvec3 widthMm = grid_.spacingMm() * glm::dvec3(hi - lo + 1);
        if (std::max({widthMm.x, widthMm.y, widthMm.z}) > widestCrumbMm) return false;
        return facing(body, [&](std::size_t at) {
                   return labels_[at] == std::uint8_t(LumenLabel::air);
               }) >= standingShare;
    }

    /// So is what lies on the wall with no tissue between it and the gas. What has gas behind it,
    /// too, coats a fold, which is often too thin to be told from its coat: that stays.
    bool isFilm(const std::vector<std::uint32_t>& body) const {
        const glm::dvec3 spacing = grid_.spacingMm();
        if (std::max({spacing.x, spacing.y, spacing.z}) > filmVoxelMm ||
            double(body.size()) * grid_.voxelVolumeMm3() < smallestFilmMm3)
            return false;
        const double voxelMm3 = grid_.voxelVolumeMm3();
        std::size_t faces = 0, bare = 0, overFold = 0;
        double bareMm2 = 0.0;
        for (const std::uint32_t index : body) {
            visitFaces(grid_, index, [&](std::size_t m, int) { faces += !isStool(m); });
            for (int axis = 0; axis < 3; ++axis) {
                for (const int sign : {-1, 1}) {
                    if (stepsToBareGas(index, axis, sign) == 0) continue;
                    ++bare, bareMm2 += voxelMm3 / spacing[axis];
                    overFold += hasGasBeneath(index, axis, -sign);
                }
            }
        }
        return double(bare) >= filmShare * double(faces) &&
               double(overFold) <= mostOverFold * double(bare) &&
               double(body.size()) * voxelMm3 <= thickestFilmMm * bareMm2;
    }

    /// No brighter than what soft tissue's noise brings above the tagging's threshold t: of a
    /// normal distribution's tail beyond t the mean lies about σ² / (t − µ) farther out.
    bool mayBeNoise(const std::vector<std::uint32_t>& body) const {
        const double beyondHu = noiseSdHu_ * noiseSdHu_ / (aboveHu_ - softHu_);
        return meanHu(body) < aboveHu_ + farFromNoise * beyondHu;
    }

    /// As bright as tagging by a sharp kernel alone, which the contents take for tissue.
    bool isOvershoot(const std::vector<std::uint32_t>& body) const {
        const auto tissue = std::count_if(body.begin(), body.end(), [&](std::uint32_t index) {
            return Content(content_[index]) == Content::tissue;
        });
        return 2 * std::size_t(tissue) > body.size();
    }

    /// Labels a body; the partial volume on the way to the air goes with it.
    void label(const std::vector<std::uint32_t>& body) {
        for (std::uint32_t index : body) {
            const auto labelWay = [&](int axis, int sign, int steps) {
                std::size_t at = index;
                for (int n = 1; n < steps; ++n) {
                    at = stepped(at, axis, sign);
                    if (labels_[at] == 0) labels_[at] = std::uint8_t(LumenLabel::tagged);
                }
            };
            reach(
                index, [&](std::size_t at) { return labels_[at] == std::uint8_t(LumenLabel::air); },
                [&](int axis, int sign, int steps, std::size_t) { labelWay(axis, sign, steps); });
            for (int axis = 0; axis < 3; ++axis)
                for (const int sign : {-1, 1})
                    labelWay(axis, sign, stepsToBareGas(index, axis, sign));
            labels_[index] = std::uint8_t(LumenLabel::tagged);
        }
    }

private:
    bool isStool(std::size_t index) const {
        return labels_[index] == 0 && hu_[index] > aboveHu_ && !barred_[index];
    }

    double meanHu(const std::vector<std::uint32_t>& body) const {
        double sum = 0.0;
        for (const std::uint32_t index : body)
            sum += hu_[index];
        return sum / double(body.size());
    }

    /// The share of a body's surface from which what `counts` is reached.
    template <class Counts>
    double facing(const std::vector<std::uint32_t>& body, const Counts& counts) const {
        std::size_t faces = 0, contacts = 0;
        for (std::uint32_t index : body) {
            visitFaces(grid_, index, [&](std::size_t m, int) { faces += !isStool(m); });
            reach(
                index, [&](std::size_t at) { return labels_[at] != 0 || isStool(at); },
                [&](int, int, int, std::size_t at) { contacts += counts(at); });
        }
        return double(contacts) / double(faces);
    }

    /// From the voxel `index` along ± the axis to gas of the lumen that has nothing but their blur
    /// before it; 0: there is none.
    int stepsToBareGas(std::size_t index, int axis, int sign) const {
        const glm::ivec3 v = grid_.voxelAt(index);
        const double stepMm = grid_.spacingMm()[axis];
        const int within = sign > 0 ? grid_.size[axis] - 1 - v[axis] : v[axis];
        double beginsAt = 0.0;   // in steps: where tagging does
        double hu = hu_[index];  // one step before
        std::size_t at = index;
        for (int step = 1; step <= within; ++step) {
            at = stepped(at, axis, sign);
            const bool isAir = labels_[at] == std::uint8_t(LumenLabel::air);
            if (isStool(at) || barred_[at] || (labels_[at] != 0 && !isAir)) return 0;
            const double next = hu_[at];
            if (step == 1) beginsAt = next < aboveHu_ ? (hu - aboveHu_) / (hu - next) : 1.0;
            if (next < airBelowHu_) {
                const double gasAt = step - 1 + (hu - airBelowHu_) / (hu - next);
                const bool isBlur = (gasAt - beginsAt) * stepMm <= widestBlurMm;
                return isBlur && isAir ? step : 0;
            }
            if ((step - beginsAt) * stepMm > widestBlurMm) return 0;
            hu = next;
        }
        return 0;
    }

    /// Whether along ± the axis, beyond the stool that the voxel `index` is of, gas of the lumen is
    /// no farther than a fold is thick.
    bool hasGasBeneath(std::size_t index, int axis, int sign) const {
        const glm::ivec3 v = grid_.voxelAt(index);
        const int within = sign > 0 ? grid_.size[axis] - 1 - v[axis] : v[axis];
        int left = int(thickestFoldMm / grid_.spacingMm()[axis]);
        std::size_t at = index;
        for (int step = 0; step < within && left > 0; ++step) {
            at = stepped(at, axis, sign);
            if (labels_[at] == std::uint8_t(LumenLabel::air)) return true;
            if (!isStool(at)) --left;
        }
        return false;
    }

    std::size_t stepped(std::size_t index, int axis, int sign) const {
        return sign > 0 ? index + strides_[axis] : index - strides_[axis];
    }

    /// From the voxel `index` along ± each axis, across the partial volume between one body and the
    /// next, to the first voxel for which `hit(index)` holds: visit(axis, sign, steps, its index).
    template <class Hit, class Visit>
    void reach(std::size_t index, const Hit& hit, const Visit& visit) const {
        const glm::ivec3 v = grid_.voxelAt(index);
        for (int axis = 0; axis < 3; ++axis) {
            for (int sign : {-1, 1}) {
                const int within = sign > 0 ? grid_.size[axis] - 1 - v[axis] : v[axis];
                std::size_t at = index;
                for (int step = 1; step <= std::min(contactVoxels + 1, within); ++step) {
                    at = stepped(at, axis, sign);
                    if (!hit(at)) continue;
                    visit(axis, sign, step, at);
                    break;
                }
            }
        }
    }

    const Grid grid_;
    const std::span<const std::int16_t> hu_;
    const std::span<const std::uint8_t> content_;
    const std::span<std::uint8_t> labels_;
    const std::size_t strides_[3];
    const std::size_t largest_;
    const double aboveHu_, softHu_, airBelowHu_, noiseSdHu_;
    std::vector<bool> barred_, seen_;
};

}  // namespace

void addTaggedStool(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                    const BowelContents& contents, const TissueModel& tissue,
                    const OtherMaterial& other) {
    StoolSearch search(labels, hu, contents, tissue);
    for (const auto* voxels : {&other.surely, &other.aside, &other.bowel})
        search.bar(*voxels, true);
    const auto labelBodiesOf = [&](const std::vector<std::uint32_t>& seeds, const auto& isStool) {
        search.forgetTaken();
        for (const std::uint32_t seed : seeds) {
            const std::vector<std::uint32_t> body = search.takeBody(seed);
            if (search.hasSizeOfStool(body) && isStool(body)) search.label(body);
        }
    };
    labelBodiesOf(search.besideAir(), [&](const auto& body) {
        return search.isWellTagged(body) && search.liesInLumen(body, smallestContactShare);
    });
    const auto isBall = [&](const auto& body) {
        return search.isWellTagged(body) && search.liesInLumen(body, smallestBallContactShare);
    };
    search.bar(other.bowel, false);
    if (!other.bowel.empty()) labelBodiesOf(search.besideAir(other.bowel), isBall);
    // Of a lump of lobes each touches the others: with what is as wide as bowel they are one.
    search.bar(other.aside, false);
    if (!other.bowel.empty() && !other.aside.empty())
        labelBodiesOf(search.besideAir(other.bowel), isBall);
    search.bar(other.bowel, true);
    labelBodiesOf(search.besideAir(), [&](const auto& body) {
        return (search.standsInGas(body) || search.isFilm(body)) &&
               (search.isWellTagged(body) ||
                (!search.mayBeNoise(body) && !search.isOvershoot(body)));
    });
}

}  // namespace haustra::segmentation
