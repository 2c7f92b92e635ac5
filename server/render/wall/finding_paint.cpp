#include "render/wall/finding_paint.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

namespace haustra::render {
namespace {

constexpr int cellSide = 8;  // voxels
// Far from the wall's red for those who tell red from green, and by its lightness for others.
constexpr int findingCover = 165, candidateCover = 120;

}  // namespace

FindingTissue::FindingTissue(const Grid& grid, std::span<const Finding> findings)
    : grid_(grid), voxelFromPatient_(grid.voxelFromPatient()) {
    const glm::dvec3 spacing = grid.spacingMm();
    reachMm_ = 0.5 * glm::length(spacing);
    stepMm_ = 0.25 * std::min({spacing.x, spacing.y, spacing.z});
    cellCount_ = grid.size / cellSide + 1;
    cells_.resize(std::size_t(cellCount_.x) * std::size_t(cellCount_.y) *
                  std::size_t(cellCount_.z));
    for (std::size_t n = 0; n < findings.size(); ++n) {
        const Finding& finding = findings[n];
        if (finding.voxels.empty())
            balls_.push_back({finding.positionMm, 0.5 * finding.diameterMm, int(n)});
        for (const VoxelRun& run : finding.voxels) {
            for (int i = 0; i < run.count; ++i) {
                const glm::ivec3 voxel = run.first + glm::ivec3(i, 0, 0);
                ofVoxel_.emplace(grid.index(voxel), int(n));
                cells_[cellOf(voxel)] = true;
            }
        }
    }
}

std::uint64_t FindingTissue::cellOf(glm::ivec3 voxel) const {
    const glm::ivec3 cell = voxel / cellSide;
    return std::uint64_t(cell.x) +
           std::uint64_t(cellCount_.x) *
               (std::uint64_t(cell.y) + std::uint64_t(cellCount_.y) * std::uint64_t(cell.z));
}

int FindingTissue::mostOf(glm::dvec3 voxel) const {
    const glm::dvec3 low = glm::floor(voxel), part = voxel - low;
    std::array<std::pair<int, double>, 8> shares;
    std::size_t known = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::ivec3 at = glm::ivec3(low) + step;
        if (!grid_.contains(at) || !cells_[cellOf(at)]) continue;
        const auto found = ofVoxel_.find(grid_.index(at));
        if (found == ofVoxel_.end()) continue;
        double share = 1.0;
        for (int axis = 0; axis < 3; ++axis)
            share *= step[axis] ? part[axis] : 1.0 - part[axis];
        std::size_t n = 0;
        while (n < known && shares[n].first != found->second)
            ++n;
        if (n == known) shares[known++] = {found->second, 0.0};
        shares[n].second += share;
    }
    int most = -1;
    double greatest = 0.0;
    for (std::size_t n = 0; n < known; ++n)
        if (shares[n].second > greatest) most = shares[n].first, greatest = shares[n].second;
    return greatest >= leastShare ? most : -1;
}

int FindingTissue::at(glm::dvec3 placeMm, glm::dvec3 inward) const {
    if (!ofVoxel_.empty()) {
        const glm::dvec3 from(voxelFromPatient_ * glm::dvec4(placeMm, 1.0)),
            perMm(voxelFromPatient_ * glm::dvec4(-inward, 0.0));
        for (double deep = 0.0; deep <= reachMm_; deep += stepMm_) {
            const int finding = mostOf(from + deep * perMm);
            if (finding >= 0) return finding;
        }
    }
    for (const Ball& ball : balls_)
        if (glm::distance(placeMm, ball.centerMm) <= ball.radiusMm) return ball.finding;
    return -1;
}

