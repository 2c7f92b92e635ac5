#include "render/optics/drawn_wall.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {
namespace {

constexpr double gasHu = -1000.0, tissueHu = 40.0;
// tanh of 2 mm by this is 0.98: a scanner's blur of about 1.5 mm at half height.
constexpr double blurMm = 0.9;
constexpr double beginMm = -3.0, untilMm = 1.0, sampleMm = 0.1;
constexpr double clearGasMm = 10.0, mostOfGas = 0.5, leastOfWall = 0.9;
constexpr double leastDiffuse = 0.1, leastBrightness = 0.1, leastHalfDepthMm = 10.0;

/// Colour, and opacity for 1 mm.
glm::dvec4 lookUp(const std::vector<TransferFunctionPoint>& points, double hu) {
    const TransferFunctionPoint point = pointAt(points, hu);
    return {point.color, point.opacity};
}

glm::dvec4 lookUp(const Optics& optics, double hu, double gradientHuPerMm) {
    const TransferFunction& function = optics.transferFunction;
    // Others than emissionAbsorption take no notice of rows.
    if (optics.composition != Composition::emissionAbsorption || function.rows.empty())
        return lookUp(function.points, hu);
    const auto* below = &function.points;
    double belowHuPerMm = 0.0;
    for (const GradientRow& row : function.rows) {
        if (gradientHuPerMm < row.gradientHuPerMm)
            return glm::mix(
                lookUp(*below, hu), lookUp(row.points, hu),
                (gradientHuPerMm - belowHuPerMm) / (row.gradientHuPerMm - belowHuPerMm));
        below = &row.points;
        belowHuPerMm = row.gradientHuPerMm;
    }
    return lookUp(*below, hu);
}

double brightest(glm::dvec3 color) {
    return std::max({color.r, color.g, color.b});
}

}  // namespace

bool drawsWall(const Optics& optics) {
    if (optics.composition == Composition::maximumIntensity || !optics.shading ||
        optics.light.diffuse < leastDiffuse || optics.light.halfDepthMm < leastHalfDepthMm)
        return false;
    const bool firstHit = optics.composition == Composition::firstHit;
    const double ofGas = lookUp(optics, gasHu, 0.0).a;
    if (firstHit ? ofGas >= firstHitOpacity : 1.0 - std::pow(1.0 - ofGas, clearGasMm) > mostOfGas)
        return false;
    glm::dvec3 color(0.0);
    double through = 1.0;
    for (double mm = beginMm + 0.5 * sampleMm; mm < untilMm; mm += sampleMm) {
        const double tanh = std::tanh(mm / blurMm), halfRise = 0.5 * (tissueHu - gasHu);
        const glm::dvec4 here = lookUp(optics, gasHu + halfRise * (1.0 + tanh),
                                       halfRise * (1.0 - tanh * tanh) / blurMm);
        if (firstHit && here.a >= firstHitOpacity)
            return brightest(glm::dvec3(here)) >= leastBrightness;
        const double stopped = firstHit ? 0.0 : 1.0 - std::pow(1.0 - here.a, sampleMm);
        color += through * stopped * glm::dvec3(here);
        through *= 1.0 - stopped;
    }
    return 1.0 - through >= leastOfWall && brightest(color) >= leastBrightness;
}

}  // namespace haustra::render
