#include "topology/islands.h"

#include "core/printed_text.h"
#include "topology/digital_topology.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

namespace haustra::topology {
namespace {

template <class Visit>
void visitRun(const MaskRun& run, const Visit& visit) {
    for (int i = run.begin; i < run.end; ++i)
        visit(glm::ivec3(i, run.j, run.k));
}

/// So much cheaper is a way through a wall than through gas, less 1.
constexpr double wallAttraction = 10.0;

glm::ivec3 faceStep(int face) {
    glm::ivec3 step(0);
    step[face / 2] = face % 2 == 0 ? -1 : 1;
    return step;
}

/// Ways from an island through the mask to the nearest background that does not float.
class StalkSearch {
public:
    StalkSearch(const BitMask& mask, const BitMask& kept, const BitMask& floating, const Grid& grid,
                const StalkTraces& traces)
        : mask_(mask), kept_(kept), floating_(floating), grid_(grid), traces_(traces) {}

    struct Stalk {
        std::vector<glm::ivec3> voxels;
        double lengthMm = 0.0;
    };

    std::optional<Stalk> from(const std::vector<MaskRun>& island) const {
        const glm::dvec3 spacing = grid_.spacingMm();
        glm::ivec3 lo = grid_.size, hi(-1);
        for (const MaskRun& run : island) {
            lo = glm::min(lo, glm::ivec3(run.begin, run.j, run.k));
            hi = glm::max(hi, glm::ivec3(run.end - 1, run.j, run.k));
        }
        const glm::ivec3 reach(glm::ceil(longestStalkMm / spacing));
        lo = glm::max(lo - reach, glm::ivec3(0)), hi = glm::min(hi + reach, grid_.size - 1);
        const Grid box{hi - lo + 1, glm::dmat4(1.0)};

        struct Arrival {
            float cost = std::numeric_limits<float>::max(), lengthMm = 0.0f;
            std::int8_t face = -1;  // that it was entered through; −1: not yet, or of the island
        };
        std::vector<Arrival> arrivals(box.voxelCount());
        // Of two ways as cheap the one through the voxel that is first in memory.
        using Entry = std::pair<float, std::size_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
        for (const MaskRun& run : island) {
            visitRun(run, [&](glm::ivec3 v) {
                const std::size_t n = box.index(v - lo);
                arrivals[n].cost = 0.0f;
                front.emplace(0.0f, n);
            });
        }
        while (!front.empty()) {
            const auto [cost, n] = front.top();
            front.pop();
            if (cost > arrivals[n].cost) continue;
            const glm::ivec3 v = box.voxelAt(n) + lo;
            if (arrivals[n].face >= 0 && bordersOnWall(v)) return wayTo(v, lo, box, arrivals);
            for (int face = 0; face < 6; ++face) {
                const glm::ivec3 w = v + faceStep(face);
                if (!box.contains(w - lo) || !mask_.test(w) || kept_.test(w)) continue;
                const double mm = spacing[face / 2];
                const auto next = float(cost + mm * costAt(w)),
                           lengthMm = float(arrivals[n].lengthMm + mm);
                Arrival& there = arrivals[box.index(w - lo)];
                if (next >= there.cost || lengthMm > longestStalkMm) continue;
                there = {next, lengthMm, std::int8_t(face)};
                front.emplace(next, box.index(w - lo));
            }
        }
        return std::nullopt;
    }

private:
    /// Of a millimetre.
    double costAt(glm::ivec3 v) const {
        if (!traces_.hu) return 1.0;
        const double hu = traces_.hu->at(v + traces_.from);
        const double wall =
            std::clamp((hu - traces_.gasHu) / (traces_.wallHu - traces_.gasHu), 0.0, 1.0);
        return 1.0 / (1.0 + wallAttraction * wall);
    }

    bool bordersOnWall(glm::ivec3 v) const {
        for (int face = 0; face < 6; ++face) {
            const glm::ivec3 w = v + faceStep(face);
            if (!mask_.test(w) && !floating_.test(w)) return true;
        }
        return false;
    }

    template <class Arrivals>
    static Stalk wayTo(glm::ivec3 v, glm::ivec3 lo, const Grid& box, const Arrivals& arrivals) {
        Stalk stalk;
        stalk.lengthMm = arrivals[box.index(v - lo)].lengthMm;
        for (int face; (face = arrivals[box.index(v - lo)].face) >= 0; v -= faceStep(face))
            stalk.voxels.push_back(v);
        return stalk;
    }

    const BitMask& mask_;
    const BitMask& kept_;
    const BitMask& floating_;
    const Grid& grid_;
    const StalkTraces& traces_;
};

}  // namespace

Islands tieOrFillIslands(BitMask& mask, const BitMask& kept, const Grid& grid,
                         const StalkTraces& traces) {
    Islands result;
    const MaskComponents cavities = cavitiesOf(mask);
    if (cavities.voxels.empty()) return result;
    BitMask floating(mask.size());
    std::vector<std::vector<MaskRun>> runs(cavities.voxels.size());
    for (const MaskRun& run : cavities.runs) {
        runs[std::size_t(run.component)].push_back(run);
        visitRun(run, [&](glm::ivec3 v) { floating.set(v); });
    }
    std::vector<std::size_t> order(runs.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return cavities.voxels[a] > cavities.voxels[b];
    });
    const StalkSearch search(mask, kept, floating, grid, traces);
    for (const std::size_t n : order) {
        const double volumeMm3 = double(cavities.voxels[n]) * grid.voxelVolumeMm3();
        if (volumeMm3 < leastIslandMm3) break;
        glm::dvec3 middle(0.0);
        for (const MaskRun& run : runs[n])
            visitRun(run, [&](glm::ivec3 v) { middle += glm::dvec3(v); });
        const glm::dvec3 at = grid.patientFromVoxelPoint(middle / double(cavities.voxels[n]));
        const auto stalk = search.from(runs[n]);
        if (!stalk) {
            result.notes.push_back(
                printed("an island of %.0f mm3 in the lumen filled, at (%.0f, %.0f, %.0f) mm: no "
                        "wall is near that it could hang on",
                        volumeMm3, at.x, at.y, at.z));
            continue;
        }
        for (const glm::ivec3 v : stalk->voxels)
            mask.reset(v);
        for (const MaskRun& run : runs[n])
            visitRun(run, [&](glm::ivec3 v) { floating.reset(v); });
        ++result.tied;
        result.notes.push_back(
            printed("an island of %.0f mm3 in the lumen tied to the wall by %.0f mm, at (%.0f, "
                    "%.0f, %.0f) mm: the head of a polyp whose stalk is not seen, or residue",
                    volumeMm3, stalk->lengthMm, at.x, at.y, at.z));
    }
    mask.add(floating);
    result.filled = long(runs.size()) - result.tied;
    return result;
}

}  // namespace haustra::topology
