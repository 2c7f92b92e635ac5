#include "topology/offshoots.h"

#include "topology/axis_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::topology {
namespace {

constexpr double dullShare = 0.85;
constexpr double smallestMl = 0.3;  // of the inside of a dull body
constexpr double openShare = 0.2;   // of its surface: what is joined over more is a patch
constexpr double clearSds = 3.0;    // of its own HU that it must be duller by: noise is not
constexpr int rimVoxels = 2;

constexpr std::uint8_t isPool = 1, isDull = 2, isDeep = 4, isTaken = 8, isSeen = 16;

}  // namespace

std::vector<std::uint32_t> dullOffshoots(const Volume<std::int16_t>& hu,
                                         std::span<const std::uint32_t> pool, double softHu,
                                         double fluidHu) {
    const Grid& grid = hu.grid();
    glm::ivec3 low(std::numeric_limits<int>::max()), high(std::numeric_limits<int>::lowest());
    for (std::uint32_t index : pool) {
        const glm::ivec3 v = grid.voxelAt(index);
        low = glm::min(low, v), high = glm::max(high, v);
    }
    if (pool.empty()) return {};
    // The pool's box with a margin of one voxel that is not pool.
    const Grid box = axisAlignedGrid(high - low + 3, grid.spacingMm());
    const auto inBox = [&](std::uint32_t index) {
        return box.index(grid.voxelAt(index) - low + 1);
    };
    std::vector<std::uint8_t> marks(box.voxelCount(), 0);
    const double dullHu = softHu + dullShare * (fluidHu - softHu);
    for (std::uint32_t index : pool)
        marks[inBox(index)] = isPool | (hu[index] < dullHu ? isDull : 0);
    const auto neighboursWith = [&](std::size_t at, std::uint8_t mark) {
        int count = 0;
        visitNeighbours(box, at, [&](std::size_t next) { count += (marks[next] & mark) != 0; });
        return count;
    };
    std::vector<std::uint32_t> deep;
    for (std::uint32_t index : pool) {
        const std::size_t at = inBox(index);
        if ((marks[at] & isDull) && neighboursWith(at, isDull) == 6)
            deep.push_back(std::uint32_t(at));
    }
    for (std::uint32_t at : deep)
        marks[at] |= isDeep;

    const std::size_t smallest = std::size_t(smallestMl * 1000.0 / grid.voxelVolumeMm3());
    std::vector<std::uint32_t> offshoots;
    for (std::uint32_t first : deep) {
        if (marks[first] & isTaken) continue;
        std::vector<std::uint32_t> body{first};
        marks[first] |= isTaken;
        const auto growOnce = [&](std::size_t from, std::uint8_t through) {
            const std::size_t end = body.size();
            for (std::size_t head = from; head < end; ++head) {
                visitNeighbours(box, body[head], [&](std::size_t next) {
                    if (!(marks[next] & through) || (marks[next] & isTaken)) return;
                    marks[next] |= isTaken;
                    body.push_back(std::uint32_t(next));
                });
            }
            return end;
        };
        for (std::size_t from = 0; from < body.size();)
            from = growOnce(from, isDeep);
        if (body.size() < smallest) continue;
        double sum = 0.0, sumOfSquares = 0.0;
        for (std::uint32_t at : body) {
            const double value = hu[grid.index(box.voxelAt(at) - 1 + low)];
            sum += value, sumOfSquares += value * value;
        }
        const double mean = sum / double(body.size());
        const double variance = sumOfSquares / double(body.size()) - mean * mean;
        if (fluidHu - mean < clearSds * std::sqrt(std::max(0.0, variance))) continue;
        std::size_t ring = 0;
        for (int layer = 0; layer < rimVoxels; ++layer)
            ring = growOnce(ring, isDull);
        std::size_t faces = 0, open = 0;
        for (std::uint32_t at : body) {
            visitNeighbours(box, at, [&](std::size_t next) {
                if (marks[next] & isTaken) return;
                ++faces;
                open += (marks[next] & (isPool | isDull)) == isPool;
            });
        }
        if (double(open) < openShare * double(faces)) {
            for (std::uint32_t at : body)
                marks[at] = isTaken;
            offshoots.insert(offshoots.end(), body.begin(), body.end());
        }
    }
    if (offshoots.empty()) return {};
    // Crumbs of the pool that hang on an offshoot alone go with it.
    std::vector<std::uint32_t> crumbs;
    for (std::size_t n = 0, end = offshoots.size(); n < end; ++n) {
        visitNeighbours(box, offshoots[n], [&](std::size_t first) {
            if (!(marks[first] & isPool) || (marks[first] & isSeen)) return;
            std::vector<std::uint32_t> crumb{std::uint32_t(first)};
            marks[first] |= isSeen;
            for (std::size_t head = 0; head < crumb.size(); ++head) {
                visitNeighbours(box, crumb[head], [&](std::size_t next) {
                    if (!(marks[next] & isPool) || (marks[next] & isSeen)) return;
                    marks[next] |= isSeen;
                    crumb.push_back(std::uint32_t(next));
                });
            }
            if (crumb.size() < end) crumbs.insert(crumbs.end(), crumb.begin(), crumb.end());
        });
    }
    offshoots.insert(offshoots.end(), crumbs.begin(), crumbs.end());
    for (std::uint32_t& at : offshoots)
        at = std::uint32_t(grid.index(box.voxelAt(at) - 1 + low));
    std::sort(offshoots.begin(), offshoots.end());
    return offshoots;
}

}  // namespace haustra::topology
