// What the voxels of an abdominal CT are made of.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace haustra {

/// Tissue classes told apart by HU. Bone and tagged material overlap and are one class.
enum class Tissue : std::uint8_t { air = 0, fat = 1, soft = 2, taggedOrBone = 3 };
inline constexpr int tissueCount = 4;

/// From the first HU up to, and with, the last.
struct HuRange {
    int fromHu = 0, toHu = 0;
    bool operator==(const HuRange&) const = default;
};

/// Where the mean of each class can lie, ordered as Tissue: a fit starts from the scan's mode in
/// there and does not leave it, so that classes are not swapped. What any calibrated scanner gives
/// of an abdomen, unless something else is known. Within −1024…3071.
struct TissuePriors {
    std::array<HuRange, tissueCount> meanHu{{{-1024, -850}, {-160, -40}, {-10, 110}, {180, 1600}}};
    bool operator==(const TissuePriors&) const = default;
};

/// A Gaussian mixture over HU: class means, standard deviations and weights, ordered as Tissue.
struct TissueModel {
    std::array<double, tissueCount> meanHu{};
    std::array<double, tissueCount> sdHu{};
    std::array<double, tissueCount> weight{};
    /// HU where air ends (midway between air and soft tissue, where the half-filled voxel lies),
    /// and where tagged material or bone begins (likewise midway from soft tissue).
    double airBelowHu = 0.0;
    double taggedAboveHu = 0.0;
};

/// How much of a voxel is air and how much tagged material or bone, in 255ths; the rest is soft
/// tissue and fat. air + tagged ≤ 255. One voxel of the `mixture` product (dissertation §3.2).
struct TissueFractions {
    std::uint8_t air = 0;
    std::uint8_t tagged = 0;
    std::uint8_t soft() const { return std::uint8_t(255 - air - tagged); }
    bool operator==(const TissueFractions&) const = default;
};
/// Shares of air and tagged material, clamped to 0…1 and rounded; soft tissue has the rest.
inline TissueFractions roundedFractions(double air, double tagged) {
    const int a = int(std::lround(255.0 * std::clamp(air, 0.0, 1.0)));
    const int t = int(std::lround(255.0 * std::clamp(tagged, 0.0, 1.0)));
    return {std::uint8_t(a), std::uint8_t(std::min(t, 255 - a))};
}
static_assert(sizeof(TissueFractions) == 2, "a volume of them is mapped from a file");

}  // namespace haustra
