#include "cad/lesion_features.h"

#include "cad/wall_lift.h"
#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace haustra::cad {
namespace {

class Named {
public:
    void operator()(FeatureName name, double value) {
        values_[name.number] = float(std::isfinite(value) ? std::clamp(value, -1e6, 1e6) : 0.0);
    }
    const FeatureVector& values() const { return values_; }

private:
    FeatureVector values_{};
};

double quantile(std::vector<float>& values, double share) {
    return values.empty() ? 0.0 : quantileOf(values, share);
}

double mean(const std::vector<float>& values) {
    return values.empty()
               ? 0.0
               : std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double deviation(const std::vector<float>& values) {
    const double m = mean(values);
    double squares = 0.0;
    for (const float v : values)
        squares += (v - m) * (v - m);
    return values.empty() ? 0.0 : std::sqrt(squares / double(values.size()));
}

// Samples around the patch, up to this far from its rim along the wall.
constexpr double ringMm = 2.5;

std::vector<std::uint32_t> ringAround(const WallSamples& wall, const Lesion& lesion,
                                      SampleNumbers& numbers) {
    widen(wall, lesion.patch.samples, ringMm, numbers);
    std::vector<std::uint32_t> ring;
    for (auto n = std::uint32_t(lesion.patch.samples.size()); n < numbers.count(); ++n)
        ring.push_back(numbers.sample(n));
    return ring;
}

void describeForm(const Lesion& lesion, Named& put) {
    const double d = std::max(lesion.diameter.mm, 0.1);
    put("diameter_mm", lesion.diameter.mm);
    put("width_ratio", lesion.widthMm / d);
    put("height_mm", lesion.heightMm);
    put("height_ratio", lesion.heightMm / d);
    put("compactness", std::cbrt(std::max(lesion.volumeMm3, 0.0) * 6.0 / std::numbers::pi) / d);
    put("neck_ratio", std::sqrt(4.0 * lesion.baseMm2 / std::numbers::pi) / d);
}

void describeShape(const WallEvidence& evidence, const Lesion& lesion, Named& put) {
    std::vector<float> indices, curvedness, k2;
    double caps = 0.0, area = 0.0;
    for (const std::uint32_t v : lesion.patch.samples) {
        const WallShape& shape = evidence.shapes[v];
        indices.push_back(shape.shapeIndex());
        curvedness.push_back(shape.curvedness());
        k2.push_back(shape.k2);
        area += evidence.samples.areaMm2[v];
        if (shape.shapeIndex() > 0.9f) caps += evidence.samples.areaMm2[v];
    }
    put("shape_index_mean", mean(indices));
    put("shape_index_sd", deviation(indices));
    put("shape_index_p90", quantile(indices, 0.9));
    put("curvedness_mean", mean(curvedness));
    put("curvedness_size", mean(curvedness) * lesion.diameter.mm);
    put("k2_mean_size", mean(k2) * lesion.diameter.mm);
    put("cap_share", area > 0.0 ? caps / area : 0.0);
}

void describeRing(const WallEvidence& evidence, const std::vector<std::uint32_t>& ring,
                  Named& put) {
    std::vector<float> k1, k2;
    double ridge = 0.0, wetArea = 0.0, area = 0.0;
    for (const std::uint32_t v : ring) {
        const WallShape& shape = evidence.shapes[v];
        k1.push_back(shape.k1), k2.push_back(shape.k2);
        const double mm2 = evidence.samples.areaMm2[v];
        area += mm2;
        if (shape.k1 > 0.1f && std::abs(shape.k2) < 0.5f * shape.k1) ridge += mm2;
        if (evidence.wet[v]) wetArea += mm2;
    }
    put("ring_k1_mean", mean(k1));
    put("ring_k2_p10", quantile(k2, 0.1));
    put("ring_k2_p90", quantile(k2, 0.9));
    put("ring_ridge_share", area > 0.0 ? ridge / area : 0.0);
    const double wet = area > 0.0 ? wetArea / area : 0.0;
    put("wet_edge", 4.0 * wet * (1.0 - wet));
}

// The ileocecal valve opens into the colon where the cecum ends, some 6 cm above its blind end; a
// rectal tube and its balloon lie in the last 10 cm. Along the centerline, with what they span.
constexpr double valveFromMm = 15.0, valveToMm = 120.0, tubeToMm = 110.0;

// 1 where such a thing can be, so that what else is known of a place is weighed otherwise there.
// Where the colon's parts are known and the first or the last is missing, nowhere.
void describeRegion(const PreparedColon& colon, double arcMm, Named& put) {
    const bool rectum =
        colon.pieces.empty() || segmentOf(colon.pieces.front().part) == ColonSegment::rectum;
    const bool cecum =
        colon.pieces.empty() || segmentOf(colon.pieces.back().part) == ColonSegment::cecum;
    const double aboveEndMm = colon.centerline.points.back().arcMm - arcMm;
    put("valve_region", cecum && aboveEndMm >= valveFromMm && aboveEndMm <= valveToMm);
    put("tube_region", rectum && arcMm <= tubeToMm);
}

// Of a polyp of 25 mm; of what is wider, the surface is far from anything that could point at it.
constexpr double farthestGradientMm = 16.0;

void describeGradients(const WallEvidence& evidence, const Lesion& lesion, Named& put) {
    const double radius = std::min(0.6 * lesion.diameter.mm + 1.0, farthestGradientMm);
    // At the centre; and the greatest of there, half way to the top, and as far beyond it.
    const double atCenter = gradientConcentration(*evidence.smooth, lesion.centerMm, radius);
    put("gradient_concentration", atCenter);
    double most = atCenter;
    for (const double way : {0.5, 1.5}) {
        const glm::dvec3 place = glm::mix(lesion.topMm, lesion.centerMm, way);
        most = std::max(most, gradientConcentration(*evidence.smooth, place, radius));
    }
    put("gradient_concentration_max", most);
    std::vector<float> steep;
    for (const std::uint32_t v : lesion.patch.samples)
        steep.push_back(evidence.shapes[v].gradient);
    const WallStatistics& s = evidence.statistics;
    put("gradient_sharpness", mean(steep) / std::max(1.0, s.wallHu - emptyHu));
}

// Of the scan as it came, in the lumen before the patch: gas, or the tagging that stood there. What
// is left of a lump of residue has gas before it, a polyp in a pool the pool.
double outsideHu(const PreparedColon& colon, const WallEvidence& evidence, const Lesion& lesion) {
    constexpr double offMm = 2.5;
    const glm::dmat4 voxelFromPatient = colon.ct.grid().voxelFromPatient();
    double sum = 0.0;
    long count = 0;
    for (const std::uint32_t v : lesion.patch.samples) {
        const glm::dvec3 at =
            evidence.samples.mesh.vertices[v] - offMm * glm::dvec3(evidence.shapes[v].intoWall);
        const glm::ivec3 voxel = glm::round(glm::dvec3(voxelFromPatient * glm::dvec4(at, 1.0)));
        if (!colon.ct.grid().contains(voxel)) continue;
        sum += colon.ct.at(voxel), ++count;
    }
    return count > 0 ? sum / double(count) : emptyHu;
}

// How far a profile falls below what is greater on both sides of it, where that is most.
float deepestDip(std::span<const float> hu) {
    std::vector<float> after(hu.begin(), hu.end());
    for (std::size_t n = after.size() - 1; n-- > 0;)
        after[n] = std::max(after[n], after[n + 1]);
    float deepest = 0.0f, before = hu.front();
    for (std::size_t n = 0; n < hu.size(); ++n) {
        before = std::max(before, hu[n]);
        deepest = std::max(deepest, std::min(before, after[n]) - hu[n]);
    }
    return deepest;
}

// Stool is crumbs with gas between, a polyp is of one tissue (Pickhardt, RadioGraphics 2004; 24:
// 1535). Along rays into the body: of the smoothed scan, and of the cleansed voxels as they are,
// which hold small bubbles better and noise, too. The gap behind a head or a fold is a dip as well.
void describeBubbles(const PreparedColon& colon, const WallEvidence& evidence, const Lesion& lesion,
                     double unitHu, Named& put) {
    constexpr double stepMm = 0.5, mostDipHu = 400.0;
    constexpr std::size_t mostRays = 250;
    const double deepMm = std::clamp(lesion.heightMm + 1.0, 3.0, 8.0);
    const auto steps = std::size_t(deepMm / stepMm) + 1;
    const SmoothScan& smooth = *evidence.smooth;
    const glm::dmat4 voxelFromPatient = colon.cleansed.grid().voxelFromPatient();
    const std::vector<std::uint32_t>& samples = lesion.patch.samples;
    const std::size_t stride = (samples.size() + mostRays - 1) / mostRays;
    std::vector<float> dips, rawDips, profile(steps), rawProfile(steps);
    for (std::size_t n = 0; n < samples.size(); n += stride) {
        const glm::dvec3 from = evidence.samples.mesh.vertices[samples[n]],
                         step = stepMm * glm::dvec3(evidence.shapes[samples[n]].intoWall);
        for (std::size_t s = 0; s < steps; ++s) {
            const glm::dvec4 at(from + double(s) * step, 1.0);
            profile[s] = smooth.linear(glm::vec3(smooth.voxelFromPatient() * at));
            const glm::ivec3 voxel = glm::round(glm::dvec3(voxelFromPatient * at));
            rawProfile[s] = colon.cleansed.grid().contains(voxel) ? float(colon.cleansed.at(voxel))
                                                                  : float(emptyHu);
        }
        dips.push_back(float(std::min<double>(deepestDip(profile), mostDipHu) / unitHu));
        rawDips.push_back(float(std::min<double>(deepestDip(rawProfile), mostDipHu) / unitHu));
    }
    put("dip_mean", mean(dips));
    put("dip_p90", quantile(dips, 0.9));
    put("dip_raw", mean(rawDips));
}

void describeContents(const PreparedColon& colon, const WallEvidence& evidence,
                      std::span<const float> textureDistance, const Lesion& lesion,
                      const std::vector<std::uint32_t>& ring, Named& put) {
    const WallStatistics& s = evidence.statistics;
    const double unit = std::max(20.0, s.wallHu - s.fatHu);
    const Grid& grid = colon.cleansed.grid();
    std::vector<float> density, removed, raw;
    double fat = 0.0, gas = 0.0;
    // Gas that is surely inside; and what is as light as fat without being the blur between tissue
    // and gas, which is several times as steep as that between tissue and fat.
    const double gasBelowHu = 0.5 * (colon.tissue.airBelowHu + emptyHu);
    const double steepestFat = 0.75 * unit;
    for (const VoxelRun& run : lesion.voxels) {
        for (int n = 0; n < run.count; ++n) {
            const glm::ivec3 voxel = run.first + glm::ivec3(n, 0, 0);
            const glm::dvec3 at = grid.patientFromVoxelPoint(glm::dvec3(voxel));
            const double hu = evidence.smooth->at(at);
            gas += hu < gasBelowHu;
            fat += std::abs(hu - s.fatHu) < 0.5 * unit &&
                   glm::length(evidence.smooth->gradient(at)) < steepestFat;
            density.push_back(float((hu - s.wallHu) / unit));
            const int cleansed = colon.cleansed.at(voxel);
            raw.push_back(float((cleansed - s.wallHu) / unit));
            removed.push_back(float(std::max(0, colon.ct.at(voxel) - cleansed) / unit));
        }
    }
    const double voxels = std::max(1.0, double(density.size()));
    put("fat_share", fat / voxels);
    put("gas_share", gas / voxels);
    if (density.empty()) density.push_back(-3.0f), raw.push_back(-3.0f), removed.push_back(0.0f);
    // Of what is surely tissue, beside the scan's own noise; quantiles change the voxels' order.
    std::vector<float> core;
    for (std::size_t n = 0; n < density.size(); ++n)
        if (density[n] > -0.6f) core.push_back(raw[n]);
    put("density_spread", deviation(core));
    put("removed_density", mean(removed));
    put("removed_p90", quantile(removed, 0.9));
    put("scan_noise", s.noiseHu / unit);
    put("density_median", quantile(density, 0.5));
    put("density_p90", quantile(density, 0.9));
    put("density_core", quantile(density, 0.98));
    put("outside_density", (outsideHu(colon, evidence, lesion) - s.wallHu) / unit);
    std::vector<float> peaks, ringPeaks, broad;
    for (const std::uint32_t v : lesion.patch.samples) {
        peaks.push_back(float((evidence.rays[v].peakHu - s.wallHu) / unit));
        broad.push_back(evidence.broadShapes[v].k2);
    }
    for (const std::uint32_t v : ring)
        ringPeaks.push_back(float((evidence.rays[v].peakHu - s.wallHu) / unit));
    const double peak = quantile(peaks, 0.5);
    put("peak_median", peak);
    put("peak_over_ring", peak - quantile(ringPeaks, 0.5));
    put("peak_p90", quantile(peaks, 0.9));
    put("peak_spread", deviation(peaks));
    describeBubbles(colon, evidence, lesion, unit, put);
    put("broad_k2_size", mean(broad) * lesion.diameter.mm);
    if (textureDistance.empty()) return;
    std::vector<float> distances;
    double like = 0.0;
    for (const std::uint32_t v : lesion.patch.samples) {
        distances.push_back(textureDistance[v]);
        like += textureDistance[v] < 1.0f;
    }
    put("texture_share", like / double(distances.size()));
    put("texture_distance", std::min(quantile(distances, 0.25), 10.0));
}

void describeSurroundings(const PreparedColon& colon, const WallEvidence& evidence,
                          const Lesion& lesion, Named& put) {
    double wet = 0.0, reenters = 0.0, area = 0.0;
    std::vector<float> behind;
    for (const std::uint32_t v : lesion.patch.samples) {
        const double mm2 = evidence.samples.areaMm2[v];
        area += mm2;
        if (evidence.wet[v]) wet += mm2;
        if (evidence.rays[v].reenters) reenters += mm2;
        behind.push_back(evidence.rays[v].tissueMm);
    }
    put("former_fluid_mm", evidence.formerFluid.distanceMm(lesion.topMm));
    put("wet_share", area > 0.0 ? wet / area : 0.0);
    put("reentry_share", area > 0.0 ? reenters / area : 0.0);
    put("tissue_behind_mm", quantile(behind, 0.5));
    if (!colon.centerline.points.empty()) {
        const WallPlace along = evidence.alongColon->at(lesion.topMm);
        describeRegion(colon, along.arcMm, put);
        const glm::dvec3 way = along.cameraMm - lesion.centerMm;
        const double length = glm::length(way);
        put("toward_axis", length > 0.0 ? glm::dot(way, lesion.axis) / length : 0.0);
    }
    // How much lumen is left above it.
    constexpr double farthestMm = 30.0, stepMm = 0.5;
    double clearance = 0.0;
    for (double off = 1.5; off < farthestMm; off += stepMm) {
        const glm::dvec3 p = lesion.topMm + off * lesion.axis;
        if (evidence.smooth->at(p) > colon.tissue.airBelowHu) break;
        clearance = off;
    }
    put("clearance_mm", clearance);
}

}  // namespace

double gradientConcentration(const SmoothScan& scan, glm::dvec3 placeMm, double radiusMm) {
    constexpr int directions = 60;
    constexpr double fromMm = 1.0, stepMm = 0.75;
    double sum = 0.0;
    for (int n = 0; n < directions; ++n) {
        const double z = 1.0 - (2.0 * n + 1.0) / directions, turn = 2.399963229728653 * n,
                     r = std::sqrt(1.0 - z * z);
        const glm::dvec3 way(r * std::cos(turn), r * std::sin(turn), z);
        double cosines = 0.0, best = -1.0;
        int count = 0;
        for (double at = fromMm; at <= radiusMm; at += stepMm) {
            const glm::dvec3 gradient = scan.gradient(placeMm + at * way);
            const double steep = glm::length(gradient);
            cosines += steep > 1e-6 ? -glm::dot(gradient, way) / steep : 0.0;
            best = std::max(best, cosines / ++count);
        }
        sum += count > 0 ? best : 0.0;
    }
    return sum / directions;
}

FeatureVector asDenseAsTheWall(const FeatureVector& features) {
    constexpr float mostDifference = 0.15f;
    const float added = std::clamp(-features[featureNumber("peak_median")], 0.0f, mostDifference);
    FeatureVector weighed = features;
    for (const std::size_t n : {featureNumber("density_median"), featureNumber("density_p90"),
                                featureNumber("density_core"), featureNumber("peak_median"),
                                featureNumber("peak_p90"), featureNumber("peak_over_ring")})
        weighed[n] += added;
    return weighed;
}

FeatureVector featuresOf(const PreparedColon& colon, const WallEvidence& evidence,
                         std::span<const float> textureDistance, const Lesion& lesion,
                         SampleNumbers& numbers) {
    Named put;
    describeForm(lesion, put);
    describeShape(evidence, lesion, put);
    const std::vector<std::uint32_t> ring = ringAround(evidence.samples, lesion, numbers);
    describeRing(evidence, ring, put);
    const WallLift lift = liftOf(evidence, lesion.patch, numbers);
    put("lift_mean", lift.meanMm);
    put("lift_top", lift.topMm);
    put("lift_rough", lift.roughMm);
    describeGradients(evidence, lesion, put);
    describeContents(colon, evidence, textureDistance, lesion, ring, put);
    describeSurroundings(colon, evidence, lesion, put);
    return put.values();
}

}  // namespace haustra::cad
