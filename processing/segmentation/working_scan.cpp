#include "segmentation/working_scan.h"

#include "core/connected_labels.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haustra::segmentation {
namespace {

constexpr double coarsestMm = 0.8;
constexpr double aroundMm = 60.0, alongMm = 80.0;

constexpr auto outsideCode = std::uint8_t(LumenLabel::outside),
               airCode = std::uint8_t(LumenLabel::air),
               taggedCode = std::uint8_t(LumenLabel::tagged),
               untaggedCode = std::uint8_t(LumenLabel::untagged);

}  // namespace

Grid binned(const Grid& grid, glm::ivec3 by) {
    Grid made = grid;
    made.size = (grid.size + by - 1) / by;
    for (int axis = 0; axis < 3; ++axis)
        made.patientFromVoxel[axis] *= double(by[axis]);
    made.patientFromVoxel[3] =
        glm::dvec4(grid.patientFromVoxelPoint(0.5 * glm::dvec3(by - 1)), 1.0);
    return made;
}

glm::ivec3 binningOf(const Grid& grid) {
    return glm::max(glm::ivec3(1), glm::ivec3(glm::floor(coarsestMm / grid.spacingMm() + 1e-6)));
}

Volume<std::int16_t> binned(const Volume<std::int16_t>& hu, glm::ivec3 by, int threads) {
    if (by == glm::ivec3(1)) return hu.share();
    const Grid& fine = hu.grid();
    Volume<std::int16_t> made(binned(fine, by));
    const Grid& grid = made.grid();
    const auto out = made.writable();
    const std::size_t rows = std::size_t(grid.size.y) * std::size_t(grid.size.z);
    parallelFor(rows, 16, threads, [&](std::size_t first, std::size_t last) {
        std::vector<int> sum(std::size_t(grid.size.x));
        for (std::size_t r = first; r < last; ++r) {
            std::fill(sum.begin(), sum.end(), 0);
            const glm::ivec3 start = grid.voxelAt(r * std::size_t(grid.size.x));
            const glm::ivec3 lo = start * by, hi = glm::min(lo + by, fine.size);
            visitBox(lo, {lo.x, hi.y - 1, hi.z - 1}, [&](glm::ivec3 rowStart) {
                const std::int16_t* row = &hu.voxels()[fine.index(rowStart)];
                for (int i = 0; i < fine.size.x; ++i)
                    sum[std::size_t(i / by.x)] += row[i];
            });
            const int across = (hi.y - lo.y) * (hi.z - lo.z);
            for (int x = 0; x < grid.size.x; ++x) {
                const int count = across * (std::min((x + 1) * by.x, fine.size.x) - x * by.x);
                out[grid.index(x, start.y, start.z)] =
                    std::int16_t(std::lround(double(sum[std::size_t(x)]) / count));
            }
        }
    });
    return made;
}

VoxelBox bowelBox(const Volume<std::uint8_t>& content, std::span<const glm::dvec3> alsoMm,
                  int threads) {
    const Grid& grid = content.grid();
    // Two voxels deep along every axis: no speck.
    constexpr int deep = 2;
    std::vector<VoxelBox> slices(std::size_t(grid.size.z), {grid.size, glm::ivec3(-1)});
    const std::ptrdiff_t strides[3] = {1, grid.size.x, std::ptrdiff_t(grid.size.x) * grid.size.y};
    parallelFor(slices.size(), 1, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = std::max<std::size_t>(deep, first);
             k < std::min(last, slices.size() - std::min<std::size_t>(slices.size(), deep)); ++k) {
            for (int j = deep; j + deep < grid.size.y; ++j) {
                for (int i = deep; i + deep < grid.size.x; ++i) {
                    const std::uint8_t* at = &content.voxels()[grid.index(i, j, int(k))];
                    bool gas = Content(*at) == Content::gas;
                    for (int axis = 0; axis < 3 && gas; ++axis) {
                        gas = Content(at[-deep * strides[axis]]) == Content::gas &&
                              Content(at[deep * strides[axis]]) == Content::gas;
                    }
                    if (!gas) continue;
                    // `size` holds the last voxel until the boxes are one.
                    slices[k].lo = glm::min(slices[k].lo, glm::ivec3(i, j, int(k)));
                    slices[k].size = glm::max(slices[k].size, glm::ivec3(i, j, int(k)));
                }
            }
        }
    });
    glm::ivec3 lo = grid.size, hi(-1);
    for (const VoxelBox& slice : slices)
        lo = glm::min(lo, slice.lo), hi = glm::max(hi, slice.size);
    for (const glm::dvec3 p : alsoMm) {
        const glm::ivec3 v = glm::clamp(glm::ivec3(glm::round(grid.voxelFromPatientPoint(p))),
                                        glm::ivec3(0), grid.size - 1);
        lo = glm::min(lo, v), hi = glm::max(hi, v);
    }
    if (hi.x < 0) return {glm::ivec3(0), grid.size};
    return boxWithin(grid, lo, hi, {aroundMm, aroundMm, alongMm});
}

