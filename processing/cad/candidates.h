// Places of the wall that may be polyps: by their texture (dissertation §6.2.5), and by their shape
// (Yoshida and Näppi, IEEE TMI 2001; 20: 1261).
#pragma once

#include "cad/wall_evidence.h"

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::cad {

/// What finds candidates: colours of the biopsy, or curvatures at either scale.
enum class Generator : std::uint8_t { texture, shape, broadShape };

/// A connected patch of samples without holes, ascending.
struct Patch {
    std::vector<std::uint32_t> samples;
    Generator by = Generator::texture;
};

/// Hysteresis on the wall's shape. A polyp bulges along both principal directions (k2 > 0) up to
/// where its base turns into the wall; the crest of a fold, and the wall itself, bend the other way
/// along the colon's circumference.
struct ShapeLimits {
    double seedCurvature = 0.05;   ///< 1/mm: a patch has a sample that k2 reaches
    double growCurvature = 0.012;  ///< 1/mm: its samples have at least this k2
    double seedShapeIndex = 0.8;   ///< between ridge and cap
    double leastMm2 = 6.0;         ///< smaller patches are noise; a polyp of 4 mm has 15 mm²
    double mostMm2 = 4000.0;       ///< larger ones, holes apart, are no polyps
    /// 1/mm: the lower and the higher limit of a patch's other levels (otherLevels).
    double wideCurvature = 0.006, narrowCurvature = 0.024;
};
/// Of the broad scale: the wall of a distended colon is concave there (k2 about −0.07/mm, one over
/// two thirds of its radius), and what is low and wide only lifts it.
inline constexpr ShapeLimits broadLimits{.seedCurvature = 0.0,
                                         .growCurvature = -0.02,
                                         .seedShapeIndex = 0.0,
                                         .leastMm2 = 15.0,
                                         .wideCurvature = -0.03,
                                         .narrowCurvature = -0.01};
/// By the limits of either scale.
std::vector<Patch> patchesByShape(const WallEvidence& evidence, Generator scale, int threads);

/// Of each patch by shape, the patches that would stand in its place if its limit were lower or
/// higher: the wide one that holds it, where that is not too large, and the narrow ones that it
/// holds, none or several. A level at which it is the same patch is one, too, and so is for each of
/// several patches the wide one that they are together. Where a patch ends hangs on a hair, and
/// with it most of its features; a polyp is one at each level (compare Matas et al., maximally
/// stable extremal regions, BMVC 2002).
std::vector<std::vector<Patch>> otherLevels(const WallEvidence& evidence,
                                            std::span<const Patch* const> patches, int threads);

/// Connected samples whose texture distance is below 1, at least 5 mm wide (§6.2.5): the greatest
/// distance between two of them.
std::vector<Patch> patchesByTexture(const WallEvidence& evidence,
                                    std::span<const float> textureDistance, int threads);

/// Greatest distance between two of the samples, to within a hundredth, and which they are.
struct Diameter {
    double mm = 0.0;
    std::uint32_t from = 0, to = 0;
};
Diameter diameterOf(const WallSamples& wall, std::span<const std::uint32_t> samples);

}  // namespace haustra::cad
