#include "cad/wall_lift.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

namespace haustra::cad {
namespace {

// The wall around, but for what nobody saw or has untagged fluid before it: so far from the patch's
// rim, beyond a lesion's foot and within what is one bend of the wall; and no fold's flank, which
// faces elsewhere.
constexpr double fromMm = 1.5, toMm = 7.0, leastFacing = 0.35;
constexpr std::size_t leastSamples = 30;
// Samples lie on the simplified surface, which is off the scan's by a fraction of a millimetre.
// They are brought back by the first derivative; where the scan is less steep than this, only in
// part.
constexpr double leastGradient = 20.0, farthestOffMm = 1.5;
// What lies off the quadric weighs as in a Cauchy distribution: a fold or another lesion beside the
// patch pulls little. Passes of reweighted least squares; the first weighs all alike.
constexpr int passes = 4;
constexpr double leastScaleMm = 0.1, scalePerRoughness = 1.5;
// Beyond these, what is measured is no wall.
constexpr double mostRoughMm = 3.0, mostLiftMm = 10.0;

// Of a quadric, and of each place: 1, x, y, x², xy, y².
using Terms = Eigen::Matrix<double, 6, 1>;

Terms termsAt(glm::dvec3 place) {
    return {1.0, place.x, place.y, place.x * place.x, place.x * place.y, place.y * place.y};
}

glm::dvec3 onSurface(const WallEvidence& evidence, std::uint32_t v, double surfaceHu) {
    const glm::dvec3 at = evidence.samples.mesh.vertices[v];
    const WallShape& shape = evidence.shapes[v];
    const double mm = (shape.hu - surfaceHu) / std::max(leastGradient, double(shape.gradient));
    return at - std::clamp(mm, -farthestOffMm, farthestOffMm) * glm::dvec3(shape.intoWall);
}

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
    axis = glm::normalize(axis), origin /= area;
    const glm::dvec3 x = glm::normalize(
        glm::cross(axis, std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dmat3 frameFromPatient = glm::transpose(glm::dmat3(x, glm::cross(axis, x), axis));
    const double surfaceHu = 0.5 * (evidence.statistics.wallHu + emptyHu);
    // In the patch's frame: z lumenward.
    const auto placeOf = [&](std::uint32_t v) {
        return frameFromPatient * (onSurface(evidence, v, surfaceHu) - origin);
    };

    const std::vector<double> distances = widen(wall, patch.samples, toMm, numbers);
    std::vector<std::uint32_t> around;
    for (auto n = std::uint32_t(patch.samples.size()); n < numbers.count(); ++n) {
        const std::uint32_t v = numbers.sample(n);
        if (distances[n] > fromMm && !evidence.unseen[v] && !evidence.untagged[v] &&
            -glm::dot(axis, glm::dvec3(evidence.shapes[v].intoWall)) >= leastFacing)
            around.push_back(v);
    }
    if (around.size() < leastSamples) return {};
    const auto count = Eigen::Index(around.size());
    Eigen::Matrix<double, Eigen::Dynamic, 6> terms(count, 6);
    Eigen::ArrayXd z(count), mm2(count);
    for (Eigen::Index n = 0; n < count; ++n) {
        const std::uint32_t v = around[std::size_t(n)];
        const glm::dvec3 place = placeOf(v);
        terms.row(n) = termsAt(place).transpose();
        z[n] = place.z, mm2[n] = wall.areaMm2[v];
    }

    WallLift lift;
    Terms quadric;
    Eigen::ArrayXd weights = mm2;
    for (int pass = 0; pass < passes; ++pass) {
        const Eigen::Matrix<double, Eigen::Dynamic, 6> weighed =
            weights.matrix().asDiagonal() * terms;
        const Eigen::Matrix<double, 6, 6> normal =
            weighed.transpose() * terms + 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
        quadric = normal.ldlt().solve(weighed.transpose() * z.matrix());
        const Eigen::ArrayXd off = z - (terms * quadric).array();
        lift.roughMm = (mm2 * off.abs().min(mostRoughMm)).sum() / mm2.sum();
        const double scaleMm = std::max(leastScaleMm, scalePerRoughness * lift.roughMm);
        weights = mm2 / (1.0 + (off / scaleMm).square());
    }
    std::vector<double> above;
    for (const std::uint32_t v : patch.samples) {
        const glm::dvec3 place = placeOf(v);
        above.push_back(place.z - quadric.dot(termsAt(place)));
        lift.meanMm += wall.areaMm2[v] * above.back() / area;
    }
    const auto top = above.begin() + std::ptrdiff_t(0.9 * double(above.size() - 1));
    std::nth_element(above.begin(), top, above.end());
    lift.topMm = std::clamp(*top, -mostLiftMm, mostLiftMm);
    lift.meanMm = std::clamp(lift.meanMm, -mostLiftMm, mostLiftMm);
    return lift;
}

}  // namespace haustra::cad
