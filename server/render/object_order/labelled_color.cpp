#include "render/object_order/labelled_color.h"

#include "core/parallel.h"
#include "core/srgb.h"
#include "core/voxel_sweep.h"
#include "render/object_order/cell_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::render {

namespace {

const std::array<double, 256>& linearOfByte() {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> made{};
        for (std::size_t i = 0; i < made.size(); ++i)
            made[i] = linearLight(double(i) / 255.0);
        return made;
    }();
    return table;
}

}  // namespace

Result<LabelledColorVolume> makeLabelledColor(Volume<Rgba> color, Volume<std::int16_t> labels) {
    TRY(checkGrid(color.grid(), "colour volume"));
    if (!labels.empty() && !sameGrid(color.grid(), labels.grid()))
        return fail(ErrorKind::badInput, "the labels are not on the colours' grid",
                    "colour volume");
    return LabelledColorVolume{std::move(color), std::move(labels)};
}

glm::dvec3 luvOf(Rgba color) {
    const auto& linear = linearOfByte();
    const glm::dvec3 rgb(linear[color.r], linear[color.g], linear[color.b]);
    // IEC 61966-2-1; the white is what equal channels make.
    const glm::dvec3 x(0.4124, 0.3576, 0.1805), y(0.2126, 0.7152, 0.0722),
        z(0.0193, 0.1192, 0.9505);
    const glm::dvec3 xyz(glm::dot(x, rgb), glm::dot(y, rgb), glm::dot(z, rgb));
    const auto chromaticity = [](glm::dvec3 of) {
        const double sum = of.x + 15.0 * of.y + 3.0 * of.z;
        return sum > 0.0 ? glm::dvec2(4.0 * of.x, 9.0 * of.y) / sum : glm::dvec2(0.0);
    };
    const glm::dvec3 white(x.x + x.y + x.z, 1.0, z.x + z.y + z.z);
    const double lightness =
        xyz.y > 216.0 / 24389.0 ? 116.0 * std::cbrt(xyz.y) - 16.0 : 24389.0 / 27.0 * xyz.y;
    if (lightness <= 0.0) return glm::dvec3(0.0);
    return {lightness, 13.0 * lightness * (chromaticity(xyz) - chromaticity(white))};
}

Volume<Rgba> withColorOpacity(const Volume<Rgba>& color, const Volume<std::int16_t>& labels,
                              const ColorOpacity& rule, int threads) {
    const Grid& grid = color.grid();
    const glm::ivec3 last = grid.size - 1;
    Volume<Rgba> made(grid);
    const auto voxels = made.writable();
    const std::size_t slice = std::size_t(grid.size.x) * std::size_t(grid.size.y);
    parallelFor(std::size_t(grid.size.z), 1, threads, [&](std::size_t begin, std::size_t end) {
        // L*u*v* of the slices before, of, and after this one: each is computed thrice at most.
        std::vector<glm::vec3> luv[3];
        for (int z = int(begin); z < int(end); ++z) {
            for (int k = 0; k < 3; ++k) {
                const auto from = color.voxels().subspan(
                    slice * std::size_t(glm::clamp(z + k - 1, 0, last.z)), slice);
                luv[k].resize(slice);
                std::transform(from.begin(), from.end(), luv[k].begin(),
                               [](Rgba one) { return glm::vec3(luvOf(one)); });
            }
            for (int y = 0; y <= last.y; ++y)
                for (int x = 0; x <= last.x; ++x) {
                    const auto at = [&](int i, int j) {
                        return std::size_t(glm::clamp(i, 0, last.x)) +
                               std::size_t(grid.size.x) * std::size_t(glm::clamp(j, 0, last.y));
                    };
                    const glm::vec3 dx = luv[1][at(x + 1, y)] - luv[1][at(x - 1, y)];
                    const glm::vec3 dy = luv[1][at(x, y + 1)] - luv[1][at(x, y - 1)];
                    const glm::vec3 dz = luv[2][at(x, y)] - luv[0][at(x, y)];
                    const double length =
                        std::sqrt(double(glm::dot(dx, dx) + glm::dot(dy, dy) + glm::dot(dz, dz)));
                    const std::size_t voxel = grid.index(x, y, z);
                    const bool labelled = !labels.empty() && labels[voxel] != 0;
                    const bool isDark = luv[1][at(x, y)].x < float(rule.dark);
                    const double opacity =
                        isDark ? 0.0
                               : std::max(rule.gain *
                                              std::pow(length / rule.atDifference, rule.exponent),
                                          labelled ? rule.least : 0.0);
                    Rgba is = color[voxel];
                    is.a = std::uint8_t(std::lround(255.0 * std::clamp(opacity, 0.0, 1.0)));
                    voxels[voxel] = is;
                }
        }
    });
    return made;
}

std::vector<std::vector<std::int16_t>> labelsOfCells(const LabelledColorVolume& volume, int side,
                                                     int threads) {
    const Grid& grid = volume.grid();
    const CellGrid cells{grid.size, side};
    std::vector<std::vector<std::int16_t>> lists(std::size_t(cells.cells()));
    parallelFor(lists.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t index = begin; index < end; ++index) {
            const glm::ivec3 from = cells.cellAt(int(index)) * side;
            const glm::ivec3 to = glm::min(from + side, grid.size - 1);
            std::vector<bool> seen(1 << 16, false);
            std::int16_t before = 0;
            bool any = false;
            visitBox(from, to, [&](glm::ivec3 v) {
                const std::int16_t label = volume.labelAt(grid.index(v));
                if (any && label == before) return;
                any = true;
                before = label;
                seen[std::size_t(label + 32768)] = true;
            });
            for (std::size_t label = 0; label < seen.size(); ++label)
                if (seen[label]) lists[index].push_back(std::int16_t(int(label) - 32768));
        }
    });
    return lists;
}

}  // namespace haustra::render
