#include "cleansing/interface_layer.h"

#include "cleansing/ball.h"
#include "core/normal_distribution.h"

#include <algorithm>
#include <cmath>

namespace haustra::cleansing {
namespace {

constexpr double farthestMm = 2.4;  // from a voxel to the pure material on either side
constexpr double strideMm = 0.3;

double smoothstep(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// HU per mm, smoothed across its direction (Sobel's weights).
glm::dvec3 gradient(const Volume<std::int16_t>& hu, glm::ivec3 v, glm::ivec3 step,
                    glm::dvec3 spacingMm) {
    glm::dvec3 g(0.0);
    for (int c = -1; c <= 1; ++c) {
        for (int b = -1; b <= 1; ++b) {
            for (int a = -1; a <= 1; ++a) {
                const double y = hu.at(v + glm::ivec3(a, b, c) * step);
                g.x += y * a * (2 - std::abs(b)) * (2 - std::abs(c));
                g.y += y * b * (2 - std::abs(a)) * (2 - std::abs(c));
                g.z += y * c * (2 - std::abs(a)) * (2 - std::abs(b));
            }
        }
    }
    return g / (32.0 * spacingMm * glm::dvec3(step));
}

}  // namespace

InterfaceLayer::InterfaceLayer(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                               const LocalMeans& means, const PointSpread& spread,
                               glm::dvec3 gravity)
    : hu_(scan.hu),
      segmentation_(segmentation),
      means_(means),
      spacingMm_(scan.hu.grid().spacingMm()),
      down_(0.0),
      spread_(spread) {
    for (int axis = 0; axis < 3; ++axis) {
        down_[axis] =
            glm::dot(glm::dvec3(scan.hu.grid().patientFromVoxel[axis]), gravity) / spacingMm_[axis];
    }
}

InterfaceLayer::Step InterfaceLayer::stepThrough(glm::ivec3 voxel, double taggedHu,
                                                 double softHu) const {
    const Grid& grid = hu_.grid();
    const glm::ivec3 look = neighbourStep(grid);
    if (!grid.contains(voxel - look) || !grid.contains(voxel + look)) return {};
    const double airHu = means_.airHu.at(voxel.x, voxel.y, voxel.z);
    const double contrast = taggedHu - airHu;
    const double low = airHu + 0.2 * contrast;
    const double high = std::max(airHu + 0.8 * contrast, 0.5 * (softHu + taggedHu));
    const glm::dvec3 g = gradient(hu_, voxel, look, spacingMm_);
    const double gradientMagnitude = glm::length(g);
    if (gradientMagnitude < 0.05 * contrast) return {};
    const glm::dvec3 direction = g / gradientMagnitude;  // per mm
    const glm::dvec3 stride = direction / spacingMm_;
    const double here = hu_.at(voxel);
    auto crossing = [&](double sign, double target) {
        double before = here;
        if (sign * (here - target) >= 0.0) {
            // This voxel is past it already: the crossing lies on the other side.
            for (double at = strideMm; at <= farthestMm; at += strideMm) {
                const double y = trilinear(hu_, glm::dvec3(voxel) - sign * at * stride);
                if (sign * (y - target) < 0.0)
                    return -(at - strideMm + strideMm * (before - target) / (before - y));
                before = y;
            }
            return 1e9;
        }
        for (double at = strideMm; at <= farthestMm; at += strideMm) {
            const double y = trilinear(hu_, glm::dvec3(voxel) + sign * at * stride);
            if (sign * (y - target) >= 0.0)
                return at - strideMm + strideMm * (target - before) / (y - before);
            before = y;
        }
        return 1e9;
    };
    const double up = crossing(1.0, high);
    if (up > farthestMm) return {};
    const double down = crossing(-1.0, low);
    if (down > farthestMm) return {};
    // What lies up there must be the colon's.
    const glm::ivec3 above =
        glm::clamp(glm::ivec3(glm::round(glm::dvec3(voxel) + (up + 0.3) * stride)), glm::ivec3(0),
                   grid.size - 1);
    if (LumenLabel(segmentation_.at(above)) != LumenLabel::tagged) return {};
    Step step;
    step.lengthMm = up + down;
    step.direction = direction;
    step.level = glm::dot(direction, down_) > 0.64;
    step.tagged = above;
    step.unitLength = normalQuantile((high - airHu) / contrast) - normalQuantile(0.2);
    return step;
}

InterfaceLayer::Crossing InterfaceLayer::crossing(glm::ivec3 voxel, double taggedHu,
                                                  double softHu) const {
    const Step step = stepThrough(voxel, taggedHu, softHu);
    if (step.lengthMm < 0.0) return {};
    const double wallMm = step.lengthMm - spread_.drawnMm(step.direction) * step.unitLength;
    return {1.0 - smoothstep(0.35, 0.8, wallMm), step.level, step.tagged};
}

}  // namespace haustra::cleansing
