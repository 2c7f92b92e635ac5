#include "segmentation/bowel_contents.h"

#include "core/flood_fill.h"
#include "core/printed_text.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <utility>

namespace haustra::segmentation {
namespace {

constexpr double cellMm = 4.0;
constexpr double outsideReachMm = 6.0;
constexpr double lungAboveGasHu = 60.0, lungBelowHu = -550.0;
constexpr double smallestLungMl = 50.0, lungFromTopMm = 40.0, wholeLungMl = 500.0;

/// The scan in cubes of about 4 mm, by what of them lies in the field of view.
struct Cells {
    glm::ivec3 block{1};
    Grid grid;  ///< of the cubes; its place is not set
    double cellMl = 0.0;
    std::vector<std::uint8_t> allAir;  ///< every voxel of the cube is below the wall's HU
    std::vector<std::uint8_t> side;    ///< at the field's border
    std::vector<float> meanHu;

    std::size_t count() const { return allAir.size(); }
};

/// Sums over the voxels of a row of cells along i.
struct CellRow {
    std::vector<double> sumHu;
    std::vector<int> voxels, highHu;

    explicit CellRow(std::size_t cells)
        : sumHu(cells, 0.0), voxels(cells, 0), highHu(cells, -32768) {}

    /// A row of voxels, `along` of which are one cell; those of `beyond` do not count.
    void add(std::span<const std::int16_t> hu, std::span<const std::uint8_t> beyond, int along) {
        for (std::size_t x = 0, at = 0; x < sumHu.size(); ++x) {
            const std::size_t next = std::min(at + std::size_t(along), hu.size());
            int sum = 0;
            for (; at != next; ++at) {
                if (beyond[at]) continue;
                ++voxels[x];
                sum += hu[at], highHu[x] = std::max(highHu[x], int(hu[at]));
            }
            sumHu[x] += sum;
        }
    }
};

Cells makeCells(const Volume<std::int16_t>& hu, const FieldOfView& field, double airBelowHu,
                int threads) {
    const Grid& grid = hu.grid();
    Cells cells;
    cells.block = glm::max(glm::ivec3(1), glm::ivec3(glm::round(cellMm / grid.spacingMm())));
    cells.grid.size = (grid.size + cells.block - 1) / cells.block;
    cells.cellMl = grid.voxelVolumeMm3() * cells.block.x * cells.block.y * cells.block.z / 1000.0;
    cells.allAir.assign(cells.grid.voxelCount(), 0);
    cells.side.assign(cells.grid.voxelCount(), 0);
    cells.meanHu.assign(cells.grid.voxelCount(), 0.0f);
    const std::size_t length = std::size_t(cells.grid.size.x),
                      rows = cells.grid.voxelCount() / length, across = std::size_t(grid.size.x);
    const std::span<const std::uint8_t> beyond(field.beyond);
    parallelFor(rows, 16, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t r = first; r < last; ++r) {
            CellRow row(length);
            const glm::ivec3 lo = cells.grid.voxelAt(r * length) * cells.block,
                             hi = glm::min(lo + cells.block, grid.size);
            for (int k = lo.z; k < hi.z; ++k) {
                for (int j = lo.y; j < hi.y; ++j)
                    row.add(hu.voxels().subspan(grid.index(0, j, k), across),
                            beyond.subspan(std::size_t(j) * across, across), cells.block.x);
            }
            for (std::size_t x = 0; x < length; ++x) {
                cells.meanHu[r * length + x] = float(row.sumHu[x] / std::max(1, row.voxels[x]));
                cells.allAir[r * length + x] = row.voxels[x] > 0 && row.highHu[x] < airBelowHu;
            }
        }
    });
    for (glm::ivec3 v(0); v.y < grid.size.y; ++v.y) {
        for (v.x = 0; v.x < grid.size.x; ++v.x) {
            if (!field.rim[grid.index(v)]) continue;
            for (glm::ivec3 c = v / cells.block; c.z < cells.grid.size.z; ++c.z)
                cells.side[cells.grid.index(c)] = 1;
        }
    }
    return cells;
}

