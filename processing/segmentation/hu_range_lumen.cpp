#include "segmentation/hu_range_lumen.h"

#include "core/patient_point.h"
#include "core/voxel_sweep.h"
#include "topology/distance_field.h"
#include "topology/run_components.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::segmentation {
namespace {

constexpr double seedReachMm = 5.0;
constexpr std::size_t grain = std::size_t(1) << 20;

// The mask as topology::RunComponents takes it: what is below 0 is in the set.
constexpr std::int16_t in = -1, out = 0;

tl::unexpected<Error> refused(ErrorKind kind, std::string message) {
    return fail(kind, std::move(message), "segmentation");
}

Volume<std::uint8_t> contentOf(const Volume<std::int16_t>& hu, HuRange range, int threads) {
    Volume<std::uint8_t> mask(hu.grid());
    const auto voxels = mask.writable();
    parallelFor(voxels.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            voxels[n] = hu[n] >= range.fromHu && hu[n] <= range.toHu;
    });
    return mask;
}

template <class T, class Keep>
void keepWhere(Volume<std::uint8_t>& mask, const Volume<T>& distanceMm, int threads, Keep keep) {
    const auto voxels = mask.writable();
    parallelFor(voxels.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            voxels[n] = keep(distanceMm[n]);
    });
}

// Erosion and dilation by exact balls: centres farther than the radius from the background, then
// all that is no farther than the radius from such a centre.
void open(Volume<std::uint8_t>& mask, double radiusMm, int threads) {
    const auto radius = float(radiusMm);
    keepWhere(mask, topology::distanceToBoundaryMm(mask, threads), threads,
              [&](float mm) { return std::uint8_t(!(mm > radius)); });
    keepWhere(mask, topology::distanceToBoundaryMm(mask, threads), threads,
              [&](float mm) { return std::uint8_t(mm <= radius); });
}

topology::RunComponents componentsWhere(const Volume<std::uint8_t>& mask, bool set, int threads) {
    Volume<std::int16_t> signs(mask.grid());
    const auto voxels = signs.writable();
    parallelFor(voxels.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            voxels[n] = (mask[n] != 0) == set ? in : out;
    });
    return topology::RunComponents(signs, 0.0, threads);
}

// Sets the labels of all voxels of the components that `wanted` has.
void label(Volume<std::uint8_t>& labels, const topology::RunComponents& components,
           const std::vector<char>& wanted) {
    const Grid& grid = labels.grid();
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j < grid.size.y; ++j) {
            for (const topology::Run& run : components.row(j, k)) {
                if (!wanted[std::size_t(run.component)]) continue;
                std::fill_n(labels.writable().begin() + std::ptrdiff_t(grid.index(run.begin, j, k)),
                            run.end - run.begin, std::uint8_t(LumenLabel::air));
            }
        }
    }
}

// Labels the background that no way leads out of to the grid's edge; returns how many voxels.
std::size_t fillEnclosed(Volume<std::uint8_t>& labels, int threads) {
    const topology::RunComponents around = componentsWhere(labels, false, threads);
    std::vector<char> enclosed;
    std::size_t filled = 0;
    for (const topology::RunComponent& part : around.components()) {
        bool atEdge = false;
        for (int axis = 0; axis < 3; ++axis) {
            atEdge = atEdge || part.touches(axis, false, labels.grid().size) ||
                     part.touches(axis, true, labels.grid().size);
        }
        enclosed.push_back(!atEdge);
        if (!atEdge) filled += part.voxels;
    }
    label(labels, around, enclosed);
    return filled;
}

// The component at a point, or the nearest one within reach; −1 where there is none.
int componentNear(const topology::RunComponents& components, const Grid& grid, glm::dvec3 pointMm) {
    const glm::dvec3 center = grid.voxelFromPatientPoint(pointMm);
    const glm::dvec3 spacing = grid.spacingMm();
    const auto lowest =
        glm::max(glm::ivec3(glm::floor(center - seedReachMm / spacing)), glm::ivec3(0));
    const auto highest =
        glm::min(glm::ivec3(glm::ceil(center + seedReachMm / spacing)), grid.size - 1);
    double nearestMm = seedReachMm;
    int found = -1;
    visitBox(lowest, highest, [&](glm::ivec3 v) {
        const double mm = glm::distance(grid.patientFromVoxelPoint(glm::dvec3(v)), pointMm);
        if (mm > nearestMm || (mm == nearestMm && found >= 0)) return;
        const int component = components.at(v);
        if (component >= 0) nearestMm = mm, found = component;
    });
    return found;
}

