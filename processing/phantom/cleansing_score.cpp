#include "phantom/cleansing_score.h"

#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace haustra::phantom {
namespace {

constexpr int reachVoxels = 2;  // voxels, along each axis
constexpr double cubeMm = 10.0;

constexpr std::uint8_t bit(LumenLabel label) {
    return std::uint8_t(1u << unsigned(label));
}

/// The union of the bits within `reach` voxels along each axis of every voxel (a box).
void spread(Volume<std::uint8_t>& bits, int reach) {
    const Grid& grid = bits.grid();
    std::uint8_t* data = bits.writable().data();
    std::vector<std::uint8_t> lines;
    // Elements of a line lie `stride` apart; `width` neighbouring lines are done at once.
    const auto along = [&](std::uint8_t* first, int length, std::size_t stride, std::size_t width) {
        lines.assign((std::size_t(length) + 2 * std::size_t(reach)) * width, 0);
        for (int n = 0; n < length; ++n)
            std::copy_n(first + std::size_t(n) * stride, width,
                        &lines[std::size_t(n + reach) * width]);
        for (int n = 0; n < length; ++n) {
            std::uint8_t* out = first + std::size_t(n) * stride;
            for (int r = 0; r <= 2 * reach; ++r) {
                const std::uint8_t* in = &lines[std::size_t(n + r) * width];
                for (std::size_t m = 0; m < width; ++m)
                    out[m] |= in[m];
            }
        }
    };
    const std::size_t row = std::size_t(grid.size.x), slice = row * std::size_t(grid.size.y);
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j < grid.size.y; ++j)
            along(data + grid.index(0, j, k), grid.size.x, 1, 1);
        along(data + std::size_t(k) * slice, grid.size.y, row, row);
    }
    for (int j = 0; j < grid.size.y; ++j)
        along(data + std::size_t(j) * row, grid.size.z, slice, row);
}

struct Sums {
    std::size_t voxels = 0;
    double sum = 0.0, squares = 0.0, largest = -1.0;
    std::size_t largestAt = 0;

    void add(std::size_t voxel, double error) {
        ++voxels, sum += error, squares += error * error;
        if (std::abs(error) > largest) largest = std::abs(error), largestAt = voxel;
    }
    double bias() const { return voxels ? sum / double(voxels) : 0.0; }
    double rmse() const { return voxels ? std::sqrt(squares / double(voxels)) : 0.0; }
};

/// The errors of a region, as a whole and cube by cube.
class Region {
public:
    explicit Region(const Grid& grid)
        : grid_(grid),
          cube_(glm::max(glm::ivec3(glm::round(cubeMm / grid.spacingMm())), glm::ivec3(1))),
          cubes_((grid.size + cube_ - 1) / cube_) {}

    void add(std::size_t voxel, double error) {
        whole_.add(voxel, error);
        const glm::ivec3 c = grid_.voxelAt(voxel) / cube_;
        byCube_[std::size_t(c.x) +
                std::size_t(cubes_.x) * (std::size_t(c.y) + std::size_t(cubes_.y) * c.z)]
            .add(voxel, error);
    }

    RegionError finish() const {
        RegionError error;
        error.voxels = whole_.voxels, error.rmseHu = whole_.rmse(), error.biasHu = whole_.bias();
        error.maxHu = std::max(0.0, whole_.largest);
        std::vector<const Sums*> cubes;
        for (const auto& [cube, sums] : byCube_)
            cubes.push_back(&sums);
        std::sort(cubes.begin(), cubes.end(), [](const Sums* a, const Sums* b) {
            return a->squares != b->squares ? a->squares > b->squares : a->largestAt < b->largestAt;
        });
        cubes.resize(std::min(cubes.size(), worstPlaces));
        for (const Sums* sums : cubes) {
            error.worst.push_back(
                {grid_.voxelAt(sums->largestAt), sums->voxels, sums->rmse(), sums->bias()});
        }
        return error;
    }

private:
    Grid grid_;
    glm::ivec3 cube_, cubes_;
    Sums whole_;
    std::unordered_map<std::size_t, Sums> byCube_;
};

