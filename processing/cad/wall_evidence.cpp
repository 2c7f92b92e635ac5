#include "cad/wall_evidence.h"

#include "cad/biopsy_transfer.h"
#include "cad/gaussian_kernel.h"
#include "core/bridges.h"
#include "core/ct_scan.h"
#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::cad {
namespace {

// Of a rebuilt wall, what lies within this of its place is not the patient's; farther out, as far
// as a disc of its area reaches, what has no more tissue beneath it than such a wall has.
constexpr double leastRebuiltMm = 6.0, rebuiltVoxels = 2.5;

// What nobody has seen because there is a bridge or a wall that was set up again.
// `bridged`: of the surface's triangles.
std::vector<std::uint8_t> inventedSamples(const PreparedColon& colon,
                                          const std::vector<std::uint8_t>& bridged,
                                          const WallSamples& samples,
                                          const std::vector<BiopsyRay>& rays, int threads) {
    const glm::dvec3 spacing = colon.lumen.grid().spacingMm();
    const double thinMm = rebuiltVoxels * std::max({spacing.x, spacing.y, spacing.z});
    std::vector<std::uint8_t> invented(samples.mesh.vertices.size(), 0);
    for (std::size_t t = 0; t < samples.mesh.triangles.size(); ++t) {
        if (!bridged[std::size_t(samples.sourceTriangle[t])]) continue;
        for (int n = 0; n < 3; ++n)
            invented[std::size_t(samples.mesh.triangles[t][n])] = 1;
    }
    parallelFor(invented.size(), 2048, threads, [&](std::size_t begin, std::size_t end) {
        // Samples near to each other have near numbers: most blocks of them have no such wall.
        glm::dvec3 low(1e30), high(-1e30);
        for (std::size_t v = begin; v < end; ++v) {
            low = glm::min(low, samples.mesh.vertices[v]);
            high = glm::max(high, samples.mesh.vertices[v]);
        }
        for (const RebuiltWallRecord& wall : colon.rebuilt) {
            const double reachMm = std::max(leastRebuiltMm, std::sqrt(wall.areaMm2 / 3.14) + 3.0);
            if (glm::distance(glm::clamp(wall.placeMm, low, high), wall.placeMm) > reachMm)
                continue;
            for (std::size_t v = begin; v < end; ++v) {
                const glm::dvec3 off = samples.mesh.vertices[v] - wall.placeMm;
                const double mm2 = glm::dot(off, off);
                if (mm2 >= reachMm * reachMm) continue;
                if (mm2 < leastRebuiltMm * leastRebuiltMm || rays[v].tissueMm < thinMm)
                    invented[v] = 1;
            }
        }
    });
    return invented;
}

// The lumen's label a little off the wall: from a voxel on, as far as it reaches along the way.
// Where slices are thick, a shallow pool would else be stepped over across them; where they are
// not, it is the largest spacing, whichever the way, as detection has learnt from voxels of up
// to 2.1 mm.
std::vector<LumenLabel> labelsBefore(const PreparedColon& colon, const WallSamples& samples,
                                     const std::vector<WallShape>& shapes, int threads) {
    const Grid& grid = colon.lumen.grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const glm::dvec3 spacing = grid.spacingMm();
    constexpr double learntMm = 2.1;
    const double least = std::min(learntMm, std::max({spacing.x, spacing.y, spacing.z}));
    std::vector<LumenLabel> labels(samples.mesh.vertices.size(), LumenLabel::outside);
    parallelFor(labels.size(), 8192, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const glm::dvec3 intoWall(shapes[v].intoWall);
            const glm::dvec3 voxels = glm::abs(glm::dmat3(voxelFromPatient) * intoWall);
            const double step =
                std::max(least, 1.0 / std::max({voxels.x, voxels.y, voxels.z, 1e-6}));
            for (double off = step; off < 2.6 * step; off += 0.5 * step) {
                const glm::dvec3 p = samples.mesh.vertices[v] - off * intoWall;
                const glm::ivec3 voxel(
                    glm::floor(glm::dvec3(voxelFromPatient * glm::dvec4(p, 1.0)) + 0.5));
                if (!grid.contains(voxel)) break;
                labels[v] = LumenLabel(colon.lumen.at(voxel));
                if (labels[v] != LumenLabel::outside) break;
            }
        }
    });
    return labels;
}

// From each sample along its shape's normal: of evidence that has shapes, the smoothed scan, the
// transfer function, and room for as many rays.
void castRays(const PreparedColon& colon, int threads, WallEvidence& evidence) {
    const BiopsyTable table(evidence.transferFunction);
    const BiopsyScan scan{*evidence.smooth, colon.lumen, colon.tissue.airBelowHu};
    parallelFor(evidence.rays.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            evidence.rays[v] = castBiopsyRay(scan, table, evidence.samples.mesh.vertices[v],
                                             glm::dvec3(evidence.shapes[v].intoWall));
    });
}

std::vector<std::uint8_t> samplesBehind(const std::vector<LumenLabel>& labels, LumenLabel what) {
    std::vector<std::uint8_t> behind(labels.size());
    std::ranges::transform(labels, behind.begin(),
                           [&](LumenLabel label) { return std::uint8_t(label == what); });
    return behind;
}

}  // namespace