std::string pointText(glm::dvec3 p) {
    const auto round = [](double mm) { return std::to_string(std::lround(mm)); };
    return round(p.x) + "," + round(p.y) + "," + round(p.z) + " mm";
}

Result<std::vector<char>> chooseBodies(const topology::RunComponents& components, const Grid& grid,
                                       const HuRangeOptions& options) {
    const auto& bodies = components.components();
    std::vector<char> chosen(bodies.size(), 0), excluded(bodies.size(), 0);
    const auto lookUp = [&](const std::vector<glm::dvec3>& points,
                            std::vector<char>& found) -> Result<void> {
        for (const glm::dvec3& point : points) {
            const int at = isPatientPoint(point) ? componentNear(components, grid, point) : -1;
            if (at < 0) {
                return refused(ErrorKind::badInput,
                               "there is no content of the organ's HU within " +
                                   std::to_string(int(seedReachMm)) + " mm of the point " +
                                   pointText(point));
            }
            found[std::size_t(at)] = 1;
        }
        return {};
    };
    TRY(lookUp(options.excludesMm, excluded));
    TRY(lookUp(options.seedsMm, chosen));
    for (std::size_t n = 0; n < bodies.size(); ++n)
        chosen[n] = chosen[n] && !excluded[n];
    if (options.seedsMm.empty()) {
        int largest = -1;
        for (std::size_t n = 0; n < bodies.size(); ++n) {
            if (!excluded[n] && (largest < 0 || bodies[n].voxels > bodies[largest].voxels))
                largest = int(n);
        }
        if (largest >= 0) chosen[std::size_t(largest)] = 1;
    }
    if (std::find(chosen.begin(), chosen.end(), 1) == chosen.end()) {
        return refused(ErrorKind::noResult, "every body of the organ's HU is excluded");
    }
    return chosen;
}

}  // namespace

Result<HuRangeLumen> findHuRangeLumen(const Volume<std::int16_t>& hu,
                                      const HuRangeOptions& options) {
    const Grid& grid = hu.grid();
    const auto progress = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    Volume<std::uint8_t> mask = contentOf(hu, options.contentHu, options.threads);
    if (options.openingMm > 0.0) {
        if (!grid.hasRightAngles())
            return refused(ErrorKind::badInput, "the scan's voxel axes are not at right angles");
        fillEnclosed(mask, options.threads);  // a speck of noise is no neck
        open(mask, options.openingMm, options.threads);
    }
    progress(0.5);
    HuRangeLumen lumen{Volume<std::uint8_t>(grid, 0), 0, {}};
    {
        const topology::RunComponents content = componentsWhere(mask, true, options.threads);
        if (content.components().empty()) {
            return refused(ErrorKind::noResult,
                           "nothing in the scan has the HU of the organ's content, " +
                               std::to_string(options.contentHu.fromHu) + " to " +
                               std::to_string(options.contentHu.toHu));
        }
        const auto chosen = TRY(chooseBodies(content, grid, options));
        label(lumen.labels, content, chosen);
        lumen.bodies = int(std::count(chosen.begin(), chosen.end(), 1));
    }
    progress(0.8);
    const std::size_t filled = fillEnclosed(lumen.labels, options.threads);
    if (filled > 0) {
        lumen.notes.push_back(std::to_string(filled) +
                              " voxels of other HU inside the content were taken in");
    }
    return lumen;
}

namespace {

/// Neighbouring lines of a volume, one after another at each place along them; a place more at
/// either end.
constexpr int bundled = 32;
using LineBundle = std::vector<std::array<float, bundled>>;

/// The weights 1, 2, 1 along the lines, whose ends are held.
void smoothOnce(LineBundle& line) {
    const auto held = line.end() - 1;
    *held = *(held - 1);
    std::array<float, bundled> before = line[1];
    for (auto at = line.begin() + 1; at != held; ++at) {
        const std::array<float, bundled> here = *at, &after = *(at + 1);
        for (std::size_t l = 0; l < bundled; ++l)
            (*at)[l] = 0.25f * before[l] + 0.5f * here[l] + 0.25f * after[l];
        before = here;
    }
}

}  // namespace