template <class Accept>
std::vector<std::uint8_t> flood(const Cells& cells, std::vector<std::size_t> front,
                                const Accept& accept) {
    std::vector<std::uint8_t> reached(cells.count(), 0);
    for (const std::size_t n : front)
        reached[n] = 1;
    floodFill(front, faceNeighbours(cells.grid), [&](std::size_t next) {
        if (reached[next] || !accept(next)) return false;
        reached[next] = 1;
        return true;
    });
    return reached;
}

// What of the outside cells no way within a slice leads to from the room's at the field's sides, in
// bodies of 100 ml and more; their mouths lie between slices.
std::vector<EnclosedRoomAir> enclosedRoomAir(const Cells& cells, const Grid& grid,
                                             const std::vector<std::size_t>& room,
                                             const std::vector<std::uint8_t>& outside) {
    constexpr double leastMl = 100.0;
    std::vector<std::uint8_t> left = outside;
    const auto take = [&](std::size_t n) { return std::exchange(left[n], std::uint8_t(0)) != 0; };
    std::vector<std::size_t> open = room;
    for (const std::size_t n : open)
        left[n] = 0;
    const auto inSlice = [&](std::size_t n, const auto& visit) {
        visitFaces(cells.grid, n, [&](std::size_t next, int axis) {
            if (axis < 2) visit(next);
        });
    };
    floodFill(open, inSlice, take);
    const std::vector<std::uint8_t> enclosed = left;
    const auto facesOut = [&](std::size_t n) {
        int faces = 0;
        visitFaces(cells.grid, n,
                   [&](std::size_t next, int) { faces += outside[next] && !enclosed[next]; });
        return faces;
    };
    const auto middleMm = [&](const std::vector<std::size_t>& of) {
        glm::dvec3 sum(0.0);
        for (const std::size_t n : of)
            sum += glm::dvec3(cells.grid.voxelAt(n));
        return grid.patientFromVoxelPoint(
            (sum / double(of.size()) + 0.5) * glm::dvec3(cells.block) - 0.5);
    };
    const glm::dvec3 cellMm = grid.spacingMm() * glm::dvec3(cells.block);
    std::vector<EnclosedRoomAir> all;
    for (std::size_t n = 0; n < cells.count(); ++n) {
        if (!take(n)) continue;
        std::vector<std::size_t> body{n};
        floodFill(body, faceNeighbours(cells.grid), take);
        EnclosedRoomAir air{middleMm(body), double(body.size()) * cells.cellMl, {}};
        if (air.ml < leastMl) continue;
        std::set<std::size_t> atMouth;
        for (const std::size_t m : body) {
            if (facesOut(m) > 0) atMouth.insert(m);
        }
        while (!atMouth.empty()) {
            std::vector<std::size_t> mouth{*atMouth.begin()};
            atMouth.erase(atMouth.begin());
            floodFill(mouth, cornerNeighbours(cells.grid),
                      [&](std::size_t next) { return atMouth.erase(next) > 0; });
            int faces = 0;
            for (const std::size_t m : mouth)
                faces += facesOut(m);
            air.mouths.push_back({middleMm(mouth), faces * cellMm.x * cellMm.y});
        }
        if (!air.mouths.empty()) all.push_back(std::move(air));
    }
    return all;
}

/// Air at the field's sides, x and y.
struct SideAir {
    std::vector<std::size_t> room;    ///< cells of the room's air
    std::vector<std::uint8_t> byCut;  ///< of each cell: at most one off gas that a side cuts
};

