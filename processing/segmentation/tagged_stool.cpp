#include "segmentation/tagged_stool.h"

#include "core/flood_fill.h"

#include <algorithm>
#include <vector>

namespace haustra::segmentation {
namespace {

constexpr double largestMl = 30.0;
constexpr std::size_t fewestVoxels = 8;
constexpr double smallestContactShare = 0.25;
// Of what is as wide as bowel: a loop that lies against the colon from outside shows it less.
constexpr double smallestBallContactShare = 0.5;
constexpr double smallestCoreShare = 0.1;
constexpr double wellAboveHu = 60.0;
constexpr int contactVoxels = 2;  // of partial volume between air and stool

/// Bodies of tagged stool beside the air of a lumen, and that lumen's labels, which they join.
class StoolSearch {
public:
    StoolSearch(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                const TissueModel& tissue, std::span<const std::uint32_t> excluded)
        : grid_(labels.grid()),
          hu_(hu.voxels()),
          labels_(labels.writable()),
          strides_{1, std::size_t(grid_.size.x),
                   std::size_t(grid_.size.x) * std::size_t(grid_.size.y)},
          largest_(std::size_t(largestMl * 1000.0 / grid_.voxelVolumeMm3())),
          aboveHu_(tissue.taggedAboveHu),
          barred_(labels_.size(), false),
          seen_(labels_.size(), false) {
        bar(excluded, true);
    }

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
        double sum = 0.0;
        for (std::uint32_t index : body) {
            int around = 0;
            visitFaces(grid_, index, [&](std::size_t m, int) { around += isStool(m); });
            core += around == 6;
            sum += hu_[index];
        }
        return double(core) >= smallestCoreShare * double(body.size()) &&
               sum >= (aboveHu_ + wellAboveHu) * double(body.size());
    }

    /// At least `share` of its surface faces the lumen.
    bool liesInLumen(const std::vector<std::uint32_t>& body, double share) const {
        std::size_t faces = 0, contacts = 0;
        for (std::uint32_t index : body) {
            visitFaces(grid_, index, [&](std::size_t m, int) { faces += !isStool(m); });
            reach(
                index, [&](std::size_t at) { return labels_[at] != 0 || isStool(at); },
                [&](int, int, int, std::size_t at) { contacts += labels_[at] != 0; });
        }
        return double(contacts) >= share * double(faces);
    }

    /// Labels a body; the partial volume on the way to the air goes with it.
    void label(const std::vector<std::uint32_t>& body) {
        for (std::uint32_t index : body) {
            reach(
                index, [&](std::size_t at) { return labels_[at] == std::uint8_t(LumenLabel::air); },
                [&](int axis, int sign, int steps, std::size_t) {
                    std::size_t at = index;
                    for (int n = 1; n < steps; ++n) {
                        at = stepped(at, axis, sign);
                        if (labels_[at] == 0) labels_[at] = std::uint8_t(LumenLabel::tagged);
                    }
                });
            labels_[index] = std::uint8_t(LumenLabel::tagged);
        }
    }

private:
    bool isStool(std::size_t index) const {
        return labels_[index] == 0 && hu_[index] > aboveHu_ && !barred_[index];
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
    const std::span<std::uint8_t> labels_;
    const std::size_t strides_[3];
    const std::size_t largest_;
    const double aboveHu_;
    std::vector<bool> barred_, seen_;
};

}  // namespace

void addTaggedStool(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                    const TissueModel& tissue, std::span<const std::uint32_t> excluded,
                    std::span<const std::uint32_t> bowel) {
    StoolSearch search(labels, hu, tissue, excluded);
    const auto labelBodiesOf = [&](const std::vector<std::uint32_t>& seeds, double contactShare) {
        for (const std::uint32_t seed : seeds) {
            const std::vector<std::uint32_t> body = search.takeBody(seed);
            if (search.hasSizeOfStool(body) && search.isWellTagged(body) &&
                search.liesInLumen(body, contactShare))
                search.label(body);
        }
    };
    search.bar(bowel, true);
    labelBodiesOf(search.besideAir(), smallestContactShare);
    if (bowel.empty()) return;
    search.bar(bowel, false);
    search.bar(excluded, true);
    search.forgetTaken();
    labelBodiesOf(search.besideAir(bowel), smallestBallContactShare);
}

}  // namespace haustra::segmentation
