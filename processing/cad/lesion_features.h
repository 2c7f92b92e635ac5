// What a candidate is like, in numbers that a classifier weighs.
#pragma once

#include "cad/lesion.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

namespace haustra::cad {

/// In the order of featureNames. HU are relative to the scan: (HU − wall) / (wall − fat), so that a
/// scanner's calibration and voltage do not matter; lengths are mm.
inline constexpr std::array<std::string_view, 52> featureNames{
    // size and form
    "diameter_mm", "width_ratio", "height_mm", "height_ratio", "compactness", "neck_ratio",
    // shape index and curvedness over the patch
    "shape_index_mean", "shape_index_p90", "shape_index_sd", "curvedness_mean", "curvedness_size",
    "k2_mean_size", "cap_share",
    // how it goes over into the wall around it
    "ring_k1_mean", "ring_k2_p10", "ring_k2_p90", "ring_ridge_share",
    // how far it stands above that, continued across it (wall_lift.h)
    "lift_mean", "lift_top", "lift_rough",
    // gradients in 3-D
    "gradient_concentration", "gradient_concentration_max", "gradient_sharpness",
    // what it is made of
    "density_median", "density_p90", "density_core", "density_spread", "texture_distance",
    "texture_share", "peak_median", "peak_over_ring", "broad_k2_size", "peak_p90", "peak_spread",
    // bubbles inside, as stool has, and gaps behind
    "dip_mean", "dip_p90", "dip_raw",
    // what it borders on
    "wet_share", "wet_edge", "former_fluid_mm", "tissue_behind_mm", "reentry_share",
    "removed_density", "removed_p90",
    // what lay before it, in the scan as it came, and how well anything is known
    "outside_density", "scan_noise",
    // what else has fat or gas inside: lips of the ileocecal valve, a rectal tube
    "fat_share", "gas_share",
    // where it is
    "toward_axis", "clearance_mm", "valve_region", "tube_region"};
inline constexpr int featureCount = int(featureNames.size());
/// One of featureNames, by its place there: a name that is none of them does not compile.
struct FeatureName {
    std::size_t number = 0;
    consteval FeatureName(const char* name)
        : number(std::size_t(std::ranges::find(featureNames, std::string_view(name)) -
                             featureNames.begin())) {
        if (number == featureNames.size()) throw "no feature has this name";
    }
};
consteval std::size_t featureNumber(FeatureName name) {
    return name.number;
}
using FeatureVector = std::array<float, std::size_t(featureCount)>;

/// What rises less than this above the wall, both as a soap film and as a quadric continue it, is
/// flat to any reader (Paris 0-IIb, which CT does not show), whatever grew there.
inline constexpr float leastHeightMm = 0.5f;
inline bool rises(const FeatureVector& features) {
    return std::max(features[featureNumber("height_mm")], features[featureNumber("lift_top")]) >=
           leastHeightMm;
}

/// The features as a classifier weighs them. Polyps' own density varies: benign ones have 32 HU in
/// the mean without contrast medium, carcinomas 43 (Oto et al., Eur Radiol 2003; 13: 1657), where
/// muscle has 50 to 60; phantoms' polyps, from which trees and networks learn, have the wall's
/// density or more. How much less dense than the scan's soft tissue a place is `peak_median` tells;
/// up to 0.15, some 20 HU, that tells nothing of polyps. So all features of density are raised by
/// as much, and by 0.15 where it is more. The built-in trees and networks have learnt without this.
FeatureVector asDenseAsTheWall(const FeatureVector& features);

/// `textureDistance`: of every sample, in T; empty: unknown, and the texture features are 0.
/// `numbers`: of all samples, for its own use. O(samples of the patch and its voxels).
FeatureVector featuresOf(const PreparedColon& colon, const WallEvidence& evidence,
                         std::span<const float> textureDistance, const Lesion& lesion,
                         SampleNumbers& numbers);

/// How well the gradients around a place point to it (Kobatake and Hashimoto, IEEE TIP 1999; 8:
/// 1417): the mean, over evenly spread directions, of the greatest mean cosine between the scan's
/// gradient and the way to the place along any stretch that begins 1 mm away and ends within
/// `radiusMm`. −1…1.
double gradientConcentration(const SmoothScan& scan, glm::dvec3 placeMm, double radiusMm);

}  // namespace haustra::cad
