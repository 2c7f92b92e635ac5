#include "cleansing/water_level.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace haustra::cleansing {
namespace {

/// Fewer level columns are the top of a ball of stool, which needs no wall to hold it.
constexpr int fewestColumns = 12;

}  // namespace

WaterLevel::WaterLevel(const CtScan& scan, const LocalMeans& means,
                       const InterfaceLayer& interfaces, const TaggedSurroundings& around,
                       glm::dvec3 gravity, int threads) {
    const Grid& grid = scan.hu.grid();
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 direction = glm::normalize(glm::dvec3(grid.patientFromVoxel[axis]));
        const double along = glm::dot(direction, gravity);
        if (std::abs(along) < 0.95) continue;
        down_[axis] = along > 0.0 ? 1 : -1;
        stepMm_ = grid.spacingMm()[axis];
    }
    if (down_ == glm::ivec3(0)) return;
    crossing_ = Volume<std::uint8_t>(grid, std::uint8_t(0));
    const auto out = crossing_.writable();
    // A steeper surface is no level, or a wall's blur has tilted it.
    constexpr double steepest = 0.12, surelyBare = 0.9;
    for (const auto& shell : around.shells) {
        parallelFor(shell.size(), 1 << 13, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t m = begin; m < end; ++m) {
                const glm::ivec3 v = grid.voxelAt(shell[m]), below = v + down_;
                if (!grid.contains(below + 1) || !grid.contains(v - 1) ||
                    !grid.contains(below - 1) || !grid.contains(v + 1))
                    continue;
                const double tagged = means.taggedHu.at(v);
                const double middle = 0.5 * (means.airHu.at(v.x, v.y, v.z) + tagged);
                const double here = scan.hu.at(v), next = scan.hu.at(below);
                if (here >= middle || next < middle) continue;
                double aside = 0.0;
                for (int axis = 0; axis < 3; ++axis) {
                    if (down_[axis] != 0) continue;
                    glm::ivec3 d(0);
                    d[axis] = 1;
                    const double slope = 0.25 * (scan.hu.at(v + d) - scan.hu.at(v - d) +
                                                 scan.hu.at(below + d) - scan.hu.at(below - d));
                    aside = std::max(aside, std::abs(slope));
                }
                if (aside > steepest * (next - here)) continue;
                const glm::ivec3 nearer = middle - here < next - middle ? v : below;
                if (interfaces.bareness(nearer, tagged, means.softHu.at(v.x, v.y, v.z)) <
                    surelyBare)
                    continue;
                out[shell[m]] =
                    std::uint8_t(1 + std::lround(254.0 * (middle - here) / (next - here)));
            }
        });
    }
    Grid coarse = grid;
    coarse.size = (grid.size + blockVoxels - 1) / blockVoxels;
    blocks_ = Volume<std::uint8_t>(coarse, std::uint8_t(0));
    const auto block = blocks_.writable();
    for (const auto& shell : around.shells) {
        for (std::uint32_t n : shell) {
            if (out[n] == 0) continue;
            const glm::ivec3 b = grid.voxelAt(n) / blockVoxels;
            const glm::ivec3 reach = glm::ivec3(2) - glm::abs(down_);
            const glm::ivec3 lo = glm::max(b - reach, glm::ivec3(0)),
                             hi = glm::min(b + reach, coarse.size - 1);
            for (int k = lo.z; k <= hi.z; ++k) {
                for (int j = lo.y; j <= hi.y; ++j) {
                    for (int i = lo.x; i <= hi.x; ++i)
                        block[coarse.index(i, j, k)] = 1;
                }
            }
        }
    }
}

bool WaterLevel::standsAbove(glm::ivec3 voxel, const Volume<std::uint8_t>& segmentation) const {
    if (crossing_.empty()) return false;
    constexpr int widestGap = 3, across = 8, height = 3;
    const Grid& grid = crossing_.grid();
    glm::ivec3 top = voxel;
    int gap = 0;
    for (glm::ivec3 v = voxel - down_; grid.contains(v) && gap <= widestGap; v -= down_) {
        const LumenLabel label{segmentation.at(v)};
        if (label == LumenLabel::air) break;
        gap = label == LumenLabel::tagged ? 0 : gap + 1;
        if (gap == 0) top = v;
    }
    const glm::ivec3 reach = glm::ivec3(across) - (across - height) * glm::abs(down_);
    const glm::ivec3 lo = glm::max(top - reach, glm::ivec3(0)),
                     hi = glm::min(top + reach, grid.size - 1);
    int count = 0;
    for (int k = lo.z; k <= hi.z; ++k) {
        for (int j = lo.y; j <= hi.y; ++j) {
            for (int i = lo.x; i <= hi.x; ++i) {
                if (crossing_.at(i, j, k) != 0 && ++count == fewestColumns) return true;
            }
        }
    }
    return false;
}

std::optional<double> WaterLevel::depthMm(glm::ivec3 voxel) const {
    constexpr int across = 8, height = 4;
    if (crossing_.empty()) return std::nullopt;
    const Grid& grid = crossing_.grid();
    const glm::ivec3 level = glm::ivec3(1) - glm::abs(down_);
    const glm::ivec3 reach = across * level + height * glm::abs(down_);
    const glm::ivec3 lo = glm::max(voxel - reach, glm::ivec3(0)),
                     hi = glm::min(voxel + reach, grid.size - 1);
    double weight = 0.0, sum = 0.0;
    int count = 0;
    for (int k = lo.z; k <= hi.z; ++k) {
        for (int j = lo.y; j <= hi.y; ++j) {
            const std::size_t row = grid.index(0, j, k);
            for (int i = lo.x; i <= hi.x; ++i) {
                const std::uint8_t crossing = crossing_[row + std::size_t(i)];
                if (crossing == 0) continue;
                const glm::ivec3 d = glm::ivec3(i, j, k) - voxel;
                const glm::vec3 flat(d * level);
                const double w = 1.0 / (1.0 + double(glm::dot(flat, flat)));
                // The voxel lies this far below the crossing, in voxels.
                sum += w * (-double(d.x * down_.x + d.y * down_.y + d.z * down_.z) -
                            (crossing - 1) / 254.0);
                weight += w, ++count;
            }
        }
    }
    if (count < fewestColumns) return std::nullopt;
    return sum / weight * stepMm_;
}

}  // namespace haustra::cleansing
