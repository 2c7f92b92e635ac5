#include "segmentation/enclosed_gas.h"

#include "core/ct_scan.h"
#include "core/flood_fill.h"
#include "core/voxel_sweep.h"
#include "segmentation/bowel_contents.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace haustra::segmentation {
namespace {

constexpr double thickestWallMm = 3.0, leastFacing = 0.75, smallestMl = 5.0, thinnestRadiusMm = 3.0;

/// What a way along one axis from a voxel of gas comes to first.
enum class Side { gas, lumen, other };

class Enclosed {
public:
    Enclosed(const Volume<std::uint8_t>& content, const TubePieces& cut,
             Volume<std::uint8_t>& labels)
        : grid_(labels.grid()),
          content_(content),
          cut_(cut),
          labels_(labels.writable()),
          reach_(
              glm::max(glm::ivec3(glm::round(thickestWallMm / grid_.spacingMm())), glm::ivec3(1))),
          strides_{1, std::size_t(grid_.size.x),
                   std::size_t(grid_.size.x) * std::size_t(grid_.size.y)} {
        const glm::ivec3 most = reach_ + 1;
        for (int k = -most.z; k <= most.z; ++k) {
            for (int j = -most.y; j <= most.y; ++j) {
                for (int i = -most.x; i <= most.x; ++i) {
                    const glm::ivec3 step(i, j, k);
                    const glm::dvec3 gap(glm::max(glm::abs(step) - 1, glm::ivec3(0)));
                    if (glm::length(gap * grid_.spacingMm()) <= thickestWallMm)
                        ball_.push_back(step);
                }
            }
        }
    }

    std::vector<EnclosedGas> run(int threads) {
        const auto gas =
            voxelsWhere(grid_, threads, [&](std::size_t n, glm::ivec3) { return isGas(n); });
        const std::size_t least = std::size_t(smallestMl * 1000.0 / grid_.voxelVolumeMm3());
        std::vector<bool> seen(labels_.size(), false);
        std::vector<std::vector<std::uint32_t>> taken;
        std::vector<EnclosedGas> found;
        for (const std::uint32_t first : gas) {
            if (seen[first]) continue;
            std::vector<std::uint32_t> body = bodyOf(first, seen);
            if (body.size() < least) continue;
            const double facing = facingShare(body);
            if (facing < leastFacing || radiusMm(body) < thinnestRadiusMm) continue;
            found.push_back(described(body));
            found.back().facing = facing;
            taken.push_back(std::move(body));
        }
        for (const auto& body : taken) {
            const auto wall = wallAround(
                body, [&](std::size_t, std::size_t m) { return isGas(m); },
                [&](std::size_t m) { return isLumen(m); });
            for (const std::uint32_t n : body)
                labels_[n] = std::uint8_t(LumenLabel::air);
            takeIn(wall);
        }
        std::stable_sort(
            found.begin(), found.end(),
            [](const EnclosedGas& a, const EnclosedGas& b) { return a.volumeMl > b.volumeMl; });
        return found;
    }

    void takeInBalloons(const std::vector<std::int32_t>& balloons,
                        const std::vector<std::int32_t>& rectum, int threads) {
        enum class Of : char { others, balloon, rectum };
        std::vector<Of> is(cut_.pieces.size(), Of::others);
        for (const std::int32_t piece : rectum)
            is[std::size_t(piece)] = Of::rectum;
        for (const std::int32_t piece : balloons)
            is[std::size_t(piece)] = Of::balloon;
        const auto of = [&](std::size_t n) {
            const std::int32_t piece = cut_.pieceAt[n];
            return piece >= 0 ? is[std::size_t(piece)] : Of::others;
        };
        const auto body = voxelsWhere(grid_, threads, [&](std::size_t n, glm::ivec3) {
            return of(n) == Of::balloon && isLumen(n);
        });
        takeIn(wallAround(
            body, [&](std::size_t n, std::size_t m) { return cut_.pieceAt[m] == cut_.pieceAt[n]; },
            [&](std::size_t m) { return of(m) == Of::rectum && isLumen(m); }));
    }

private:
    bool isGas(std::size_t n) const {
        return Content(content_[n]) == Content::gas &&
               LumenLabel(labels_[n]) == LumenLabel::outside;
    }

    bool isLumen(std::size_t n) const { return LumenLabel(labels_[n]) != LumenLabel::outside; }

    // The voxels joined to the first by faces.
    std::vector<std::uint32_t> bodyOf(std::uint32_t first, std::vector<bool>& seen) const {
        std::vector<std::uint32_t> body{first};
        seen[first] = true;
        floodFill(body, faceNeighbours(grid_), [&](std::size_t m) {
            if (seen[m] || !isGas(m)) return false;
            seen[m] = true;
            return true;
        });
        return body;
    }

    // From a voxel of gas along an axis, and the number of voxels in between.
    std::pair<Side, int> sideOf(std::uint32_t n, int axis, int sign) const {
        const int from = grid_.voxelAt(n)[axis];
        std::size_t m = n;
        for (int step = 1; step <= reach_[axis] + 1; ++step) {
            if (from + sign * step < 0 || from + sign * step >= grid_.size[axis]) break;
            m = sign > 0 ? m + strides_[axis] : m - strides_[axis];
            if (isLumen(m)) return {Side::lumen, step - 1};
            if (Content(content_[m]) == Content::gas) return {Side::gas, step - 1};
        }
        return {Side::other, 0};
    }