// The weights 1, 2, 1 again and again along each axis: a variance of half a voxel each time. The
// edge of the grid is held.
Volume<std::int16_t> smoothHu(const Volume<std::int16_t>& hu, double sdMm, int threads) {
    const Grid& grid = hu.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    Volume<std::int16_t> result = hu.clone();
    const auto voxels = result.writable();
    for (int axis = 0; axis < 3; ++axis) {
        const auto passes = std::lround(2.0 * sdMm * sdMm / (spacing[axis] * spacing[axis]));
        const auto length = std::size_t(grid.size[axis]);
        if (passes == 0 || length < 2) continue;
        // Lines along the axis, a bundle of neighbours at a time.
        glm::ivec3 across = grid.size, unit(0);
        across[axis] = 1;
        unit[axis] = 1;
        const int side = axis == 0 ? 1 : 0;
        const std::size_t stride = grid.index(unit),
                          apart = axis == 0 ? std::size_t(grid.size.x) : 1;
        across[side] = (across[side] + bundled - 1) / bundled;
        const Grid bundles{across, glm::dmat4(1.0)};
        parallelFor(bundles.voxelCount(), 8, threads, [&](std::size_t begin, std::size_t end) {
            LineBundle line(length + 2);
            for (std::size_t n = begin; n < end; ++n) {
                glm::ivec3 v = bundles.voxelAt(n);
                v[side] *= bundled;
                const std::size_t first = grid.index(v);
                const auto width = std::size_t(std::min(bundled, grid.size[side] - v[side]));
                for (std::size_t at = 0; at < length; ++at) {
                    for (std::size_t l = 0; l < width; ++l)
                        line[at + 1][l] = voxels[first + at * stride + l * apart];
                }
                for (long pass = 0; pass < passes; ++pass)
                    smoothOnce(line);
                for (std::size_t at = 0; at < length; ++at) {
                    for (std::size_t l = 0; l < width; ++l) {
                        const float value = line[at + 1][l];
                        voxels[first + at * stride + l * apart] =
                            std::int16_t(value + std::copysign(0.5f, value));
                    }
                }
            }
        });
    }
    return result;
}

void growToWall(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu, double isoHu,
                bool contentBrighter, int threads) {
    constexpr int layers = 3;
    const Grid& grid = labels.grid();
    const auto voxels = labels.writable();
    const auto strideOf = [&](int axis) {
        glm::ivec3 unit(0);
        unit[axis] = 1;
        return std::ptrdiff_t(grid.index(unit));
    };
    const std::array<std::ptrdiff_t, 3> strides{strideOf(0), strideOf(1), strideOf(2)};
    for (int layer = 0; layer < layers; ++layer) {
        // Marked first and labelled after, so that no layer feeds itself.
        constexpr std::uint8_t marked = 255;
        std::size_t grown = 0;
        for (std::size_t n = 0; n < voxels.size(); ++n) {
            if (voxels[n] != 0 || !(contentBrighter ? hu[n] > isoHu : hu[n] < isoHu)) continue;
            const glm::ivec3 v = grid.voxelAt(n);
            const auto inside = [&](std::ptrdiff_t offset) {
                const std::uint8_t value = voxels[std::size_t(std::ptrdiff_t(n) + offset)];
                return value != 0 && value != marked;
            };
            bool touches = false;
            for (int axis = 0; axis < 3 && !touches; ++axis) {
                const std::ptrdiff_t stride = strides[std::size_t(axis)];
                touches = (v[axis] > 0 && inside(-stride)) ||
                          (v[axis] + 1 < grid.size[axis] && inside(stride));
            }
            if (touches) voxels[n] = marked, ++grown;
        }
        if (grown == 0) break;
        parallelFor(voxels.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                if (voxels[n] == marked) voxels[n] = std::uint8_t(LumenLabel::air);
            }
        });
    }
    fillEnclosed(labels, threads);
}

}  // namespace haustra::segmentation