SmoothScan smoothedAround(const PreparedColon& colon, double sigmaMm, int threads, double reachMm) {
    glm::dvec3 low(1e30), high(-1e30);
    for (const glm::dvec3& p : colon.surface.vertices)
        low = glm::min(low, p), high = glm::max(high, p);
    return {colon.cleansed, low - reachMm, high + reachMm, sigmaMm, threads};
}

WallStatistics wallStatistics(const PreparedColon& colon, const SmoothScan& smooth) {
    WallStatistics statistics;
    // The wall itself is thinner than the scan resolves; its tissue is soft tissue.
    statistics.wallHu = colon.tissue.meanHu[std::size_t(Tissue::soft)];
    statistics.fatHu = colon.tissue.meanHu[std::size_t(Tissue::fat)];
    // Second differences 4 mm apart, beyond the noise's grain, where all is soft tissue.
    std::vector<double> differences;
    const std::size_t step = std::max<std::size_t>(1, colon.surface.vertices.size() / 40000);
    for (std::size_t v = 0; v < colon.surface.vertices.size(); v += step) {
        const glm::dvec3 at = colon.surface.vertices[v];
        const glm::dvec3 into(shapeOf(smooth.derivatives(at)).intoWall);
        double value[3];
        bool all = true;
        for (int n = 0; n < 3 && all; ++n) {
            value[n] = smooth.at(at + (5.0 + 4.0 * n) * into);
            all = std::abs(value[n] - statistics.wallHu) < 60.0;
        }
        if (all) differences.push_back(std::abs(value[0] - 2.0 * value[1] + value[2]));
    }
    if (differences.size() > 100)
        statistics.noiseHu = medianOf(differences) / 0.6745 / std::sqrt(6.0);
    return statistics;
}

WallEvidence gatherEvidence(const PreparedColon& colon, const EvidenceOptions& options,
                            WallEvidence ofSurface) {
    const auto tell = [&](double share) {
        if (options.progress) options.progress(share);
    };
    const int threads = threadCount(options.threads);
    WallEvidence evidence;
    evidence.samples = std::move(ofSurface.samples);
    evidence.alongColon = std::move(ofSurface.alongColon);
    ofSurface = {};  // before as much is made again
    // Of the broad scale shapes are asked for at the wall alone, whose coefficients are smoothed
    // from so far; the spline's own two voxels are SmoothScan's margin.
    const glm::dvec3 spacing = colon.cleansed.grid().spacingMm();
    const double broadReachMm =
        kernelDeviations * broadSigmaMm + std::max({spacing.x, spacing.y, spacing.z});
    // Dividing the wall takes one thread, as parts of the rest do: beside it others are kept busy.
    std::unique_ptr<const SmoothScan> broad;
    const auto smoothed = [&](double sigmaMm, double reachMm) {
        return std::make_unique<const SmoothScan>(smoothedAround(colon, sigmaMm, threads, reachMm));
    };
    std::vector<std::uint8_t> bridged;  // of the surface's triangles
    const bool sampled = !evidence.samples.mesh.vertices.empty();
    parallelInvoke(
        options.threads,
        [&] {
            if (!sampled) evidence.samples = dividedWall(colon.surface, sampleSpacingMm);
        },
        [&] {
            evidence.smooth = smoothed(shapeSigmaMm, std::max(biopsyReachMm, deepestWallMm + 2.0));
        },
        [&] { broad = smoothed(broadSigmaMm, broadReachMm); },
        [&] { bridged = bridgedTriangles(colon.surface, colon.lumen); },
        [&] {
            if (!evidence.alongColon)
                evidence.alongColon =
                    std::make_unique<const AlongColon>(colon.flat, colon.centerline);
        });
    tell(0.4);
    parallelInvoke(
        options.threads,
        [&] {
            if (!sampled) joinSamples(evidence.samples);
        },
        [&] {
            evidence.rays.resize(evidence.samples.mesh.vertices.size());  // by one thread
            evidence.statistics = wallStatistics(colon, *evidence.smooth);
            evidence.transferFunction = options.transferFunction
                                            ? *options.transferFunction
                                            : automaticBiopsyTransfer(evidence.statistics);
        },
        [&] { evidence.shapes = shapesOf(evidence.samples, *evidence.smooth, threads); },
        [&] { evidence.broadShapes = shapesOf(evidence.samples, *broad, threads); });
    broad.reset();
    tell(0.6);
    parallelInvoke(
        options.threads,
        [&] {
            const auto before = labelsBefore(colon, evidence.samples, evidence.shapes, threads);
            evidence.wet = samplesBehind(before, LumenLabel::tagged);
            evidence.untagged = samplesBehind(before, LumenLabel::untagged);
            evidence.formerFluid = FormerFluid(evidence.samples.mesh.vertices, evidence.wet);
        },
        [&] { castRays(colon, threads, evidence); });
    evidence.unseen = inventedSamples(colon, bridged, evidence.samples, evidence.rays, threads);
    tell(1.0);
    return evidence;
}

}  // namespace haustra::cad