// The room's air goes by the patient: along a side it reaches a corner of the slices, or it lies
// there from the first slice to the last; around a circle it reaches one of these. Gas of a colon
// that a narrow field cuts does not.
SideAir sideAir(const Cells& cells, bool roundField) {
    const glm::ivec3 last = cells.grid.size - 1;
    const auto isSideAir = [&](std::size_t n) { return cells.side[n] && cells.allAir[n]; };
    SideAir air;
    air.byCut.assign(cells.count(), 0);
    std::vector<std::uint8_t> seen(cells.count(), 0);
    for (std::size_t n = 0; n < cells.count(); ++n) {
        if (seen[n] || !isSideAir(n)) continue;
        std::vector<std::size_t> body{n};
        seen[n] = 1;
        bool corner = false, first = false, end = false;
        for (std::size_t m = 0; m < body.size(); ++m) {
            const glm::ivec3 c = cells.grid.voxelAt(body[m]);
            corner |= (c.x == 0 || c.x == last.x) && (c.y == 0 || c.y == last.y);
            first |= c.z == 0, end |= c.z == last.z;
            visitFaces(cells.grid, body[m], [&](std::size_t next, int) {
                if (seen[next] || !isSideAir(next)) return;
                seen[next] = 1;
                body.push_back(next);
            });
        }
        if (corner || (first && end) || (roundField && (first || end))) {
            air.room.insert(air.room.end(), body.begin(), body.end());
            continue;
        }
        for (const std::size_t m : body) {
            const glm::ivec3 c = cells.grid.voxelAt(m);
            visitBox(glm::max(c - 1, glm::ivec3(0)), glm::min(c + 1, last),
                     [&](glm::ivec3 by) { air.byCut[cells.grid.index(by)] = 1; });
        }
    }
    return air;
}

/// How far a cell lies beneath the scan's cranial end, mm.
class BeneathTop {
public:
    BeneathTop(const Grid& grid, const Cells& cells) : cells_(cells) {
        double along = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double z = grid.patientFromVoxel[axis].z;
            if (std::abs(z) > std::abs(along)) along = z, axis_ = axis;
        }
        isLastTop_ = along > 0.0;
        cellMm_ = grid.spacingMm()[axis_] * cells.block[axis_];
    }
    double operator()(std::size_t cell) const {
        const int at = cells_.grid.voxelAt(cell)[axis_];
        return cellMm_ * (isLastTop_ ? cells_.grid.size[axis_] - 1 - at : at);
    }

private:
    const Cells& cells_;
    int axis_ = 2;
    bool isLastTop_ = true;
    double cellMm_ = 0.0;
};

// Cells of a mean HU well above gas, in bodies thicker than the partial volume at a wall, which
// come from the scan's top, as of an abdomen the lungs do, or are as large as a whole one. Others
// are bowel's: scatter in a large body, or foam, makes its gas as bright.
std::vector<std::uint8_t> lungCells(const Cells& cells, const std::vector<std::uint8_t>& outside,
                                    double gasHu, const BeneathTop& beneathTopMm) {
    const auto lungLike = [&](std::size_t n) {
        return !outside[n] && cells.meanHu[n] > gasHu + lungAboveGasHu &&
               cells.meanHu[n] < lungBelowHu;
    };
    std::vector<std::uint8_t> deep(cells.count(), 0), lung(cells.count(), 0);
    for (std::size_t n = 0; n < cells.count(); ++n) {
        if (!lungLike(n)) continue;
        int like = 0;
        visitFaces(cells.grid, n, [&](std::size_t m, int) { like += lungLike(m); });
        deep[n] = like == 6;
    }
    std::vector<std::uint8_t> seen(cells.count(), 0);
    for (std::size_t n = 0; n < cells.count(); ++n) {
        if (!deep[n] || seen[n]) continue;
        std::vector<std::size_t> body{n};
        seen[n] = 1;
        floodFill(body, faceNeighbours(cells.grid), [&](std::size_t m) {
            if (!deep[m] || seen[m]) return false;
            seen[m] = 1;
            return true;
        });
        const double ml = double(body.size()) * cells.cellMl;
        const bool isLung = ml >= wholeLungMl ||
                            (ml >= smallestLungMl && std::ranges::any_of(body, [&](std::size_t m) {
                                 return beneathTopMm(m) <= lungFromTopMm;
                             }));
        if (!isLung) continue;
        for (const std::size_t m : body)
            lung[m] = 1;
    }
    // Back out by what the erosion took.
    std::vector<std::uint8_t> grown = lung;
    for (std::size_t n = 0; n < cells.count(); ++n) {
        if (lung[n] || !lungLike(n)) continue;
        visitFaces(cells.grid, n, [&](std::size_t m, int) { grown[n] = grown[n] || lung[m]; });
    }
    return grown;
}

