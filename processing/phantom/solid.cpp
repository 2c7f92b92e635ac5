#include "phantom/solid.h"

#include "phantom/implicit.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>

namespace haustra::phantom {

std::function<double(glm::dvec3, double)> tissue(double hu, double textureHu, std::uint64_t seed,
                                                 double featureMm) {
    return [=](glm::dvec3 p, double) {
        return textureHu > 0.0 ? hu + textureHu * valueNoise(seed, p, featureMm) : hu;
    };
}

std::function<double(glm::dvec3, double)> bone(double cortexMm, double cortexHu, double spongyHu,
                                               std::uint64_t seed) {
    return [=](glm::dvec3 p, double d) {
        return d > -cortexMm ? cortexHu : spongyHu + 60.0 * valueNoise(seed, p, 4.0);
    };
}

void paintSlice(const std::vector<Solid>& solids, const Grid& grid, const ColonField& colon,
                int colonK, int k, float* slice, std::uint8_t* sites) {
    const glm::dvec3 spacing = grid.spacingMm();
    const double width = std::cbrt(spacing.x * spacing.y * spacing.z);
    const glm::dvec3 origin = grid.patientFromVoxelPoint({0, 0, k});
    for (const Solid& solid : solids) {
        if (origin.z < solid.lowMm.z || origin.z > solid.highMm.z) continue;
        const int i0 = std::max(0, int(std::ceil((solid.lowMm.x - origin.x) / spacing.x)));
        const int i1 =
            std::min(grid.size.x - 1, int(std::floor((solid.highMm.x - origin.x) / spacing.x)));
        const int j0 = std::max(0, int(std::ceil((solid.lowMm.y - origin.y) / spacing.y)));
        const int j1 =
            std::min(grid.size.y - 1, int(std::floor((solid.highMm.y - origin.y) / spacing.y)));
        for (int j = j0; j <= j1; ++j) {
            for (int i = i0; i <= i1; ++i) {
                const glm::dvec3 p = origin + glm::dvec3(i * spacing.x, j * spacing.y, 0.0);
                double d = solid.distance(p);
                if (d >= width) continue;
                if (solid.clearOfColonMm > 0.0)
                    d = std::max(d, solid.clearOfColonMm - colon.at(i, j, colonK).lumenMm);
                const double share = coverage(d, width);
                if (share <= 0.0) continue;
                const std::size_t at = std::size_t(j) * grid.size.x + i;
                if (d < 0.0) sites[at] = d < -solid.siteBelowMm ? solid.site : 0;
                float& voxel = slice[at];
                voxel += float(share * (solid.hu(p, std::min(d, 0.0)) - voxel));
            }
        }
    }
}

}  // namespace haustra::phantom
