#include "cad/wall_quadric.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

namespace haustra::cad {
namespace {

// No fold's flank, which faces elsewhere.
constexpr double leastFacing = 0.35;
constexpr std::size_t leastSamples = 30;
// Samples lie on the simplified surface, which is off the scan's by a fraction of a millimetre.
// They are brought back by the first derivative; where the scan is less steep than this, only in
// part.
constexpr double leastGradient = 20.0, farthestOffMm = 1.5;
// Passes of reweighted least squares; the first weighs all alike.
constexpr int passes = 4;
constexpr double leastScaleMm = 0.1, scalePerRoughness = 1.5;
// Beyond this, what is measured is no wall.
constexpr double mostRoughMm = 3.0;

using Terms = Eigen::Matrix<double, 6, 1>;

Terms termsAt(glm::dvec3 place) {
    return {1.0, place.x, place.y, place.x * place.x, place.x * place.y, place.y * place.y};
}

}  // namespace

double WallQuadric::heightMm(glm::dvec3 place) const {
    return place.z - Eigen::Map<const Terms>(terms).dot(termsAt(place));
}

double WallQuadric::leastBend() const {
    return terms[3] + terms[5] - std::hypot(terms[3] - terms[5], terms[4]);
}

glm::dvec3 onScanSurface(const WallEvidence& evidence, std::uint32_t sample) {
    const double surfaceHu = 0.5 * (evidence.statistics.wallHu + emptyHu);
    const glm::dvec3 at = evidence.samples.mesh.vertices[sample];
    const WallShape& shape = evidence.shapes[sample];
    const double mm = (shape.hu - surfaceHu) / std::max(leastGradient, double(shape.gradient));
    return at - std::clamp(mm, -farthestOffMm, farthestOffMm) * glm::dvec3(shape.intoWall);
}

std::optional<WallQuadric> quadricThrough(const WallEvidence& evidence,
                                          std::span<const std::uint32_t> around, glm::dvec3 axis,
                                          glm::dvec3 originMm) {
    const glm::dvec3 x = glm::normalize(
        glm::cross(axis, std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    WallQuadric quadric;
    quadric.frameFromPatient = glm::transpose(glm::dmat3(x, glm::cross(axis, x), axis));
    quadric.originMm = originMm;
    std::vector<std::uint32_t> seen;
    for (const std::uint32_t v : around) {
        if (!evidence.unseen[v] && !evidence.untagged[v] &&
            -glm::dot(axis, glm::dvec3(evidence.shapes[v].intoWall)) >= leastFacing)
            seen.push_back(v);
    }
    if (seen.size() < leastSamples) return std::nullopt;
    const auto count = Eigen::Index(seen.size());
    Eigen::Matrix<double, Eigen::Dynamic, 6> terms(count, 6);
    Eigen::ArrayXd z(count), mm2(count);
    for (Eigen::Index n = 0; n < count; ++n) {
        const std::uint32_t v = seen[std::size_t(n)];
        const glm::dvec3 place = quadric.placeOf(onScanSurface(evidence, v));
        terms.row(n) = termsAt(place).transpose();
        z[n] = place.z, mm2[n] = evidence.samples.areaMm2[v];
    }
    Eigen::Map<Terms> fitted(quadric.terms);
    Eigen::ArrayXd weights = mm2;
    for (int pass = 0; pass < passes; ++pass) {
        const Eigen::Matrix<double, Eigen::Dynamic, 6> weighed =
            weights.matrix().asDiagonal() * terms;
        const Eigen::Matrix<double, 6, 6> normal =
            weighed.transpose() * terms + 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
        fitted = normal.ldlt().solve(weighed.transpose() * z.matrix());
        const Eigen::ArrayXd off = z - (terms * fitted).array();
        quadric.roughMm = (mm2 * off.abs().min(mostRoughMm)).sum() / mm2.sum();
        const double scaleMm = std::max(leastScaleMm, scalePerRoughness * quadric.roughMm);
        weights = mm2 / (1.0 + (off / scaleMm).square());
    }
    return quadric;
}

}  // namespace haustra::cad