/// Gas from the outside cells and the field's sides on, as far as the outside reaches into narrower
/// places; not from where a side cuts gas.
void reachIn(Volume<std::uint8_t>& content, const FieldOfView& field, const Cells& cells,
             const std::vector<std::uint8_t>& outside, const std::vector<std::uint8_t>& byCut,
             int threads) {
    const Grid& grid = content.grid();
    const auto voxels = content.writable();
    std::vector<std::vector<std::uint32_t>> slices(std::size_t(grid.size.z));
    parallelFor(slices.size(), 4, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                const std::size_t row = grid.index(0, j, int(k));
                const auto cellsAt = [&](int y, int z) {
                    return &outside[cells.grid.index(glm::ivec3(0, y, z) / cells.block)];
                };
                const std::uint8_t* const own = cellsAt(j, int(k));
                const std::uint8_t* const cut =
                    &byCut[cells.grid.index(glm::ivec3(0, j, int(k)) / cells.block)];
                const std::array<const std::uint8_t*, 4> beside{
                    cellsAt(std::max(j - 1, 0), int(k)),
                    cellsAt(std::min(j + 1, grid.size.y - 1), int(k)),
                    cellsAt(j, std::max(int(k) - 1, 0)),
                    cellsAt(j, std::min(int(k) + 1, grid.size.z - 1))};
                const std::uint8_t* const rim =
                    &field.rim[std::size_t(j) * std::size_t(grid.size.x)];
                for (int i = 0; i < grid.size.x; ++i) {
                    if (Content(voxels[row + std::size_t(i)]) != Content::gas) continue;
                    const int x = i / cells.block.x;
                    const bool near = (rim[i] && !cut[x]) ||
                                      own[std::max(i - 1, 0) / cells.block.x] ||
                                      own[std::min(i + 1, grid.size.x - 1) / cells.block.x] ||
                                      beside[0][x] || beside[1][x] || beside[2][x] || beside[3][x];
                    if (near) slices[k].push_back(std::uint32_t(row + std::size_t(i)));
                }
            }
        }
    });
    std::vector<std::uint32_t> front;
    for (const auto& slice : slices)
        front.insert(front.end(), slice.begin(), slice.end());
    for (const std::uint32_t n : front)
        voxels[n] = std::uint8_t(Content::outside);
    const glm::dvec3 spacing = grid.spacingMm();
    const int steps =
        std::max(1, int(std::lround(outsideReachMm / std::max({spacing.x, spacing.y, spacing.z}))));
    for (int step = 0; step < steps; ++step) {
        for (const std::uint32_t n : std::exchange(front, {})) {
            visitFaces(grid, n, [&](std::size_t next, int) {
                if (Content(voxels[next]) != Content::gas) return;
                voxels[next] = std::uint8_t(Content::outside);
                front.push_back(std::uint32_t(next));
            });
        }
    }
}

// The grid axis and sign along which a patient direction points most.
GravityAxis axisOf(const Grid& grid, glm::dvec3 gravity) {
    GravityAxis down;
    double best = -1.0;
    for (int axis = 0; axis < 2; ++axis) {
        const double along =
            glm::dot(glm::normalize(glm::dvec3(grid.patientFromVoxel[axis])), gravity);
        if (std::abs(along) > best) best = std::abs(along), down = {axis, along < 0.0 ? -1 : 1};
    }
    const auto perVoxel = [&](int axis) {
        return glm::dot(glm::dvec3(grid.patientFromVoxel[axis]), gravity);
    };
    down.slope = glm::dvec2(perVoxel(1 - down.axis), perVoxel(2)) / perVoxel(down.axis);
    return down;
}

