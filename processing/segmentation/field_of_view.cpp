#include "segmentation/field_of_view.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::segmentation {
namespace {

// Columns that hold the first voxel's value in every slice.
std::vector<std::uint8_t> columnsLikeTheCorner(const Volume<std::int16_t>& hu, int threads) {
    const Grid& grid = hu.grid();
    const std::size_t length = std::size_t(grid.size.x);
    std::vector<std::uint8_t> like(length * std::size_t(grid.size.y), 1);
    const std::int16_t value = hu[0];
    parallelFor(std::size_t(grid.size.y), 8, threads, [&](std::size_t first, std::size_t last) {
        for (int k = 0; k < grid.size.z; ++k) {
            for (std::size_t j = first; j < last; ++j) {
                const auto row = hu.voxels().subspan(grid.index(0, int(j), k), length);
                for (std::size_t i = 0; i < length; ++i)
                    like[j * length + i] &= std::uint8_t(row[i] == value);
            }
        }
    });
    return like;
}

}  // namespace

FieldOfView fieldOfView(const Volume<std::int16_t>& hu, int threads) {
    constexpr double unevenVoxels = 2.0, blendedVoxels = 1.0;
    const glm::ivec2 size(hu.grid().size), last = size - 1;
    const auto column = [&](glm::ivec2 c) {
        return std::size_t(c.y) * std::size_t(size.x) + std::size_t(c.x);
    };
    const glm::dvec2 spacing(hu.grid().spacingMm());
    const double voxelMm = std::max(spacing.x, spacing.y);
    const auto radiusMm = [&](glm::ivec2 c) {
        return glm::length((glm::dvec2(c) - 0.5 * glm::dvec2(last)) * spacing);
    };
    const auto forColumns = [&](const auto& visit) {
        for (glm::ivec2 c(0); c.y < size.y; ++c.y) {
            for (c.x = 0; c.x < size.x; ++c.x)
                visit(c);
        }
    };
    const std::vector<std::uint8_t> padded = columnsLikeTheCorner(hu, threads);
    FieldOfView field;
    field.beyond.assign(padded.size(), 0);
    field.rim.assign(padded.size(), 0);
    double paddedFromMm = std::numeric_limits<double>::max(), fieldToMm = 0.0;
    forColumns([&](glm::ivec2 c) {
        if (padded[column(c)])
            paddedFromMm = std::min(paddedFromMm, radiusMm(c));
        else
            fieldToMm = std::max(fieldToMm, radiusMm(c));
    });
    field.round = fieldToMm > 0.0 && fieldToMm < radiusMm(glm::ivec2(0)) &&
                  fieldToMm < paddedFromMm + unevenVoxels * voxelMm;
    if (field.round) {
        forColumns([&](glm::ivec2 c) {
            field.beyond[column(c)] = radiusMm(c) > paddedFromMm - blendedVoxels * voxelMm;
        });
    }
    forColumns([&](glm::ivec2 c) {
        if (field.beyond[column(c)]) return;
        bool atBorder = c.x == 0 || c.y == 0 || c.x == last.x || c.y == last.y;
        for (const glm::ivec2 step :
             {glm::ivec2(-1, 0), glm::ivec2(1, 0), glm::ivec2(0, -1), glm::ivec2(0, 1)})
            atBorder = atBorder || field.beyond[column(c + step)];
        field.rim[column(c)] = atBorder;
    });
    return field;
}

}  // namespace haustra::segmentation
