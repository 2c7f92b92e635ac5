#include "core/connected_labels.h"

#include "core/simple_point.h"

#include <algorithm>
#include <span>
#include <unordered_map>
#include <vector>

namespace haustra {
namespace {

constexpr std::int32_t none = -1;

struct Bodies {
    std::vector<std::int32_t> at;  ///< of each voxel, or none
    std::vector<std::size_t> sizes;
};

Bodies bodiesOf(const Grid& grid, std::span<const std::uint8_t> labels) {
    Bodies bodies{std::vector<std::int32_t>(labels.size(), none), {}};
    std::vector<std::size_t> front;
    for (std::size_t n = 0; n < labels.size(); ++n) {
        if (labels[n] == 0 || bodies.at[n] != none) continue;
        const std::int32_t number = std::int32_t(bodies.sizes.size());
        std::size_t size = 0;
        front.assign(1, n);
        bodies.at[n] = number;
        while (!front.empty()) {
            const std::size_t from = front.back();
            front.pop_back();
            ++size;
            visitFaces(grid, from, [&](std::size_t m, int) {
                if (labels[m] == 0 || bodies.at[m] != none) return;
                bodies.at[m] = number;
                front.push_back(m);
            });
        }
        bodies.sizes.push_back(size);
    }
    return bodies;
}

}  // namespace

double joinBodies(Volume<std::uint8_t>& labels, const std::function<bool(std::size_t)>& passable,
                  const std::function<std::uint8_t(std::size_t)>& labelOf,
                  const JoinBodiesOptions& options) {
    const Grid grid = labels.grid();
    const auto out = labels.writable();
    Bodies bodies = bodiesOf(grid, out);
    if (bodies.sizes.size() < 2) return 0.0;
    const double voxelMl = grid.voxelVolumeMm3() / 1000.0;
    std::vector<bool> joined(bodies.sizes.size(), false);
    joined[std::size_t(std::max_element(bodies.sizes.begin(), bodies.sizes.end()) -
                       bodies.sizes.begin())] = true;
    // Breadth first from what is joined; the first body that is met is joined by the way to it.
    for (bool more = true; more;) {
        more = false;
        std::unordered_map<std::size_t, std::size_t> cameFrom;
        std::vector<std::size_t> front;
        for (std::size_t n = 0; n < out.size(); ++n) {
            if (bodies.at[n] == none || !joined[std::size_t(bodies.at[n])]) continue;
            bool edge = false;
            visitFaces(grid, n, [&](std::size_t m, int) {
                edge = edge || (bodies.at[m] == none && passable(m));
            });
            if (edge) front.push_back(n);
        }
        for (std::size_t head = 0; head < front.size() && !more; ++head) {
            const std::size_t n = front[head];
            visitFaces(grid, n, [&](std::size_t m, int) {
                if (more) return;
                if (bodies.at[m] != none) {
                    const std::size_t met = std::size_t(bodies.at[m]);
                    if (joined[met] || double(bodies.sizes[met]) * voxelMl < options.leastMl)
                        return;
                    joined[met] = more = true;
                    for (std::size_t at = n; bodies.at[at] == none; at = cameFrom[at])
                        out[at] = labelOf(at), bodies.at[at] = std::int32_t(met);
                } else if (passable(m) && cameFrom.try_emplace(m, n).second) {
                    front.push_back(m);
                }
            });
        }
    }
    double strandedMl = 0.0;
    for (std::size_t n = 0; n < out.size(); ++n) {
        if (bodies.at[n] == none || joined[std::size_t(bodies.at[n])]) continue;
        strandedMl += voxelMl;
        if (options.dropOthers) out[n] = 0;
    }
    return strandedMl;
}

bool joinsNothing(const Volume<std::uint8_t>& labels, std::size_t index) {
    const Grid& grid = labels.grid();
    const glm::ivec3 v = grid.voxelAt(index);
    Neighbourhood around = 0;
    for (int n = 0; n < 27; ++n) {
        const glm::ivec3 w = v + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        if (grid.contains(w) && labels.at(w) != 0) around |= 1u << n;
    }
    return topologicalNumber6(around) == 1 && topologicalNumber18(around) <= 1;
}

}  // namespace haustra
