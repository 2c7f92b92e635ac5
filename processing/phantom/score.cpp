#include "phantom/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace haustra::phantom {
namespace {

double dice(std::size_t both, std::size_t truth, std::size_t found) {
    return truth + found == 0 ? 1.0 : 2.0 * double(both) / double(truth + found);
}

/// Steps from a voxel to all others within a distance.
std::vector<glm::ivec3> ball(const Grid& grid, double radiusMm) {
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::ivec3 reach(glm::floor(radiusMm / spacing));
    std::vector<glm::ivec3> steps;
    for (int k = -reach.z; k <= reach.z; ++k) {
        for (int j = -reach.y; j <= reach.y; ++j) {
            for (int i = -reach.x; i <= reach.x; ++i) {
                if (glm::length(glm::dvec3(i, j, k) * spacing) <= radiusMm)
                    steps.emplace_back(i, j, k);
            }
        }
    }
    // Nearest first: most voxels beside the wall are settled by a neighbour.
    std::sort(steps.begin(), steps.end(), [&](glm::ivec3 a, glm::ivec3 b) {
        return glm::length(glm::dvec3(a) * spacing) < glm::length(glm::dvec3(b) * spacing);
    });
    return steps;
}

double distanceToPolyline(const Centerline& line, glm::dvec3 p) {
    double best = std::numeric_limits<double>::max();
    const auto& points = line.points;
    for (std::size_t n = 0; n < points.size(); ++n) {
        const glm::dvec3 a = points[n].positionMm,
                         b = points[n + 1 < points.size() ? n + 1 : n].positionMm;
        const glm::dvec3 ab = b - a, ap = p - a;
        const double length2 = glm::dot(ab, ab);
        const double t = length2 > 0.0 ? std::clamp(glm::dot(ap, ab) / length2, 0.0, 1.0) : 0.0;
        const glm::dvec3 d = ap - t * ab;
        best = std::min(best, glm::dot(d, d));
    }
    return std::sqrt(best);
}

void scoreVolumes(const Volume<std::uint8_t>& truth, const Volume<std::uint8_t>& found,
                  LumenScore& score) {
    const Grid& grid = truth.grid();
    const std::vector<glm::ivec3> steps = ball(grid, falseBeyondMm);
    // Label by label, then any label (0).
    std::array<std::size_t, 3> both{}, inTruth{}, inFound{};
    std::size_t far = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const std::uint8_t t = truth[n], f = found[n];
        if (!t && !f) continue;
        ++(t ? inTruth : inFound)[0];
        if (t && f) ++inFound[0], ++both[0];
        if (t == 1 || t == 2) ++inTruth[t];
        if (f == 1 || f == 2) ++inFound[f];
        if (t == f && t <= 2) ++both[t];
        if (!t) {
            const glm::ivec3 v = grid.voxelAt(n);
            far += std::none_of(steps.begin(), steps.end(), [&](glm::ivec3 s) {
                return grid.contains(v + s) && truth.at(v + s);
            });
        }
    }
    const double ml = grid.voxelVolumeMm3() * 1e-3;
    score.dice = dice(both[0], inTruth[0], inFound[0]);
    score.diceAir = dice(both[1], inTruth[1], inFound[1]);
    score.diceTagged = dice(both[2], inTruth[2], inFound[2]);
    score.overMl = ml * double(inFound[0] - both[0]);
    score.missedMl = ml * double(inTruth[0] - both[0]);
    score.falseMl = ml * double(far);
}

}  // namespace

Result<LumenScore> scoreLumen(const Volume<std::uint8_t>& truthLabels,
                              const Centerline& truthCenterline,
                              const Volume<std::uint8_t>& foundLabels,
                              const Centerline& foundCenterline) {
    if (!sameGrid(truthLabels.grid(), foundLabels.grid())) {
        return fail(ErrorKind::badInput, "the found lumen and the truth are on different grids",
                    "score");
    }
    LumenScore score;
    scoreVolumes(truthLabels, foundLabels, score);

    const Grid& grid = foundLabels.grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const auto& truth = truthCenterline.points;
    double lengthMm = 0.0;
    for (std::size_t n = 0; n < truth.size(); ++n) {
        if (truth[n].gap) continue;
        // Each sample stands for the half of each span beside it.
        const double before = n > 0 ? truth[n].arcMm - truth[n - 1].arcMm : 0.0;
        const double after = n + 1 < truth.size() ? truth[n + 1].arcMm - truth[n].arcMm : 0.0;
        const double span = 0.5 * (before + after);
        const glm::ivec3 voxel(
            glm::round(glm::dvec3(voxelFromPatient * glm::dvec4(truth[n].positionMm, 1.0))));
        lengthMm += span;
        if (!grid.contains(voxel) || foundLabels.at(voxel) == 0) score.missedCenterlineMm += span;
    }
    score.missedCenterlineShare = lengthMm > 0.0 ? score.missedCenterlineMm / lengthMm : 0.0;

    double sum = 0.0;
    std::size_t count = 0;
    for (const CenterlinePoint& point : foundCenterline.points) {
        if (point.gap || truth.empty()) continue;
        const double d = distanceToPolyline(truthCenterline, point.positionMm);
        sum += d, ++count;
        score.centerlineMaxErrorMm = std::max(score.centerlineMaxErrorMm, d);
    }
    if (count > 0) score.centerlineMeanErrorMm = sum / double(count);
    return score;
}

}  // namespace haustra::phantom
