#include "render/lumen_as_air.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haustra::render {

namespace {

constexpr int reach = 2;  // voxels over which a scanner blurs an edge
constexpr double airHu = -1000.0, softHu = 40.0;
// The lumen's share around a voxel just beyond a flat border; more means that the wall is thin.
constexpr double flatWallShare = 0.25;
constexpr double leastResidueHu = softHu + 150.0;
// Residue this pure counts as pure: its noise and texture are not the wall's.
constexpr double pureShare = 0.8;

/// What lies within `reach` voxels of one voxel.
struct Neighbourhood {
    int residueDistance = reach + 1;  ///< Chebyshev, to the nearest tagged voxel
    bool air = false;
    bool outside = false;
    double residueHu = airHu;  ///< of the densest tagged voxel
    double lumenShare = 0.0;   ///< of the nearest 27, binomial weights
};

Neighbourhood lookAround(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& lumen,
                         glm::ivec3 at) {
    const Grid& grid = ct.grid();
    Neighbourhood found;
    double weights = 0.0;
    for (int dz = -reach; dz <= reach; ++dz) {
        for (int dy = -reach; dy <= reach; ++dy) {
            for (int dx = -reach; dx <= reach; ++dx) {
                const glm::ivec3 v = at + glm::ivec3(dx, dy, dz);
                if (!grid.contains(v)) continue;
                const std::size_t index = grid.index(v);
                const auto label = LumenLabel(lumen[index]);
                const int distance = std::max({std::abs(dx), std::abs(dy), std::abs(dz)});
                if (label == LumenLabel::tagged) {
                    found.residueDistance = std::min(found.residueDistance, distance);
                    found.residueHu = std::max(found.residueHu, double(ct[index]));
                }
                found.air = found.air || label == LumenLabel::air;
                found.outside = found.outside || label == LumenLabel::outside;
                if (distance <= 1) {
                    const double weight =
                        (2 - std::abs(dx)) * (2 - std::abs(dy)) * (2 - std::abs(dz));
                    weights += weight;
                    if (label != LumenLabel::outside) found.lumenShare += weight;
                }
            }
        }
    }
    found.lumenShare /= weights;
    return found;
}

double replaced(double hu, LumenLabel label, const Neighbourhood& near) {
    const auto mixed = [](double airShare) { return softHu + airShare * (airHu - softHu); };
    // Labelled, but no denser than a wall: then a wall it is.
    if (near.residueHu < leastResidueHu) return hu;
    // Where residue meets air HU runs through every tissue's value and tells nothing: only the
    // labels do. A wall between air and another loop's residue is all blur, and yet closed.
    if (near.air) {
        if (label == LumenLabel::outside)
            return std::min(hu, mixed(std::min(near.lumenShare, flatWallShare)));
        return near.outside ? std::min(hu, mixed(near.lumenShare)) : airHu;
    }
    double share = std::clamp((hu - softHu) / (near.residueHu - softHu) / pureShare, 0.0, 1.0);
    // Beyond the labels' border at most its half: what is dense there may be other tagged bowel.
    if (label == LumenLabel::outside)
        share = std::min(share, near.residueDistance == 1 ? 0.5 : 0.15);
    return share > 0.0 ? mixed(share) : std::min(hu, softHu);
}

/// 1 where a tagged voxel lies within `reach` along every axis.
std::vector<std::uint8_t> nearTagged(const Volume<std::uint8_t>& lumen, int threads) {
    const Grid& grid = lumen.grid();
    std::vector<std::uint8_t> near(grid.voxelCount()), next(grid.voxelCount());
    parallelFor(near.size(), 1 << 18, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            near[i] = LumenLabel(lumen[i]) == LumenLabel::tagged;
    });
    // A box dilates one axis after the other: rows along memory, whatever the axis.
    const std::size_t rows = std::size_t(grid.size.y) * std::size_t(grid.size.z),
                      width = std::size_t(grid.size.x);
    for (int axis = 0; axis < 3; ++axis) {
        parallelFor(rows, 256, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t r = begin; r < end; ++r) {
                const int y = int(r % std::size_t(grid.size.y)),
                          z = int(r / std::size_t(grid.size.y));
                std::uint8_t* out = &next[r * width];
                std::fill(out, out + width, std::uint8_t(0));
                for (int d = -reach; d <= reach; ++d) {
                    const int oy = axis == 1 ? y + d : y, oz = axis == 2 ? z + d : z;
                    if (oy < 0 || oy >= grid.size.y || oz < 0 || oz >= grid.size.z) continue;
                    const std::uint8_t* in = &near[grid.index(0, oy, oz)];
                    const int shift = axis == 0 ? d : 0;
                    const int first = std::max(0, -shift),
                              last = std::min(int(width), int(width) - shift);
                    for (int x = first; x < last; ++x)
                        out[x] |= in[x + shift];
                }
            }
        });
        near.swap(next);
    }
    return near;
}

}  // namespace

Volume<std::int16_t> lumenAsAir(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& lumen,
                                int threads) {
    Volume<std::int16_t> cleared = ct.clone();
    const std::vector<std::uint8_t> near = nearTagged(lumen, threads);
    const std::span<std::int16_t> out = cleared.writable();
    parallelFor(near.size(), 1 << 16, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!near[i]) continue;
            const Neighbourhood around = lookAround(ct, lumen, ct.grid().voxelAt(i));
            out[i] = std::int16_t(std::lround(replaced(ct[i], LumenLabel(lumen[i]), around)));
        }
    });
    return cleared;
}

}  // namespace haustra::render