BowelContents cropped(const BowelContents& contents, const VoxelBox& box, int threads) {
    BowelContents part;
    // Pools and cuts are marked in it: a copy, also where the box is all of it.
    part.content = croppedCopy(contents.content, box, threads);
    part.levels = contents.levels;
    for (Level& level : part.levels) {
        for (LevelColumn& column : level.columns)
            column.above -= box.lo, column.below -= box.lo;
        std::erase_if(level.columns, [&](const LevelColumn& column) {
            return !part.content.grid().contains(column.above) ||
                   !part.content.grid().contains(column.below);
        });
        const double before = contents.down.heightOf(box.lo);
        level.height -= int(std::lround(before));
        level.heightMm -= before * contents.content.grid().spacingMm()[contents.down.axis];
    }
    part.down = contents.down, part.gravity = contents.gravity;
    part.gasHu = contents.gasHu, part.gasSdHu = contents.gasSdHu;
    part.notes = contents.notes, part.warnings = contents.warnings;
    return part;
}

Volume<std::uint8_t> atFullResolution(const Volume<std::uint8_t>& labels,
                                      const Volume<std::uint8_t>& barred,
                                      const Volume<std::int16_t>& hu, glm::ivec3 by,
                                      double airBelowHu, int threads) {
    const Grid& grid = hu.grid();
    Volume<std::uint8_t> fine(grid);
    const auto out = fine.writable();
    const auto isWrong = [&](std::size_t n) {
        return out[n] == airCode ? hu[n] >= airBelowHu
                                 : out[n] == outsideCode && hu[n] < airBelowHu;
    };
    parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                const std::size_t row = grid.index(0, j, int(k));
                const std::size_t coarse = labels.grid().index(0, j / by.y, int(k) / by.z);
                for (int i = 0; i < grid.size.x; ++i)
                    out[row + std::size_t(i)] = labels[coarse + std::size_t(i / by.x)];
            }
        }
    });
    const auto isBarred = [&](glm::ivec3 v) { return barred.at(v / by) != 0; };
    const auto touches = [&](std::size_t n, const auto& holds) {
        bool any = false;
        visitFaces(grid, n, [&](std::size_t m, int) { any = any || holds(out[m]); });
        return any;
    };
    // Voxels on the wrong side of the border, slice by slice; then what each move
    // lays bare.
    std::vector<std::vector<std::uint32_t>> slices(std::size_t(grid.size.z));
    parallelFor(slices.size(), 4, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            const std::size_t begin = grid.index(0, 0, int(k)),
                              end = begin + std::size_t(grid.size.x) * std::size_t(grid.size.y);
            for (std::size_t n = begin; n < end; ++n) {
                if (!isWrong(n)) continue;
                const std::uint8_t label = out[n];
                if (touches(n, [&](std::uint8_t l) {
                        return label == airCode ? l != airCode : l == airCode;
                    }))
                    slices[k].push_back(std::uint32_t(n));
            }
        }
    });
    std::vector<std::uint32_t> front;
    for (const auto& slice : slices)
        front.insert(front.end(), slice.begin(), slice.end());
    const int layers = std::max({by.x, by.y, by.z});
    for (int layer = 0; layer < layers && !front.empty(); ++layer) {
        std::vector<std::uint32_t> next;
        for (const std::uint32_t n : front) {
            const glm::ivec3 v = grid.voxelAt(n);
            const std::uint8_t was = out[n];
            if (was != airCode && was != outsideCode) continue;
            if (was == airCode && touches(n, [](std::uint8_t l) { return l == taggedCode; })) {
                out[n] = taggedCode;
                continue;
            }
            if (was == airCode && touches(n, [](std::uint8_t l) { return l == untaggedCode; })) {
                out[n] = untaggedCode;
                continue;
            }
            if (was == outsideCode && (isBarred(v) || touches(n, [](std::uint8_t l) {
                                           return l != airCode && l != outsideCode;
                                       })))
                continue;
            const bool interior = glm::all(glm::greaterThan(v, glm::ivec3(0))) &&
                                  glm::all(glm::lessThan(v, grid.size - 1));
            if (!interior || !isSimple(labelledAround(fine, v))) continue;
            out[n] = was == airCode ? outsideCode : airCode;
            visitFaces(grid, n, [&](std::size_t m, int) {
                if (out[m] == was && isWrong(m)) next.push_back(std::uint32_t(m));
            });
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        front = std::move(next);
    }
    return fine;
}

}  // namespace haustra::segmentation