/// Lumen voxels within reachVoxels of the given ones, ascending.
std::vector<std::uint32_t> lumenAround(const Volume<std::uint8_t>& labels,
                                       const std::vector<std::uint32_t>& voxels) {
    const Grid& grid = labels.grid();
    std::vector<std::uint32_t> around;
    for (const std::uint32_t at : voxels) {
        const glm::ivec3 v = grid.voxelAt(at);
        const glm::ivec3 lo = glm::max(v - reachVoxels, glm::ivec3(0)),
                         hi = glm::min(v + reachVoxels, grid.size - 1);
        visitBox(lo, hi, [&](glm::ivec3 n) {
            if (labels.at(n)) around.push_back(std::uint32_t(grid.index(n)));
        });
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
}

SubmergedPolyp scorePolyp(const Phantom& truth, const Volume<std::int16_t>& cleansed,
                          std::size_t index) {
    const std::vector<std::uint32_t>& tissue = truth.polypVoxels[index];
    SubmergedPolyp score;
    score.polyp = truth.polyps.findings[index];
    const auto around = lumenAround(truth.lumen, tissue);
    std::size_t tagged = 0, excess = 0;
    for (const std::uint32_t v : around) {
        tagged += truth.lumen[v] == std::uint8_t(LumenLabel::tagged);
        excess += cleansed[v] > polypHu && truth.untaggedHu[v] <= polypHu;
    }
    score.submergedShare = around.empty() ? 0.0 : double(tagged) / double(around.size());
    Sums sums;
    std::size_t dense = 0, kept = 0;
    for (const std::uint32_t v : tissue) {
        sums.add(v, double(cleansed[v]) - double(truth.untaggedHu[v]));
        if (truth.untaggedHu[v] <= polypHu) continue;
        ++dense, kept += cleansed[v] > polypHu;
    }
    score.voxels = sums.voxels, score.rmseHu = sums.rmse(), score.biasHu = sums.bias();
    score.volumeShare = dense ? double(kept) / double(dense) : 1.0;
    score.excessShare = dense ? double(excess) / double(dense) : 0.0;
    return score;
}

}  // namespace

Result<CleansingScore> scoreCleansing(const Phantom& truth,
                                      const Volume<std::int16_t>& cleansedHu) {
    const Grid& grid = truth.lumen.grid();
    if (!sameGrid(grid, truth.scan.hu.grid()) || !sameGrid(grid, truth.untaggedHu.grid())) {
        return fail(ErrorKind::badInput, "the phantom's volumes are on different grids",
                    "cleansing score");
    }
    if (!sameGrid(grid, cleansedHu.grid())) {
        return fail(ErrorKind::badInput, "the cleansed scan and the truth are on different grids",
                    "cleansing score");
    }
    if (truth.polypVoxels.size() != truth.polyps.findings.size()) {
        return fail(ErrorKind::badInput, "the phantom does not tell its polyps' voxels",
                    "cleansing score");
    }
    constexpr std::uint8_t outside = bit(LumenLabel::outside), air = bit(LumenLabel::air),
                           tagged = bit(LumenLabel::tagged);
    Volume<std::uint8_t> near(grid);
    std::transform(
        truth.lumen.voxels().begin(), truth.lumen.voxels().end(), near.writable().begin(),
        [](std::uint8_t label) { return std::uint8_t(1u << std::min(label, std::uint8_t(3))); });
    spread(near, reachVoxels);

    CleansingScore score;
    Region fluid(grid), interface(grid), wall(grid), rim(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (!(near[n] & tagged)) continue;
        const double error = double(cleansedHu[n]) - double(truth.untaggedHu[n]);
        const bool byAir = near[n] & air, byWall = near[n] & outside;
        if (near[n] == tagged) fluid.add(n, error);
        if (byAir) interface.add(n, error);
        if (byWall) wall.add(n, error);
        if (byAir && byWall) rim.add(n, error);
    }
    score.fluid = fluid.finish(), score.interface = interface.finish();
    score.wall = wall.finish(), score.rim = rim.finish();

    spread(near, reachVoxels);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if ((near[n] & tagged) || cleansedHu[n] == truth.scan.hu[n]) continue;
        ++score.voxelsChangedBeyond;
        score.maxChangeBeyondHu = std::max(
            score.maxChangeBeyondHu, std::abs(double(cleansedHu[n]) - double(truth.scan.hu[n])));
    }
    for (std::size_t p = 0; p < truth.polypVoxels.size(); ++p) {
        SubmergedPolyp polyp = scorePolyp(truth, cleansedHu, p);
        if (polyp.submergedShare > 0.5) score.polyps.push_back(std::move(polyp));
    }
    return score;
}

}  // namespace haustra::phantom
