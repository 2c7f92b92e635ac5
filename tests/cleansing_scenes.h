// Analytic colon contents with known fractions, blurred and made noisy as a scanner does.
#pragma once

#include "cleansing/digital_cleansing.h"
#include "cleansing/mixture.h"

#include <cmath>
#include <functional>
#include <random>

namespace haustra::test {

inline constexpr double sceneAirHu = -990.0, sceneSoftHu = 42.0, sceneBlurMm = 0.5;

/// Share of a half-space in a voxel whose centre lies `mm` inside it, blurred.
inline double blurredStep(double mm) {
    return 0.5 * std::erfc(-mm / (sceneBlurMm * std::sqrt(2.0)));
}

struct Shares {
    double air, tagged;
    double soft() const { return 1.0 - air - tagged; }
};

/// A scan made of three materials in known shares, its twin with air for the tagged material and
/// the same noise, and its labels.
struct Scene {
    CtScan scan;
    Volume<std::int16_t> untagged;
    Volume<std::uint8_t> labels;
    TissueModel tissue;
    std::function<Shares(glm::dvec3)> sharesAt;  ///< by patient coordinates
};

/// `taggedHu` and `noiseSd` in HU. Labels: what is more tagged than soft and air together, or lies
/// in the blur between air and tagged, is tagged; what is mostly air is air.
inline Scene makeScene(glm::ivec3 size, double taggedHu, double noiseSd,
                       std::function<Shares(glm::dvec3)> sharesAt,
                       glm::dvec3 spacingMm = {0.75, 0.75, 1.0}) {
    const Grid grid = axisAlignedGrid(size, spacingMm);
    Scene scene{{Volume<std::int16_t>(grid), PatientPosition::supine},
                Volume<std::int16_t>(grid),
                Volume<std::uint8_t>(grid),
                {},
                std::move(sharesAt)};
    std::mt19937 random(5);
    std::normal_distribution<double> unit;  // times a deviation, which may be 0
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const Shares s = scene.sharesAt(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))));
        const double grain = noiseSd > 0.0 ? noiseSd * unit(random) : 0.0;
        const double rest = s.soft() * sceneSoftHu + grain;
        const auto stored = [](double hu) {
            return std::int16_t(std::lround(std::max(hu, -1024.0)));
        };
        scene.scan.hu.writable()[n] = stored(rest + s.air * sceneAirHu + s.tagged * taggedHu);
        scene.untagged.writable()[n] = stored(rest + (s.air + s.tagged) * sceneAirHu);
        LumenLabel label = LumenLabel::outside;
        if (s.soft() < 0.5) label = s.air > s.tagged ? LumenLabel::air : LumenLabel::tagged;
        scene.labels.writable()[n] = std::uint8_t(label);
    }
    scene.tissue.meanHu = {sceneAirHu, -95.0, sceneSoftHu, taggedHu};
    scene.tissue.sdHu = {noiseSd + 6.0, noiseSd + 6.0, noiseSd + 6.0, 60.0};
    scene.tissue.weight = {0.3, 0.1, 0.4, 0.2};
    scene.tissue.airBelowHu = 0.5 * (sceneAirHu + sceneSoftHu);
    scene.tissue.taggedAboveHu =
        sceneSoftHu + std::min(160.0, std::max(70.0, 0.5 * (taggedHu - sceneSoftHu)));
    return scene;
}

/// A tube of radius 12 mm along z in soft tissue, filled with tagged fluid below y = `levelMm`
/// from its middle (y points down) and air above.
inline Scene tubeWithLevel(double taggedHu, double noiseSd, double levelMm = 0.0,
                           glm::dvec3 spacingMm = {0.75, 0.75, 1.0}) {
    const glm::ivec3 size(glm::round(glm::dvec3(42.0, 42.0, 24.0) / spacingMm));
    const glm::dvec2 middle(20.7, 20.55);
    return makeScene(
        size, taggedHu, noiseSd,
        [=](glm::dvec3 p) {
            const glm::dvec2 d = glm::dvec2(p) - middle;
            const double open = blurredStep(12.0 - glm::length(d));
            const double fluid = blurredStep(d.y - levelMm);
            return Shares{open * (1.0 - fluid), open * fluid};
        },
        spacingMm);
}

struct CleansedScene {
    Volume<TissueFractions> mixture;
    cleansing::Cleansed cleansed;
};

inline CleansedScene cleanseScene(const Scene& scene, int threads = 1) {
    cleansing::MixtureOptions options;
    options.threads = threads;
    auto mixture = cleansing::estimateMixture(scene.scan, scene.tissue, scene.labels,
                                              gravityDirection(scene.scan.position), options);
    auto cleansed = cleansing::cleanse(scene.scan, scene.tissue, *mixture, scene.labels, threads);
    return {std::move(*mixture), std::move(*cleansed)};
}

struct ErrorStatistics {
    double bias = 0.0, rmse = 0.0;
    int count = 0;
};

/// Of the cleansed HU against the untagged twin, over the voxels where `counts(shares, patient)`.
template <class Counts>
ErrorStatistics errorWhere(const Scene& scene, const cleansing::Cleansed& cleansed,
                           const Counts& counts) {
    ErrorStatistics e;
    const Grid& grid = scene.scan.hu.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (v.z < 2 || v.z + 2 >= grid.size.z) continue;
        const glm::dvec3 p = grid.patientFromVoxelPoint(glm::dvec3(v));
        if (!counts(scene.sharesAt(p), p)) continue;
        const double error = cleansed.hu[n] - scene.untagged[n];
        e.bias += error, e.rmse += error * error, ++e.count;
    }
    if (e.count > 0) e.bias /= e.count, e.rmse = std::sqrt(e.rmse / e.count);
    return e;
}

}  // namespace haustra::test
