#include "segmentation/metal.h"

#include "core/printed_text.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace haustra::segmentation {

std::optional<std::string> metalIn(const Volume<std::int16_t>& hu,
                                   const Volume<std::uint8_t>& content, int threads) {
    constexpr int brighterThanBoneHu = 2500;  // compact bone has 2000 at most
    constexpr double leastMl = 0.3;
    constexpr std::size_t mostPlaces = 4;
    const Grid& grid = hu.grid();
    const auto bright = voxelsWhere(grid, threads, [&](std::size_t n, glm::ivec3) {
        return hu[n] > brighterThanBoneHu && Content(content[n]) != Content::beyond;
    });
    if (bright.empty()) return std::nullopt;
    Volume<std::uint8_t> left(grid, std::uint8_t(0));
    const auto isLeft = left.writable();
    for (const std::uint32_t n : bright)
        isLeft[n] = 1;
    struct Piece {
        glm::dvec3 placeMm;
        double ml;
    };
    std::vector<Piece> pieces;
    for (const std::size_t first : bright) {
        if (!std::exchange(isLeft[first], std::uint8_t(0))) continue;
        std::vector<std::size_t> body{first};
        glm::dvec3 sum(0.0);
        for (std::size_t m = 0; m < body.size(); ++m) {
            sum += glm::dvec3(grid.voxelAt(body[m]));
            visitFaces(grid, body[m], [&](std::size_t next, int) {
                if (std::exchange(isLeft[next], std::uint8_t(0))) body.push_back(next);
            });
        }
        const double ml = double(body.size()) * grid.voxelVolumeMm3() / 1000.0;
        if (ml >= leastMl)
            pieces.push_back({grid.patientFromVoxelPoint(sum / double(body.size())), ml});
    }
    if (pieces.empty()) return std::nullopt;
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const Piece& a, const Piece& b) { return a.ml > b.ml; });
    double allMl = 0.0;
    std::string places;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
        allMl += pieces[n].ml;
        if (n < mostPlaces) places += (n == 0 ? "" : ", ") + placeText(pieces[n].placeMm);
    }
    return printed(
               "%.1f ml are brighter than bone, metal or thick barium: at the height of their "
               "streaks walls and fluid may be wrong or missing, at ",
               allMl) +
           places + (pieces.size() > mostPlaces ? " and elsewhere" : "");
}

}  // namespace haustra::segmentation
