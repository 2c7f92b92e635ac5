#include "cad/wall_lift.h"

#include "cad/wall_quadric.h"
#include "core/quantile.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace haustra::cad {
namespace {

// The wall around: so far from the patch's rim, beyond a lesion's foot and within what is one bend
// of the wall.
constexpr double fromMm = 1.5, toMm = 7.0;
// Beyond this, what is measured is no wall.
constexpr double mostLiftMm = 10.0;

}  // namespace

WallLift liftOf(const WallEvidence& evidence, const Patch& patch, SampleNumbers& numbers) {
    const WallSamples& wall = evidence.samples;
    glm::dvec3 axis(0.0), origin(0.0);
    double area = 0.0;
    for (const std::uint32_t v : patch.samples) {
        const double mm2 = wall.areaMm2[v];
        axis -= mm2 * glm::dvec3(evidence.shapes[v].intoWall);
        origin += mm2 * wall.mesh.vertices[v];
        area += mm2;
    }
    if (area <= 0.0 || glm::length(axis) < 1e-6 * area) return {};
    const std::vector<double> distances = widen(wall, patch.samples, toMm, numbers);
    std::vector<std::uint32_t> around;
    for (auto n = std::uint32_t(patch.samples.size()); n < numbers.count(); ++n)
        if (distances[n] > fromMm) around.push_back(numbers.sample(n));
    const auto quadric = quadricThrough(evidence, around, glm::normalize(axis), origin / area);
    if (!quadric) return {};
    WallLift lift;
    lift.roughMm = quadric->roughMm;
    std::vector<double> above;
    for (const std::uint32_t v : patch.samples) {
        above.push_back(quadric->heightMm(quadric->placeOf(onScanSurface(evidence, v))));
        lift.meanMm += wall.areaMm2[v] * above.back() / area;
    }
    lift.topMm = std::clamp(quantileOf(above, 0.9), -mostLiftMm, mostLiftMm);
    lift.meanMm = std::clamp(lift.meanMm, -mostLiftMm, mostLiftMm);
    return lift;
}

}  // namespace haustra::cad
