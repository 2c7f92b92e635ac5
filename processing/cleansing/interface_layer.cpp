#include "cleansing/interface_layer.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr double farthestMm = 2.4;  // from a voxel to the pure material on either side
constexpr double strideMm = 0.3;

/// Quantile of the standard normal distribution, to 5e-4 (Abramowitz and Stegun 26.2.23).
double normalQuantile(double p) {
    const bool upper = p > 0.5;
    const double t = std::sqrt(-2.0 * std::log(std::clamp(upper ? 1.0 - p : p, 1e-9, 0.5)));
    const double x = t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                             (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    return upper ? x : -x;
}

double smoothstep(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// HU per mm, smoothed across its direction (Sobel's weights).
glm::dvec3 gradient(const Volume<std::int16_t>& hu, glm::ivec3 v, glm::dvec3 spacingMm) {
    glm::dvec3 g(0.0);
    for (int c = -1; c <= 1; ++c) {
        for (int b = -1; b <= 1; ++b) {
            for (int a = -1; a <= 1; ++a) {
                const double y = hu.at(v.x + a, v.y + b, v.z + c);
                g.x += y * a * (2 - std::abs(b)) * (2 - std::abs(c));
                g.y += y * b * (2 - std::abs(a)) * (2 - std::abs(c));
                g.z += y * c * (2 - std::abs(a)) * (2 - std::abs(b));
            }
        }
    }
    return g / (32.0 * spacingMm);
}

}  // namespace

InterfaceLayer::InterfaceLayer(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                               const LocalMeans& means, glm::dvec3 gravity, int threads)
    : hu_(scan.hu),
      segmentation_(segmentation),
      means_(means),
      spacingMm_(scan.hu.grid().spacingMm()),
      down_(0.0) {
    for (int axis = 0; axis < 3; ++axis) {
        down_[axis] =
            glm::dot(glm::dvec3(scan.hu.grid().patientFromVoxel[axis]), gravity) / spacingMm_[axis];
    }
    // Most of the ways from labelled air to labelled tagging are bare: their blur is the scanner's.
    constexpr int bins = 200;
    constexpr double binMm = 0.01;
    std::vector<std::uint64_t> histogram(bins, 0);
    std::mutex mutex;
    const Grid& grid = scan.hu.grid();
    parallelFor(std::size_t(grid.size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint64_t> counts(bins, 0);
        for (int k = std::max(1, int(begin)); k < std::min(int(end), grid.size.z - 1); ++k) {
            for (int j = 1; j + 1 < grid.size.y; ++j) {
                for (int i = 1; i + 1 < grid.size.x; ++i) {
                    if (LumenLabel(segmentation.at(i, j, k)) != LumenLabel::tagged) continue;
                    const double tagged = means.taggedHu.at(i, j, k);
                    const double air = means.airHu.at(i, j, k);
                    const double share = (scan.hu.at(i, j, k) - air) / (tagged - air);
                    if (share < 0.3 || share > 0.7) continue;
                    const Step step = stepThrough({i, j, k}, tagged, means.softHu.at(i, j, k));
                    if (step.lengthMm <= 0.0) continue;
                    const double blur = step.lengthMm / step.unitLength;
                    if (blur < bins * binMm) ++counts[std::size_t(blur / binMm)];
                }
            }
        }
        const std::lock_guard lock(mutex);
        for (int b = 0; b < bins; ++b)
            histogram[std::size_t(b)] += counts[std::size_t(b)];
    });
    std::uint64_t total = 0, below = 0;
    for (std::uint64_t count : histogram)
        total += count;
    if (total < 200) return;
    int bin = 0;
    while (bin + 1 < bins && double(below += histogram[std::size_t(bin)]) < 0.4 * double(total))
        ++bin;
    blurMm_ = std::clamp((bin + 0.5) * binMm, 0.3, 1.2);
}

InterfaceLayer::Step InterfaceLayer::stepThrough(glm::ivec3 voxel, double taggedHu,
                                                 double softHu) const {
    const Grid& grid = hu_.grid();
    if (!grid.contains(voxel - 1) || !grid.contains(voxel + 1)) return {};
    const double airHu = means_.airHu.at(voxel.x, voxel.y, voxel.z);
    const double contrast = taggedHu - airHu;
    const double low = airHu + 0.2 * contrast;
    const double high = std::max(airHu + 0.8 * contrast, 0.5 * (softHu + taggedHu));
    const glm::dvec3 g = gradient(hu_, voxel, spacingMm_);
    const double steepness = glm::length(g);
    if (steepness < 0.05 * contrast) return {};
    const glm::dvec3 direction = g / steepness;  // per mm
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
    step.level = glm::dot(direction, down_) > 0.64;
    step.tagged = above;
    step.unitLength = normalQuantile((high - airHu) / contrast) - normalQuantile(0.2);
    return step;
}

InterfaceLayer::Crossing InterfaceLayer::crossing(glm::ivec3 voxel, double taggedHu,
                                                  double softHu) const {
    const Step step = stepThrough(voxel, taggedHu, softHu);
    if (step.lengthMm < 0.0) return {};
    const double wallMm = step.lengthMm - blurMm_ * step.unitLength;
    return {1.0 - smoothstep(0.35, 0.8, wallMm), step.level, step.tagged};
}

}  // namespace haustra::cleansing
