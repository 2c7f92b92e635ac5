#include "cad/wall_edges.h"

#include "cad/median.h"
#include "core/volume.h"

#include <algorithm>
#include <vector>

namespace haustra::cad {

std::optional<WallEdges> wallEdges(const PreparedColon& colon, const WallEvidence& evidence) {
    constexpr double offMm = 0.5, stepMm = 0.25, behindMm = 4.0;
    constexpr std::size_t places = 20000, fewest = 200;
    const Grid& grid = colon.cleansed.grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const double gasHu = colon.tissue.meanHu[std::size_t(Tissue::air)],
                 stepHu = evidence.statistics.wallHu - gasHu;
    const std::size_t count = evidence.samples.mesh.vertices.size();
    std::vector<double> rises, peaks;
    for (std::size_t v = 0; v < count; v += std::max<std::size_t>(1, count / places)) {
        if (evidence.wet[v] || evidence.unseen[v] || evidence.untagged[v]) continue;
        const glm::dvec3 at = evidence.samples.mesh.vertices[v], into(evidence.shapes[v].intoWall);
        const auto share = [&](double mm) {
            const glm::dvec3 voxel(voxelFromPatient * glm::dvec4(at + mm * into, 1.0));
            return (trilinear(colon.cleansed, voxel) - gasHu) / stepHu;
        };
        double peak = 0.0;
        for (double mm = stepMm; mm < behindMm; mm += stepMm)
            peak = std::max(peak, share(mm));
        rises.push_back(share(offMm) - share(-offMm)), peaks.push_back(peak);
    }
    if (rises.size() < fewest) return std::nullopt;
    return WallEdges{medianOf(rises), medianOf(peaks)};
}

std::optional<std::string> warningOfEdges(const WallEdges& edges) {
    // 2 Φ(0.5 / 1.6) − 1: training phantoms have 0.31 and more, and peaks of 0.94 to 0.97.
    constexpr double leastRise = 0.25, greatestPeak = 1.0;
    if (edges.peak > greatestPeak)
        return "the scan's kernel enhances edges, or the wall's surface is enhanced, as it is "
               "brighter "
               "behind gas than its tissue: detection has learnt from none like it, and may miss "
               "polyps of any size";
    if (edges.rise < leastRise)
        return "the scan is more blurred than what detection has learnt from: polyps may be "
               "missed, "
               "and residue be told as polyps";
    return std::nullopt;
}

}  // namespace haustra::cad