    double radiusMm(const std::vector<std::uint32_t>& body) const {
        double most = 0.0;
        for (const std::uint32_t n : body)
            most = std::max<double>(most, cut_.distanceMm[n]);
        return most;
    }

    // Of the voxels with a side that is neither the body's nor other gas's, those that have lumen
    // within a wall's width.
    double facingShare(const std::vector<std::uint32_t>& body) const {
        std::size_t facing = 0, sides = 0;
        for (const std::uint32_t n : body) {
            bool side = false;
            visitFaces(grid_, n, [&](std::size_t m, int) { side = side || !isGas(m); });
            if (!side) continue;
            const Side is = nearest(n);
            facing += is == Side::lumen, sides += is != Side::gas;
        }
        return double(facing) / double(std::max<std::size_t>(sides, 1));
    }
    // What lies beyond a wall at a voxel: lumen wherever it is, else gas that the ways along the
    // axes meet.
    Side nearest(std::uint32_t n) const {
        const glm::ivec3 v = grid_.voxelAt(n);
        for (const glm::ivec3 step : ball_) {
            if (grid_.contains(v + step) && isLumen(grid_.index(v + step))) return Side::lumen;
        }
        for (int axis = 0; axis < 3; ++axis) {
            for (const int sign : {-1, 1}) {
                const auto [side, between] = sideOf(n, axis, sign);
                if (side == Side::gas && between > 0) return Side::gas;
            }
        }
        return Side::other;
    }

    EnclosedGas described(const std::vector<std::uint32_t>& voxels) const {
        EnclosedGas gas;
        gas.volumeMl = double(voxels.size()) * grid_.voxelVolumeMm3() / 1000.0;
        std::set<std::int32_t> pieces;
        for (const std::uint32_t n : voxels) {
            gas.placeMm += grid_.patientFromVoxelPoint(grid_.voxelAt(n)) / double(voxels.size());
            if (cut_.pieceAt[n] >= 0) pieces.insert(cut_.pieceAt[n]);
        }
        gas.pieces.assign(pieces.begin(), pieces.end());
        return gas;
    }

    // What lies on the straight ways of at most a wall's width from the body to what
    // isBeyond(voxel) tells; isOwn(voxel of the body, voxel) tells what is the body's.
    template <class IsOwn, class IsBeyond>
    std::vector<std::size_t> wallAround(const std::vector<std::uint32_t>& body, const IsOwn& isOwn,
                                        const IsBeyond& isBeyond) const {
        std::vector<std::size_t> wall;
        for (const std::uint32_t n : body) {
            bool side = false;
            visitFaces(grid_, n, [&](std::size_t m, int) { side = side || !isOwn(n, m); });
            if (!side) continue;
            const glm::ivec3 v = grid_.voxelAt(n);
            for (const glm::ivec3 step : ball_) {
                if (!grid_.contains(v + step)) continue;
                if (!isBeyond(grid_.index(v + step))) continue;
                const int length = std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)});
                for (int k = 1; k < length; ++k) {
                    const std::size_t m = grid_.index(
                        v + glm::ivec3(glm::round(glm::dvec3(step * k) / double(length))));
                    if (!isLumen(m) && !isGas(m)) wall.push_back(m);
                }
            }
        }
        return wall;
    }

    void takeIn(const std::vector<std::size_t>& wall) {
        for (const std::size_t n : wall)
            labels_[n] = std::uint8_t(LumenLabel::untagged);
        takeInRim(wall);
    }

    // Gas beside the wall that was taken in is brighter than gas by its share of the wall, and is
    // cleansed with it, but for what is beside a wall that stays.
    void takeInRim(const std::vector<std::size_t>& wall) {
        for (const std::size_t n : wall) {
            visitFaces(grid_, n, [&](std::size_t m, int) {
                if (LumenLabel(labels_[m]) != LumenLabel::air) return;
                bool beside = false;
                visitFaces(grid_, m, [&](std::size_t o, int) { beside = beside || !isLumen(o); });
                if (!beside) labels_[m] = std::uint8_t(LumenLabel::untagged);
            });
        }
    }

    const Grid grid_;
    const Volume<std::uint8_t>& content_;
    const TubePieces& cut_;
    const std::span<std::uint8_t> labels_;
    const glm::ivec3 reach_;
    const std::size_t strides_[3];
    std::vector<glm::ivec3> ball_;  ///< steps with no more than a wall between
};

}  // namespace

std::vector<EnclosedGas> takeInEnclosedGas(const Volume<std::uint8_t>& content,
                                           const TubePieces& cut, Volume<std::uint8_t>& labels,
                                           int threads) {
    return Enclosed(content, cut, labels).run(threads);
}

void takeInBalloons(const std::vector<std::int32_t>& balloons,
                    const std::vector<std::int32_t>& rectum, const Volume<std::uint8_t>& content,
                    const TubePieces& cut, Volume<std::uint8_t>& labels, int threads) {
    Enclosed(content, cut, labels).takeInBalloons(balloons, rectum, threads);
}

}  // namespace haustra::segmentation