namespace {

// What two of them hold is the more probable one's.
class RankedFindings {
public:
    explicit RankedFindings(const Findings& findings)
        : indices_(findings.findings.size() + findings.candidates.size()) {
        std::iota(indices_.begin(), indices_.end(), 0);
        const auto above = std::int32_t(findings.findings.size());
        const auto of = [&](std::int32_t n) -> const Finding& {
            return n < above ? findings.findings[std::size_t(n)]
                             : findings.candidates[std::size_t(n - above)];
        };
        std::stable_sort(indices_.begin(), indices_.end(), [&](std::int32_t a, std::int32_t b) {
            const bool aIsBelow = a >= above, bIsBelow = b >= above;
            return aIsBelow != bIsBelow ? bIsBelow : of(a).score > of(b).score;
        });
        std::vector<Finding> ranked;
        for (const std::int32_t n : indices_)
            ranked.push_back(of(n));
        tissue_.emplace(findings.grid, ranked);
    }
    std::int32_t at(glm::dvec3 placeMm, glm::dvec3 inward) const {
        const int rank = tissue_->at(placeMm, inward);
        return rank < 0 ? -1 : indices_[std::size_t(rank)];
    }
    std::vector<std::int32_t> ofTriangles(const WallSight& sight) const {
        const auto& facets = sight.facets();
        std::vector<std::int32_t> of(facets.size(), -1);
        parallelFor(facets.size(), 4096, 0, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t)
                if (!sight.isBridge(int(t)))
                    of[t] = at(sight.originMm() + glm::dvec3(facets[t].middleMm),
                               glm::dvec3(facets[t].inward));
        });
        return of;
    }
    std::size_t count() const { return indices_.size(); }

private:
    std::vector<std::int32_t> indices_;  // of the findings, the first in rank first
    std::optional<FindingTissue> tissue_;
};

}  // namespace

std::vector<std::int32_t> findingTriangles(const WallSight& sight, const Findings& findings) {
    return RankedFindings(findings).ofTriangles(sight);
}

std::vector<FindingPixel> findingPixels(const StripPainter& painter, const Findings& findings) {
    const RankedFindings ranked(findings);
    const glm::ivec2 size = painter.size();
    const std::size_t count = std::size_t(size.x) * std::size_t(size.y);
    std::vector<std::int32_t> ofPixel(count, -1);
    const auto& facets = painter.sight().facets();
    parallelFor(std::size_t(size.y), 64, 0, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin * std::size_t(size.x); n < end * std::size_t(size.x); ++n) {
            const auto place = painter.placeAt(std::int32_t(n));
            if (place && !painter.sight().isBridge(place->triangle))
                ofPixel[n] = ranked.at(place->positionMm,
                                       glm::dvec3(facets[std::size_t(place->triangle)].inward));
        }
    });
    // A conformal map shrinks a head on a long stalk to a pixel or less: of what has fewer pixels
    // than triangles all pixels beside these, which a smooth paint's colour is made of, are its.
    std::vector<std::size_t> pixelsOf(ranked.count(), 0), trianglesOf(ranked.count(), 0);
    for (const std::int32_t finding : ofPixel)
        if (finding >= 0) ++pixelsOf[std::size_t(finding)];
    const std::vector<std::int32_t> ofTriangle = ranked.ofTriangles(painter.sight());
    for (const std::int32_t finding : ofTriangle)
        if (finding >= 0) ++trianglesOf[std::size_t(finding)];
    for (std::size_t t = 0; t < facets.size(); ++t) {
        const std::int32_t finding = ofTriangle[t];
        if (finding < 0 || pixelsOf[std::size_t(finding)] >= trianglesOf[std::size_t(finding)])
            continue;
        const glm::dvec2 at = glm::dvec2(size) - glm::dvec2(facets[t].flat) * double(size.x) - 0.5;
        for (const glm::ivec2 step : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
            const glm::ivec2 pixel = glm::ivec2(glm::floor(at)) + step;
            if (pixel.y < 0 || pixel.y >= size.y) continue;
            const int x = (pixel.x % size.x + size.x) % size.x;
            std::int32_t& of = ofPixel[std::size_t(pixel.y) * std::size_t(size.x) + std::size_t(x)];
            if (of < 0) of = finding;
        }
    }
    std::vector<FindingPixel> pixels;
    for (std::size_t n = 0; n < count; ++n)
        if (ofPixel[n] >= 0) pixels.push_back({std::int32_t(n), ofPixel[n]});
    return pixels;
}

std::vector<TintedPixel> colorFindings(std::span<const FindingPixel> pixels,
                                       std::span<const FindingShade> shades) {
    std::vector<TintedPixel> tinted;
    for (const FindingPixel& pixel : pixels) {
        const FindingShade shade = shades[std::size_t(pixel.finding)];
        if (shade == FindingShade::none) continue;
        tinted.push_back({pixel.pixel, shade == FindingShade::finding
                                           ? glm::u8vec4(findingColor, findingCover)
                                           : glm::u8vec4(candidateColor, candidateCover)});
    }
    return tinted;
}

}  // namespace haustra::render
