#include "cleansing/menisci.h"

#include "cleansing/ball.h"
#include "core/connected_labels.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haustra::cleansing {
namespace {

/// `mm`, or so many voxels where they are longer: a segmentation falls short by whole voxels.
double reachMm(const Grid& grid, double mm, double voxels) {
    return std::max(mm, voxels * std::cbrt(grid.voxelVolumeMm3()));
}

bool airNear(const Volume<std::uint8_t>& labels, glm::ivec3 v, glm::ivec3 reach) {
    const glm::ivec3 lo = glm::max(v - reach, glm::ivec3(0)),
                     hi = glm::min(v + reach, labels.grid().size - 1);
    return anyInBox(lo, hi,
                    [&](glm::ivec3 w) { return LumenLabel(labels.at(w)) == LumenLabel::air; });
}

/// Densest HU of the pool around one of its voxels.
int rimHu(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& labels, glm::ivec3 v) {
    const glm::ivec3 look = neighbourStep(labels.grid());
    const glm::ivec3 lo = glm::max(v - look, glm::ivec3(0)),
                     hi = glm::min(v + look, labels.grid().size - 1);
    int most = hu.at(v);
    visitBox(lo, hi, [&](glm::ivec3 w) {
        if (LumenLabel(labels.at(w)) == LumenLabel::tagged) most = std::max<int>(most, hu.at(w));
    });
    return most;
}

}  // namespace

LabelledMenisci withMenisci(const CtScan& scan, const TissueModel& tissue,
                            const Volume<std::uint8_t>& segmentation) {
    const Grid& grid = scan.hu.grid();
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    LabelledMenisci menisci{segmentation.clone(), {}};
    Volume<std::uint8_t>& labels = menisci.labels;
    const auto out = labels.writable();
    struct Rim {
        glm::ivec3 voxel;
        double leastHu;
        double mm;  ///< of the way to it
    };
    std::vector<Rim> front, next;
    const glm::dvec3 spacing = grid.spacingMm();
    const double farthestMm = reachMm(grid, 4.5, 6.0),  // from the pool, along the grid's axes
        laggingMm = reachMm(grid, 1.5, 2.0);  // that it may fall short of the half-way surface
    const glm::ivec3 airWithin = voxelsIn(grid, reachMm(grid, 3.0, 4.0));
    const auto spread = [&](glm::ivec3 v, double mm, auto&& leastHuOf) {
        for (int axis = 0; axis < 3; ++axis) {
            for (int side = -1; side <= 1; side += 2) {
                glm::ivec3 n = v;
                n[axis] += side;
                if (!grid.contains(n)) continue;
                const std::size_t index = grid.index(n);
                if (LumenLabel(out[index]) != LumenLabel::outside ||
                    scan.hu[index] <= tissue.taggedAboveHu)
                    continue;
                const double least = leastHuOf();
                if (scan.hu[index] <= least) continue;
                const bool first =
                    mm == 0.0;  // a voxel may be larger than what a label falls short
                const double there = mm + spacing[axis];
                if (!first && there > farthestMm) continue;
                if (!first && there > laggingMm + 0.5 * spacing[axis] &&
                    !airNear(segmentation, n, airWithin))
                    continue;
                if (!joinsNothing(labels, index)) continue;  // there may be a wall too thin to show
                out[index] = std::uint8_t(LumenLabel::tagged);
                menisci.added.push_back(std::uint32_t(index));
                next.push_back({n, least, there});
            }
        }
    };
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (LumenLabel(segmentation[n]) != LumenLabel::tagged) continue;
        const glm::ivec3 v = grid.voxelAt(n);
        spread(v, 0.0, [&] { return 0.5 * (softHu + rimHu(scan.hu, segmentation, v)); });
    }
    while (!next.empty()) {
        front.swap(next);
        next.clear();
        for (const Rim& rim : front)
            spread(rim.voxel, rim.mm, [&] { return rim.leastHu; });
    }
    std::sort(menisci.added.begin(), menisci.added.end());
    return menisci;
}

}  // namespace haustra::cleansing
