#include "segmentation/metal.h"

#include "core/printed_text.h"
#include "core/voxel_sweep.h"
#include "segmentation/told_places.h"

#include <algorithm>
#include <utility>

namespace haustra::segmentation {
namespace {

/// Pieces of these voxels, joined by corners too as the wires of a mesh are, the largest first.
std::vector<BrightBody> bodiesOf(const std::vector<std::uint32_t>& bright, const Grid& grid) {
    constexpr double leastMl = 0.3;
    std::vector<BrightBody> bodies;
    if (bright.empty()) return bodies;
    Volume<std::uint8_t> left(grid, std::uint8_t(0));
    const auto isLeft = left.writable();
    for (const std::uint32_t n : bright)
        isLeft[n] = 1;
    for (const std::size_t first : bright) {
        if (!std::exchange(isLeft[first], std::uint8_t(0))) continue;
        std::vector<std::size_t> body{first};
        glm::dvec3 sum(0.0);
        for (std::size_t m = 0; m < body.size(); ++m) {
            const glm::ivec3 v = grid.voxelAt(body[m]);
            sum += glm::dvec3(v);
            visitBox(glm::max(v - 1, glm::ivec3(0)), glm::min(v + 1, grid.size - 1),
                     [&](glm::ivec3 beside) {
                         const std::size_t next = grid.index(beside);
                         if (std::exchange(isLeft[next], std::uint8_t(0))) body.push_back(next);
                     });
        }
        const double ml = double(body.size()) * grid.voxelVolumeMm3() / 1000.0;
        if (ml >= leastMl)
            bodies.push_back({grid.patientFromVoxelPoint(sum / double(body.size())), ml});
    }
    std::stable_sort(bodies.begin(), bodies.end(),
                     [](const BrightBody& a, const BrightBody& b) { return a.ml > b.ml; });
    return bodies;
}

}  // namespace

std::optional<std::string> metalIn(const Volume<std::int16_t>& hu,
                                   const Volume<std::uint8_t>& content, int threads) {
    constexpr int brighterThanBoneHu = 2500;  // compact bone has 2000 at most
    const auto bodies = bodiesOf(voxelsWhere(hu.grid(), threads,
                                             [&](std::size_t n, glm::ivec3) {
                                                 return hu[n] > brighterThanBoneHu &&
                                                        Content(content[n]) != Content::beyond;
                                             }),
                                 hu.grid());
    if (bodies.empty()) return std::nullopt;
    double allMl = 0.0;
    ToldPlaces places(4);
    for (const BrightBody& body : bodies)
        allMl += body.ml, places.add(body.placeMm);
    return printed(
               "%.1f ml are brighter than bone, as metal and thick barium are: at the height of "
               "their streaks walls and fluid may be wrong or missing, at ",
               allMl) +
           places.text();
}

std::vector<BrightBody> metalAtLumen(const Volume<std::int16_t>& hu,
                                     const Volume<std::uint8_t>& labels, int threads) {
    constexpr int blurredWireHu = 1500;
    constexpr double reachMm = 3.0;
    const Grid& grid = hu.grid();
    // What reaches the lumen across one face is at it, however thick the slices are.
    const glm::dvec3 voxelMm = grid.spacingMm(), farthestMm = glm::max(voxelMm, reachMm);
    const glm::ivec3 reach(glm::ceil(farthestMm / voxelMm));
    const auto isAtLumen = [&](glm::ivec3 v) {
        return anyInBox(glm::max(v - reach, glm::ivec3(0)), glm::min(v + reach, grid.size - 1),
                        [&](glm::ivec3 w) {
                            return LumenLabel(labels.at(w)) != LumenLabel::outside &&
                                   glm::length(glm::dvec3(w - v) * voxelMm / farthestMm) <= 1.0;
                        });
    };
    return bodiesOf(voxelsWhere(grid, threads,
                                [&](std::size_t n, glm::ivec3 v) {
                                    return hu[n] > blurredWireHu && isAtLumen(v);
                                }),
                    grid);
}

}  // namespace haustra::segmentation
