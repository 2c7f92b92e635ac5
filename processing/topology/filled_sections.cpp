#include "topology/filled_sections.h"

#include "topology/axis_walk.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace haustra::topology {
namespace {

constexpr double coreShare = 0.7, edgeShare = 0.5;  // of the way from soft tissue to the fluid
constexpr double weakestFluid = 0.05;               // the colon's fluid is brighter but for this
constexpr double smallestMl = 1.0;
constexpr double mostOverMedian =
    1.6;  // bright end of a fluid's HU over soft tissue: bone has more
constexpr double smallestOpeningMm2 = 80.0;
constexpr int openingVoxels = 1;  // of partial volume between fluid and lumen
constexpr int rimVoxels = 2, edgeVoxels = 2;

constexpr double mostOverFluid =
    1.6;  // a body's median over soft tissue: no brighter fluid is near

constexpr std::uint8_t isFluid = 1, isDeep = 2, isSeen = 4, isBarred = 8;

double quantile(std::vector<std::int16_t>& values, double share) {
    const auto at = values.begin() + std::ptrdiff_t(share * double(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// HU that all but the weakest, and all but the brightest, of the fluid in the lumen lies between.
struct FluidRange {
    double weakHu = 0.0, brightHu = 0.0;
};

std::optional<FluidRange> fluidRange(const Volume<std::uint8_t>& labels,
                                     const Volume<std::int16_t>& hu) {
    const Grid& grid = labels.grid();
    const auto isTagged = [&](std::size_t at) {
        return labels[at] == std::uint8_t(LumenLabel::tagged);
    };
    std::vector<std::int16_t> inside;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (!isTagged(n)) continue;
        int around = 0;
        visitNeighbours(grid, n, [&](std::size_t at) { around += isTagged(at); });
        if (around == 6) inside.push_back(hu[n]);
    }
    if (inside.empty()) return std::nullopt;
    return FluidRange{quantile(inside, weakestFluid), quantile(inside, 1.0 - weakestFluid)};
}

class SectionSearch {
public:
    SectionSearch(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu, double softHu,
                  double coreHu, double brightHu, std::span<const std::uint32_t> excluded)
        : grid_(labels.grid()),
          out_(labels.writable()),
          hu_(hu),
          softHu_(softHu),
          coreHu_(coreHu),
          brightHu_(brightHu),
          marks_(grid_.voxelCount(), 0) {
        for (std::size_t n = 0; n < marks_.size(); ++n)
            marks_[n] = out_[n] == 0 && hu[n] > coreHu ? isFluid : 0;
        for (std::uint32_t index : excluded)
            marks_[index] = isBarred;
        for (std::size_t n = 0; n < marks_.size(); ++n) {
            if (!(marks_[n] & isFluid)) continue;
            int around = 0;
            visitNeighbours(grid_, n, [&](std::size_t at) { around += marks_[at] & isFluid; });
            if (around == 6) marks_[n] |= isDeep;
        }
    }

    double run() {
        std::vector<std::vector<std::uint32_t>> bodies = findBodies();
        const double voxelMl = grid_.voxelVolumeMm3() / 1000.0;
        double addedMl = 0.0;
        for (bool changed = true; changed;) {
            changed = false;
            for (auto& body : bodies) {
                if (body.empty() || openingMm2(body) < smallestOpeningMm2) continue;
                addedMl += double(take(body)) * voxelMl;
                body.clear();
                changed = true;
            }
        }
        return addedMl;
    }

private:
    // Fluid that a flood with no pinhole joins, with the rim that such a flood leaves.
    std::vector<std::vector<std::uint32_t>> findBodies() {
        const std::size_t smallest = std::size_t(smallestMl * 1000.0 / grid_.voxelVolumeMm3());
        std::vector<std::vector<std::uint32_t>> bodies;
        for (std::size_t n = 0; n < marks_.size(); ++n) {
            if (!(marks_[n] & isDeep) || (marks_[n] & isSeen)) continue;
            std::vector<std::uint32_t> body{std::uint32_t(n)};
            marks_[n] |= isSeen;
            grow(body, 0, [&](std::size_t at) { return bool(marks_[at] & isDeep); });
            if (body.size() < smallest || !isFluidLike(body)) continue;
            std::size_t ring = 0;
            for (int layer = 0; layer < rimVoxels; ++layer)
                ring = growOnce(body, ring, [&](std::size_t at) { return marks_[at] & isFluid; });
            bodies.push_back(std::move(body));
        }
        return bodies;
    }

    // Fluid is even, and like the fluid elsewhere; bone is bright outside and dark inside.
    bool isFluidLike(const std::vector<std::uint32_t>& body) const {
        std::vector<std::int16_t> values;
        values.reserve(body.size());
        for (std::uint32_t index : body)
            values.push_back(hu_[index]);
        const double median = quantile(values, 0.5) - softHu_;
        return quantile(values, 0.95) - softHu_ < mostOverMedian * median &&
               median < mostOverFluid * (brightHu_ - softHu_);
    }

    template <class Accept>
    std::size_t growOnce(std::vector<std::uint32_t>& body, std::size_t from, Accept&& accept) {
        const std::size_t end = body.size();
        for (std::size_t head = from; head < end; ++head) {
            visitNeighbours(grid_, body[head], [&](std::size_t at) {
                if ((marks_[at] & (isSeen | isBarred)) || out_[at] != 0 || !accept(at)) return;
                marks_[at] |= isSeen;
                body.push_back(std::uint32_t(at));
            });
        }
        return end;
    }
    template <class Accept>
    void grow(std::vector<std::uint32_t>& body, std::size_t from, Accept&& accept) {
        while (from < body.size())
            from = growOnce(body, from, accept);
    }

    // visit(axis, sign, step) for each way from the voxel into labelled lumen that no wall bars:
    // straight, through partial volume with air, or through fluid thinned by no more than half.
    template <class Visit>
    void openings(std::uint32_t index, double edgeHu, Visit&& visit) const {
        walkAxes(
            grid_, index, openingVoxels,
            [&](std::size_t at) { return out_[at] != 0 || (marks_[at] & isFluid); },
            [&](int axis, int sign, int step, std::size_t at) {
                if (out_[at] == 0) return;
                bool open = true;
                if (out_[at] != std::uint8_t(LumenLabel::air)) {
                    for (int n = 1; n < step; ++n)
                        open = open && hu_[along(index, axis, sign * n)] > edgeHu;
                }
                if (open) visit(axis, sign, step);
            });
    }
    std::size_t along(std::size_t index, int axis, int steps) const {
        const std::ptrdiff_t strides[3] = {1, grid_.size.x,
                                           std::ptrdiff_t(grid_.size.x) * grid_.size.y};
        return std::size_t(std::ptrdiff_t(index) + strides[axis] * steps);
    }

    // HU half-way from soft tissue to the body's mean.
    double edgeHuOf(const std::vector<std::uint32_t>& body) const {
        double sum = 0.0;
        for (std::uint32_t index : body)
            sum += hu_[index];
        return softHu_ + edgeShare * (sum / double(body.size()) - softHu_);
    }

    // The area over which the body opens into labelled lumen, as faces of voxels.
    double openingMm2(const std::vector<std::uint32_t>& body) const {
        const glm::dvec3 spacing = grid_.spacingMm();
        const double voxelMm3 = spacing.x * spacing.y * spacing.z, edgeHu = edgeHuOf(body);
        double area = 0.0;
        for (std::uint32_t index : body)
            openings(index, edgeHu, [&](int axis, int, int) { area += voxelMm3 / spacing[axis]; });
        return area;
    }

    // Labels the body out to half its brightness, and the partial volume between it and the lumen.
    std::size_t take(std::vector<std::uint32_t>& body) {
        const double edgeHu = edgeHuOf(body);
        std::vector<std::uint32_t> between;
        for (std::uint32_t index : body) {
            openings(index, edgeHu, [&](int axis, int sign, int step) {
                for (int n = 1; n < step; ++n)
                    between.push_back(std::uint32_t(along(index, axis, sign * n)));
            });
        }
        std::size_t ring = 0;
        for (int layer = 0; layer < edgeVoxels; ++layer)
            ring = growOnce(body, ring, [&](std::size_t at) { return hu_[at] > edgeHu; });
        body.insert(body.end(), between.begin(), between.end());
        std::size_t added = 0;
        for (std::uint32_t index : body) {
            added += out_[index] == 0;
            if (out_[index] == 0) out_[index] = std::uint8_t(LumenLabel::tagged);
            marks_[index] = isSeen;
        }
        return added;
    }

    const Grid grid_;
    const std::span<std::uint8_t> out_;
    const Volume<std::int16_t>& hu_;
    const double softHu_, coreHu_, brightHu_;
    std::vector<std::uint8_t> marks_;
};

}  // namespace

double addFilledSections(Volume<std::uint8_t>& labels, const Volume<std::int16_t>& hu,
                         const TissueModel& tissue, std::span<const std::uint32_t> excluded) {
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    const auto fluid = fluidRange(labels, hu);
    if (!fluid || fluid->weakHu <= softHu) return 0.0;
    const double coreHu =
        std::max(tissue.taggedAboveHu, softHu + coreShare * (fluid->weakHu - softHu));
    return SectionSearch(labels, hu, softHu, coreHu, fluid->brightHu, excluded).run();
}

}  // namespace haustra::topology
