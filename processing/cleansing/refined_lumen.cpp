#include "cleansing/refined_lumen.h"

#include "cleansing/ball.h"
#include "core/connected_labels.h"
#include "core/flood_fill.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace haustra::cleansing {
namespace {

constexpr double speckMm3 = 12.0;

/// The 26-connected piece of wall around `seed`, or empty where it has more than `most` voxels:
/// then those that were seen are `large` from now on, and what meets them is.
std::vector<std::uint32_t> pieceOfWall(const Volume<std::uint8_t>& labels, std::uint32_t seed,
                                       std::size_t most, std::vector<bool>& large) {
    const Grid& grid = labels.grid();
    std::vector<std::uint32_t> piece{seed};
    bool whole = !large[seed];
    const auto neighbours = [&](std::uint32_t n, const auto& visit) {
        if (whole) visitCorners(grid, n, visit);
    };
    floodFill(piece, neighbours, [&](std::size_t n) {
        if (!whole || LumenLabel(labels[n]) != LumenLabel::outside ||
            std::find(piece.begin(), piece.end(), n) != piece.end())
            return false;
        whole = piece.size() < most && !large[n];
        return true;
    });
    if (whole) return piece;
    for (const std::uint32_t n : piece)
        large[n] = true;
    return {};
}

bool touchesLumen(const Volume<std::uint8_t>& labels, std::size_t index) {
    bool touches = false;
    visitFaces(labels.grid(), index, [&](std::size_t n, int) {
        touches = touches || LumenLabel(labels[n]) != LumenLabel::outside;
    });
    return touches;
}

}  // namespace

Volume<std::uint8_t> refineLumen(Volume<std::int16_t>& hu, const TissueModel& tissue,
                                 const SmoothField& airHu, const Volume<std::uint8_t>& segmentation,
                                 std::span<const CleansedVoxel> changed) {
    Volume<std::uint8_t> labels = segmentation.clone();
    const auto out = labels.writable();
    const auto cleansed = hu.writable();
    const auto airAt = [&](std::size_t index) {
        const glm::ivec3 v = hu.grid().voxelAt(index);
        return airHu.at(v.x, v.y, v.z);
    };
    const auto labelOf = [](const CleansedVoxel& voxel) {
        return std::uint8_t(voxel.tagged > voxel.air ? LumenLabel::tagged : LumenLabel::air);
    };
    std::vector<const CleansedVoxel*> beside;
    for (const CleansedVoxel& voxel : changed) {
        const bool open = cleansed[voxel.index] < tissue.airBelowHu;
        if (out[voxel.index] == std::uint8_t(LumenLabel::outside)) {
            if (open) beside.push_back(&voxel);
        } else if (out[voxel.index] != std::uint8_t(LumenLabel::bridge) &&
                   out[voxel.index] != std::uint8_t(LumenLabel::untagged)) {
            out[voxel.index] = open ? labelOf(voxel) : std::uint8_t(LumenLabel::outside);
        }
    }
    // Each pass is one step outward.
    const glm::ivec3 steps = voxelsIn(hu.grid(), 1.5);
    for (int pass = 0; pass < std::max({steps.x, steps.y, steps.z}); ++pass) {
        std::vector<const CleansedVoxel*> touching, left;
        for (const CleansedVoxel* voxel : beside)
            (touchesLumen(labels, voxel->index) ? touching : left).push_back(voxel);
        for (const CleansedVoxel* voxel : touching) {
            if (joinsNothing(labels, voxel->index))
                out[voxel->index] = labelOf(*voxel);
            else
                left.push_back(voxel);
        }
        beside = std::move(left);
    }
    const std::size_t most =
        std::size_t(std::max(1.0, std::floor(speckMm3 / hu.grid().voxelVolumeMm3())));
    std::vector<bool> large(labels.grid().voxelCount(), false);  // an eighth of a byte each
    for (const CleansedVoxel& voxel : changed) {
        if (LumenLabel(out[voxel.index]) != LumenLabel::outside ||
            !touchesLumen(labels, voxel.index))
            continue;
        for (std::uint32_t n : pieceOfWall(labels, voxel.index, most, large)) {
            out[n] = std::uint8_t(LumenLabel::tagged);
            cleansed[n] = std::int16_t(std::lround(airAt(n)));
        }
    }
    return labels;
}

}  // namespace haustra::cleansing