const char* lyingName(glm::dvec3 gravity) {
    if (gravity.y > 0.0) return "supine";
    if (gravity.y < 0.0) return "prone";
    return gravity.x > 0.0 ? "on the left side" : "on the right side";
}

// Gas over fluid has but their blur between, so that soft tissue's HU are passed within 0.95 σ to
// 1.3 σ, or foam besides. Where two walls lie between, as of fluid in a loop beneath another's
// floor, or lung beside bone, there is tissue of these HU. A wall is not flat, though: where they
// begin in a plane, and rise slowly, they are the fluid's own, the heavier of which sank.
void dropThoseBehindWalls(std::vector<Level>& levels, double edgeWidthMm) {
    constexpr double mostOfWidth = 1.25;  // which is 1.35 σ; foam makes it up to this
    constexpr double gradedMm2 = 100.0, flatMm = 0.2;
    std::erase_if(levels, [&](const Level& level) {
        const bool isGraded = level.areaMm2 >= gradedMm2 && level.topRoughnessMm <= flatMm &&
                              level.riseMm >= std::max(slowRiseMm, 2.0 * edgeWidthMm);
        return level.stepMm > mostOfWidth * edgeWidthMm && !isGraded;
    });
}
// The area of those that have no more than blur between.
double sureAreaMm2(const std::vector<Level>& levels, double edgeWidthMm) {
    double sum = 0.0;
    for (const Level& level : levels)
        sum += level.stepMm <= edgeWidthMm ? level.areaMm2 : 0.0;
    return sum;
}

// The patient position says which way is down; the levels must agree, and overrule it where they
// clearly do not.
void findGravity(const Volume<std::int16_t>& hu, PatientPosition position,
                 const TissueModel& tissue, int threads, BowelContents& contents) {
    constexpr double clearMm2 = 400.0, clearRatio = 3.0;
    const glm::dvec3 told = gravityDirection(position);
    const bool known = glm::length(told) > 0.0;
    const std::array<glm::dvec3, 4> directions{{{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}}};
    std::array<std::vector<Level>, 4> levels;
    std::array<double, 4> areaMm2{};
    std::size_t best = 0, toldIndex = 0;
    std::array<double, 2> edgeMm{};
    for (const int axis : {0, 1})
        edgeMm[std::size_t(axis)] =
            edgeWidthMm(hu, tissue, contents.content, axis).value_or(INFINITY);
    for (std::size_t n = 0; n < directions.size(); ++n) {
        const GravityAxis down = axisOf(hu.grid(), directions[n]);
        levels[n] = findLevels(hu, tissue, contents.content, down, threads);
        dropThoseBehindWalls(levels[n], edgeMm[std::size_t(down.axis)]);
        areaMm2[n] = sureAreaMm2(levels[n], edgeMm[std::size_t(down.axis)]);
        if (areaMm2[n] > areaMm2[best]) best = n;
        if (known && glm::dot(directions[n], told) > 0.5) toldIndex = n;
    }
    if (known && best != toldIndex) {
        if (areaMm2[best] > clearMm2 && areaMm2[best] > clearRatio * areaMm2[toldIndex]) {
            contents.warnings.push_back(
                printed("the air-fluid levels show that the patient lay %s, not %s as the series "
                        "says; the levels are believed",
                        lyingName(directions[best]), toString(position)));
        } else {
            best = toldIndex;
        }
    }
    if (!known && areaMm2[best] == 0.0) {
        contents.warnings.push_back(
            "patient position unknown, and no air-fluid level shows it: supine is assumed");
    }
    if (!known && areaMm2[best] > 0.0) {
        contents.notes.push_back(
            std::string(
                "patient position unknown; the air-fluid levels show that the patient lay ") +
            lyingName(directions[best]));
    }
    contents.gravity = directions[best];
    contents.down = axisOf(hu.grid(), directions[best]);
    contents.levels = std::move(levels[best]);
}

