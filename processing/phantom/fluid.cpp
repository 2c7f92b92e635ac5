#include "phantom/fluid.h"

#include "phantom/implicit.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>

namespace haustra::phantom {
namespace {

constexpr double noFloor = 1e9;
/// Over which a meniscus falls off: the capillary length of water.
constexpr double meniscusMm = 2.7;
/// Bowel fluid without tagging.

/// Lowest and highest lumen voxel at each sample of the axis.
void floorAndCeiling(const ColonShape& shape, const ColonField& field, const Fluid& fluid,
                     std::vector<double>& floor, std::vector<double>& ceiling) {
    const ColonPath& path = shape.path();
    floor.assign(path.samples.size(), noFloor);
    ceiling.assign(path.samples.size(), -noFloor);
    for (int b = 0; b < field.blockCount(); ++b) {
        const auto& samples = field.block(b);
        for (int v = 0; v < ColonField::blockVoxels; ++v) {
            if (samples[v].lumenMm >= 0.0f) continue;
            const int n = ColonField::blockSize;
            const glm::ivec3 voxel =
                field.blockOrigin(b) + glm::ivec3(v % n, v / n % n, v / (n * n));
            const double height = fluid.heightMm(field.grid().patientFromVoxelPoint(voxel));
            const std::size_t at =
                std::min(std::size_t(samples[v].arcMm / path.stepMm + 0.5), floor.size() - 1);
            floor[at] = std::min(floor[at], height);
            ceiling[at] = std::max(ceiling[at], height);
        }
    }
}

/// Arcs (as sample numbers) of the summits of the floor that separate bays: those at least
/// `prominence` above the lowest floor on each side. The lowest summit goes first.
std::vector<int> summits(const std::vector<double>& floor, double prominence) {
    const int count = int(floor.size());
    std::vector<int> borders = {0};
    std::vector<int> peaks;
    for (int n = 1; n + 1 < count; ++n) {
        if (floor[n] >= floor[n - 1] && floor[n] > floor[n + 1]) peaks.push_back(n);
    }
    auto lowest = [&](int from, int to) {
        return *std::min_element(floor.begin() + from, floor.begin() + to + 1);
    };
    while (!peaks.empty()) {
        std::size_t weakest = 0;
        double least = 1e18;
        for (std::size_t k = 0; k < peaks.size(); ++k) {
            const int from = k > 0 ? peaks[k - 1] : 0,
                      to = k + 1 < peaks.size() ? peaks[k + 1] : count - 1;
            const double rise =
                floor[peaks[k]] - std::max(lowest(from, peaks[k]), lowest(peaks[k], to));
            if (rise < least) least = rise, weakest = k;
        }
        if (least >= prominence) break;
        peaks.erase(peaks.begin() + std::ptrdiff_t(weakest));
    }
    borders.insert(borders.end(), peaks.begin(), peaks.end());
    borders.push_back(count - 1);
    return borders;
}

}  // namespace

double Pool::levelAt(double lumenMm) const {
    return levelMm + riseMm * std::exp(std::min(0.0, lumenMm) / meniscusMm);
}

double Pool::taggedShareAt(double heightMm) const {
    if (!tagged) return 0.0;
    if (waterMm <= 0.0) return 1.0;
    return 1.0 - smoothstep(-1.5, 1.5, heightMm - (levelMm - waterMm));
}

double Pool::huAt(glm::dvec3 p, double heightMm) const {
    if (stool) {
        const double crumb = valueNoise(seed, p, 5.0);
        return crumb > 0.45 ? -450.0 : 25.0 + 45.0 * crumb;
    }
    const double depth = std::min(1.0, std::max(0.0, levelMm - heightMm) / 40.0);
    const double blotches = 0.7 * valueNoise(seed, p, 14.0) + 0.3 * valueNoise(seed + 1, p, 5.0);
    const double here = hu * (1.0 + unevenness * (0.35 * blotches + 0.3 * (depth - 0.5)));
    return waterMm > 0.0 ? glm::mix(waterHu, here, taggedShareAt(heightMm)) : here;
}

const Pool& Fluid::poolAt(double arcMm) const {
    for (const Pool& pool : pools) {
        if (arcMm < pool.endMm) return pool;
    }
    return pools.back();
}

Fluid pourFluid(const ColonShape& shape, const ColonField& field, std::uint64_t seed, Preset preset,
                const BodyPlan& body, const BowelOptions& bowel) {
    Random kinds(seed, 22 + 100 * std::uint64_t(body.position));
    Random random(seed, 4 + 100 * std::uint64_t(body.position)),
        menisci(seed, 8 + 100 * std::uint64_t(body.position));
    Fluid fluid;
    fluid.up = -gravityDirection(body.position);
    std::vector<double> floor, ceiling;
    floorAndCeiling(shape, field, fluid, floor, ceiling);
    // A collapsed stretch has no floor: it is a dam.
    const int count = int(floor.size());
    std::vector<double> smooth(floor.size());
    for (int n = 0; n < count; ++n) {
        double lowest = noFloor;
        for (int m = std::max(0, n - 3); m <= std::min(count - 1, n + 3); ++m)
            lowest = std::min(lowest, floor[m]);
        smooth[n] = lowest;
    }
    const double step = shape.path().stepMm;
    const std::vector<int> borders = summits(smooth, 5.0);
    for (std::size_t b = 0; b + 1 < borders.size(); ++b) {
        const int from = borders[b], to = borders[b + 1];
        Pool pool;
        pool.beginMm = from * step, pool.endMm = b + 2 == borders.size() ? 1e9 : to * step;
        pool.seed = random.bits();
        const bool easy = preset == Preset::easy, hard = preset == Preset::hard;
        pool.hu = hard ? random.uniform(220.0, 400.0) : random.uniform(450.0, 850.0);
        pool.riseMm = menisci.uniform(0.4, 1.6);
        pool.unevenness = easy ? 0.05 : hard ? 1.0 : 0.4;
        const double wantedMm = easy ? random.uniform(3.0, 12.0) : random.uniform(12.0, 45.0);
        const bool empty = random.chance(easy ? 0.3 : 0.08);

        double bottom = noFloor, top = -noFloor;
        for (int n = from; n <= to; ++n)
            bottom = std::min(bottom, smooth[n]), top = std::max(top, ceiling[n]);
        // The ends of the colon are closed; a summit within it spills.
        double spill = top - 6.0;
        if (from > 0) spill = std::min(spill, smooth[from] - 2.5);
        if (to < count - 1) spill = std::min(spill, smooth[to] - 2.5);
        // Drawn whether wanted or not, so that one share does not move another.
        const double untagged = kinds.uniform(), layered = kinds.uniform(), full = kinds.uniform();
        const double depth = kinds.uniform(0.25, 0.7);
        const bool filled = full < bowel.full;
        if (filled) {
            // Closed ends hold fluid however high it stands.
            const bool closedBelow = from == 0 || smooth[from] >= noFloor,
                       closedAbove = to == count - 1 || smooth[to] >= noFloor;
            if (closedBelow && closedAbove) spill = top + 10.0;
        }
        const double level = filled ? spill : std::min(spill, bottom + wantedMm);
        if (!bowel.insufflated) {
            // Nobody has drunk a tagging agent; stool stands on the right.
            pool.tagged = false;
            pool.stool = (from + to) * 0.5 * step > shape.path().transverseEndMm - 60.0;
            pool.hu = waterHu;
        } else if (untagged < bowel.untagged) {
            pool.tagged = false;
            pool.hu = waterHu;
            pool.unevenness = 0.2;
        } else if (layered < bowel.layered) {
            pool.waterMm = depth * std::max(0.0, level - bottom);
        }
        if ((filled || !empty) && bottom < noFloor && level > bottom + 2.0) pool.levelMm = level;
        fluid.pools.push_back(pool);
    }
    return fluid;
}

}  // namespace haustra::phantom
