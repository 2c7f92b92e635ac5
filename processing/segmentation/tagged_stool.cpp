#include "segmentation/tagged_stool.h"

#include "segmentation/axis_walk.h"

#include <algorithm>
#include <vector>

namespace haustra::segmentation {
namespace {

constexpr double largestMl = 30.0;
constexpr double smallestContactShare = 0.25;
constexpr double smallestCoreShare = 0.1;
constexpr double wellAboveHu = 60.0;
constexpr int contactVoxels = 2;  // of partial volume between air and stool

}  // namespace

void addTaggedStool(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                    const TissueModel& tissue, std::span<const std::uint32_t> excluded) {
    const Grid& grid = labels.grid();
    const glm::ivec3 size = grid.size;
    const auto out = labels.writable();
    const std::size_t strides[3] = {1, std::size_t(size.x),
                                    std::size_t(size.x) * std::size_t(size.y)};
    const std::size_t largest = std::size_t(largestMl * 1000.0 / grid.voxelVolumeMm3());
    const double above = tissue.taggedAboveHu;
    std::vector<bool> barred(out.size(), false);
    for (std::uint32_t index : excluded)
        barred[index] = true;
    auto isStool = [&](std::size_t index) {
        return out[index] == 0 && hu[index] > above && !barred[index];
    };

    auto reaches = [&](std::size_t index, auto&& hit, auto&& visit) {
        walkAxes(grid, index, contactVoxels, hit, visit);
    };

    // Candidates: stool voxels that lumen air reaches.
    std::vector<std::uint32_t> seeds;
    for (std::size_t n = 0; n < out.size(); ++n) {
        if (out[n] != std::uint8_t(LumenLabel::air)) continue;
        const glm::ivec3 v = grid.voxelAt(n);
        bool surface = false;
        for (int axis = 0; axis < 3 && !surface; ++axis) {
            surface = (v[axis] > 0 && out[n - strides[axis]] == 0) ||
                      (v[axis] + 1 < size[axis] && out[n + strides[axis]] == 0);
        }
        if (!surface) continue;
        reaches(n, isStool,
                [&](int, int, int, std::size_t at) { seeds.push_back(std::uint32_t(at)); });
    }
    std::sort(seeds.begin(), seeds.end());
    seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());

    std::vector<bool> seen(out.size(), false);
    for (std::uint32_t seed : seeds) {
        if (seen[seed] || !isStool(seed)) continue;
        std::vector<std::uint32_t> body{seed};
        seen[seed] = true;
        // All of a body is seen, however large: what is left of bone must not pass for stool.
        for (std::size_t head = 0; head < body.size(); ++head) {
            const glm::ivec3 v = grid.voxelAt(body[head]);
            for (int axis = 0; axis < 3; ++axis) {
                for (int sign : {-1, 1}) {
                    if (v[axis] + sign < 0 || v[axis] + sign >= size[axis]) continue;
                    const std::uint32_t next = std::uint32_t(sign > 0 ? body[head] + strides[axis]
                                                                      : body[head] - strides[axis]);
                    if (seen[next] || !isStool(next)) continue;
                    seen[next] = true;
                    body.push_back(next);
                }
            }
        }
        if (body.size() < 8 || body.size() > largest) continue;
        // A coated fold is thin and no brighter than its blur: stool has an inside, well tagged.
        std::size_t core = 0;
        double sum = 0.0;
        for (std::uint32_t index : body) {
            const glm::ivec3 v = grid.voxelAt(index);
            bool inside = true;
            for (int axis = 0; axis < 3 && inside; ++axis) {
                inside = v[axis] > 0 && v[axis] + 1 < size[axis] &&
                         isStool(index - strides[axis]) && isStool(index + strides[axis]);
            }
            core += inside;
            sum += hu[index];
        }
        if (double(core) < smallestCoreShare * double(body.size()) ||
            sum < (above + wellAboveHu) * double(body.size()))
            continue;
        std::size_t faces = 0, contacts = 0;
        for (std::uint32_t index : body) {
            const glm::ivec3 v = grid.voxelAt(index);
            for (int axis = 0; axis < 3; ++axis) {
                faces += v[axis] > 0 && !isStool(index - strides[axis]);
                faces += v[axis] + 1 < size[axis] && !isStool(index + strides[axis]);
            }
            reaches(
                index, [&](std::size_t at) { return out[at] != 0 || isStool(at); },
                [&](int, int, int, std::size_t at) { contacts += out[at] != 0; });
        }
        if (double(contacts) < smallestContactShare * double(faces)) continue;
        for (std::uint32_t index : body) {
            // The partial volume on the way to the air goes with the stool.
            reaches(
                index, [&](std::size_t at) { return out[at] == std::uint8_t(LumenLabel::air); },
                [&](int axis, int sign, int step, std::size_t) {
                    std::size_t at = index;
                    for (int n = 1; n < step; ++n) {
                        at = sign > 0 ? at + strides[axis] : at - strides[axis];
                        if (out[at] == 0) out[at] = std::uint8_t(LumenLabel::tagged);
                    }
                });
            out[index] = std::uint8_t(LumenLabel::tagged);
        }
    }
}

}  // namespace haustra::segmentation