void markInterfaces(BowelContents& contents) {
    const Grid& grid = contents.content.grid();
    const auto voxels = contents.content.writable();
    const GravityAxis down = contents.down;
    for (const Level& level : contents.levels) {
        for (const LevelColumn& column : level.columns) {
            for (glm::ivec3 v = column.above;; v[down.axis] += down.sign) {
                voxels[grid.index(v)] = std::uint8_t(Content::interface);
                if (v == column.below) break;
            }
        }
    }
}

// Mean and sd of gas where all neighbours are gas too.
void measureGas(const Volume<std::int16_t>& hu, BowelContents& contents, int threads) {
    const Grid& grid = hu.grid();
    std::vector<std::array<double, 3>> sums(std::size_t(grid.size.z), {0.0, 0.0, 0.0});
    const std::size_t strides[3] = {1, std::size_t(grid.size.x),
                                    std::size_t(grid.size.x) * std::size_t(grid.size.y)};
    const auto isGas = [&](std::size_t n) { return Content(contents.content[n]) == Content::gas; };
    forVoxels(grid, threads, [&](std::size_t n, glm::ivec3 v) {
        if (!isGas(n)) return;
        for (int axis = 0; axis < 3; ++axis) {
            if (v[axis] < 2 || v[axis] + 2 >= grid.size[axis] || !isGas(n - 2 * strides[axis]) ||
                !isGas(n + 2 * strides[axis]))
                return;
        }
        const double value = hu[n];
        std::array<double, 3>& sum = sums[std::size_t(v.z)];
        sum[0] += 1.0, sum[1] += value, sum[2] += value * value;
    });
    std::array<double, 3> all{};
    for (const auto& sum : sums) {
        for (std::size_t n = 0; n < 3; ++n)
            all[n] += sum[n];
    }
    if (all[0] < 100.0) return;
    contents.gasHu = all[1] / all[0];
    contents.gasSdHu = std::sqrt(std::max(0.0, all[2] / all[0] - contents.gasHu * contents.gasHu));
}

}  // namespace

BowelContents findContents(const Volume<std::int16_t>& hu, const FieldOfView& field,
                           PatientPosition position, const TissueModel& tissue, int threads) {
    const Grid& grid = hu.grid();
    const Cells cells = makeCells(hu, field, tissue.airBelowHu, threads);
    const SideAir atSides = sideAir(cells, field.round);
    const std::vector<std::uint8_t> outside =
        flood(cells, atSides.room, [&](std::size_t n) { return cells.allAir[n] != 0; });
    const std::vector<std::uint8_t> lung =
        lungCells(cells, outside, tissue.meanHu[int(Tissue::air)], BeneathTop(grid, cells));
    BowelContents contents;
    contents.enclosedRoomAir = enclosedRoomAir(cells, grid, atSides.room, outside);
    contents.content = Volume<std::uint8_t>(grid);
    const auto voxels = contents.content.writable();
    forVoxels(grid, threads, [&](std::size_t n, glm::ivec3 v) {
        Content content = hu[n] > tissue.taggedAboveHu ? Content::tagged : Content::tissue;
        if (hu[n] < tissue.airBelowHu) {
            const std::size_t cell = cells.grid.index(v / cells.block);
            content = outside[cell] ? Content::outside : lung[cell] ? Content::lung : Content::gas;
        }
        if (field.beyond[grid.index(v.x, v.y, 0)]) content = Content::beyond;
        voxels[n] = std::uint8_t(content);
    });
    reachIn(contents.content, field, cells, outside, atSides.byCut, threads);
    measureGas(hu, contents, threads);
    findGravity(hu, position, tissue, threads, contents);
    markInterfaces(contents);
    return contents;
}

}  // namespace haustra::segmentation
