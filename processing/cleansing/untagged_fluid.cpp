#include "cleansing/untagged_fluid.h"

#include "core/crop.h"
#include "core/quantile.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr std::uint8_t untagged = std::uint8_t(LumenLabel::untagged);
constexpr double besideMm = 2.5;  // of blur between fluid and sediment

/// The share of lumen around a voxel, in 64ths; 0 where none of the 27 voxels is untagged fluid.
int share(const Volume<std::uint8_t>& labels, glm::ivec3 v) {
    int sum = 0;
    bool near = false;
    for (int n = 0; n < 27; ++n) {
        const glm::ivec3 step = cornerStep(n);
        if (!labels.grid().contains(v + step)) continue;
        const std::uint8_t label = labels.at(v + step);
        near = near || label == untagged;
        if (LumenLabel(label) == LumenLabel::outside) continue;
        sum += (2 - std::abs(step.x)) * (2 - std::abs(step.y)) * (2 - std::abs(step.z));
    }
    return near ? sum : 0;
}

/// Makes untagged fluid again of what was lumen in `before` within `reach` of untagged fluid.
void restore(Volume<std::uint8_t>& labels, const Volume<std::uint8_t>& before, glm::ivec3 lo,
             glm::ivec3 hi, glm::ivec3 reach) {
    const Grid& grid = labels.grid();
    std::vector<std::size_t> fluid;
    visitBox(lo, hi, [&](glm::ivec3 at) {
        const std::size_t n = grid.index(at);
        if (LumenLabel(labels[n]) != LumenLabel::outside || before[n] == 0) return;
        bool beside = false;
        for (int axis = 0; axis < 3; ++axis) {
            for (int step = -reach[axis]; step <= reach[axis]; ++step) {
                glm::ivec3 v = at;
                v[axis] += step;
                beside = beside || (grid.contains(v) && before.at(v) == untagged);
            }
        }
        if (beside) fluid.push_back(n);
    });
    for (const std::size_t n : fluid)
        labels.writable()[n] = untagged;
}

}  // namespace

bool hasUntagged(const Volume<std::uint8_t>& labels) {
    return std::memchr(labels.voxels().data(), untagged, labels.voxels().size()) != nullptr;
}

void takeOutUntagged(Volume<std::int16_t>& hu, Volume<std::uint8_t>& labels,
                     const Volume<std::uint8_t>& before, double airHu, int threads) {
    constexpr int whole = 64;
    const Grid& grid = labels.grid();
    glm::ivec3 lo = grid.size, hi(-1);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (labels[n] != untagged) continue;
        lo = glm::min(lo, grid.voxelAt(n)), hi = glm::max(hi, grid.voxelAt(n));
    }
    if (hi.x < 0) return;
    const glm::ivec3 reach(glm::ceil(besideMm / grid.spacingMm()));
    lo = glm::max(lo - reach, glm::ivec3(0)), hi = glm::min(hi + reach, grid.size - 1);
    restore(labels, before, lo, hi, reach);
    const Grid box = cropped(grid, {lo, hi - lo + 1});
    std::vector<std::uint8_t> shares(box.voxelCount());
    parallelFor(std::size_t(box.size.z), 1, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t n = box.index(0, 0, int(first)); n < box.index(0, 0, int(last)); ++n)
            shares[n] = std::uint8_t(share(labels, lo + box.voxelAt(n)));
    });
    std::vector<std::int16_t> deep, any;
    const auto out = hu.writable();
    for (std::size_t n = 0; n < shares.size(); ++n) {
        const std::size_t at = grid.index(lo + box.voxelAt(n));
        if (labels[at] != untagged) continue;
        any.push_back(out[at]);
        if (shares[n] == whole) deep.push_back(out[at]);
    }
    std::vector<std::int16_t>& fluid = deep.empty() ? any : deep;
    const double fallHu = std::max(0.0, medianOf(fluid) - airHu);
    for (std::size_t n = 0; n < shares.size(); ++n) {
        if (shares[n] == 0) continue;
        std::int16_t& voxel = out[grid.index(lo + box.voxelAt(n))];
        const double cleansed = voxel - fallHu * shares[n] / whole;
        voxel = std::int16_t(std::lround(std::max(std::min<double>(voxel, airHu), cleansed)));
    }
}

}  // namespace haustra::cleansing
