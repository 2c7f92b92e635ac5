#include "cad/wall_edges.h"

#include "core/quantile.h"
#include "core/volume.h"

#include <algorithm>

namespace haustra::cad {

std::vector<EdgeLine> edgeLines(const WallEvidence& evidence) {
    constexpr std::size_t places = 20000, fewest = 200;
    std::vector<EdgeLine> lines;
    const std::size_t count = evidence.samples.mesh.vertices.size();
    for (std::size_t v = 0; v < count; v += std::max<std::size_t>(1, count / places)) {
        if (evidence.wet[v] || evidence.unseen[v] || evidence.untagged[v]) continue;
        lines.push_back(
            {evidence.samples.mesh.vertices[v], glm::dvec3(evidence.shapes[v].intoWall)});
    }
    if (lines.size() < fewest) lines.clear();
    return lines;
}

EdgeScale edgeScale(const PreparedColon& colon, const WallEvidence& evidence) {
    const double gasHu = colon.tissue.meanHu[std::size_t(Tissue::air)];
    return {gasHu, evidence.statistics.wallHu - gasHu};
}

std::optional<WallEdges> wallEdges(const PreparedColon& colon, const WallEvidence& evidence) {
    constexpr double offMm = 0.5;
    const glm::dmat4 voxelFromPatient = colon.cleansed.grid().voxelFromPatient();
    const EdgeScale scale = edgeScale(colon, evidence);
    std::vector<double> rises, peaks;
    for (const EdgeLine& line : edgeLines(evidence)) {
        const auto share = [&](double mm) {
            const glm::dvec3 voxel(voxelFromPatient * glm::dvec4(line.at(mm), 1.0));
            return scale.shareOf(trilinear(colon.cleansed, voxel));
        };
        double peak = 0.0;
        for (std::size_t n = 0; n < edgeDepths; ++n)
            peak = std::max(peak, share(edgeDepth(n)));
        rises.push_back(share(offMm) - share(-offMm)), peaks.push_back(peak);
    }
    if (rises.empty()) return std::nullopt;
    return WallEdges{medianOf(rises), medianOf(peaks)};
}

std::optional<std::string> warningOfEdges(const WallEdges& edges,
                                          const std::optional<WallEdges>& softened) {
    // 2 Φ(0.5 / 1.6) − 1: training phantoms have 0.31 and more, and peaks of 0.94 to 0.97.
    constexpr double leastRise = 0.25;
    std::string told;
    if (edges.peak > sharpPeak) {
        told =
            "the scan's kernel enhances edges, or the wall's surface is enhanced, as it is "
            "brighter behind gas than its tissue: detection has learnt from few like it, and "
            "may miss polyps of any size";
        if (softened)
            told += softened->peak > sharpPeak
                        ? ", though it took off what it could"
                        : ", though what was added to edges was taken off before";
    }
    if ((softened ? *softened : edges).rise < leastRise)
        told += std::string(told.empty() ? "" : "; ") +
                "the scan is more blurred than what detection has learnt from: polyps may be "
                "missed, and residue be told as polyps";
    if (told.empty()) return std::nullopt;
    return told;
}

}  // namespace haustra::cad
