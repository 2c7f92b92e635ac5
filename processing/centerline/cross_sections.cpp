#include "centerline/cross_sections.h"

#include "centerline/spline.h"
#include "core/ct_scan.h"
#include "core/flood_fill.h"
#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::centerline {
namespace {

constexpr double sampleMm = 1.0, courseMm = 6.0, smoothMm = 4.0;
constexpr double reachPerRadius = 2.5, reachMoreMm = 5.0, farthestMm = 40.0;
constexpr int rounds = 2, halvings = 6;

std::vector<glm::dvec3> atSteps(const std::vector<glm::dvec3>& curve) {
    std::vector<double> arc(curve.size(), 0.0);
    for (std::size_t n = 1; n < curve.size(); ++n)
        arc[n] = arc[n - 1] + glm::distance(curve[n], curve[n - 1]);
    const auto steps = std::max<std::size_t>(1, std::size_t(std::lround(arc.back() / sampleMm)));
    std::vector<glm::dvec3> points(steps + 1);
    std::size_t n = 0;
    for (std::size_t i = 0; i <= steps; ++i) {
        const double at = arc.back() * double(i) / double(steps);
        while (n + 2 < curve.size() && arc[n + 1] < at)
            ++n;
        const double between = arc[n + 1] - arc[n];
        const double t = between > 0.0 ? std::clamp((at - arc[n]) / between, 0.0, 1.0) : 0.0;
        points[i] = glm::mix(curve[n], curve[n + 1], t);
    }
    return points;
}

/// Gaussian means along the points; beyond an end the curve goes on as its mirror image through
/// that end, which so stays.
std::vector<glm::dvec3> smoothed(const std::vector<glm::dvec3>& points, double sdMm) {
    const auto count = std::ptrdiff_t(points.size());
    const auto reach = std::min(std::ptrdiff_t(std::ceil(3.0 * sdMm / sampleMm)), count - 1);
    std::vector<glm::dvec3> means(points.size());
    for (std::ptrdiff_t n = 0; n < count; ++n) {
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (std::ptrdiff_t d = -reach; d <= reach; ++d) {
            const std::ptrdiff_t m = n + d;
            const glm::dvec3 p =
                m < 0        ? 2.0 * points.front() - points[std::size_t(-m)]
                : m >= count ? 2.0 * points.back() - points[std::size_t(2 * (count - 1) - m)]
                             : points[std::size_t(m)];
            const double w = std::exp(-0.5 * double(d * d) * sampleMm * sampleMm / (sdMm * sdMm));
            sum += w * p, weights += w;
        }
        means[std::size_t(n)] = sum / weights;
    }
    return means;
}

class CrossSections {
public:
    CrossSections(const Volume<std::uint8_t>& labels, const Volume<float>& distanceMm)
        : labels_(labels),
          distanceMm_(distanceMm),
          voxelFromPatient_(labels.grid().voxelFromPatient()) {}

    glm::dvec3 voxel(glm::dvec3 p) const {
        return glm::dvec3(voxelFromPatient_ * glm::dvec4(p, 1.0));
    }
    double distanceMm(glm::dvec3 p) const {
        const glm::dvec3 v = voxel(p);
        return insideLumen(labels_, v) ? trilinear(distanceMm_, v) : 0.0;
    }
    bool isBridge(glm::dvec3 p) const {
        const glm::ivec3 v(glm::floor(voxel(p) + 0.5));
        return labels_.grid().contains(v) && LumenLabel(labels_.at(v)) == LumenLabel::bridge;
    }

    /// Whether the straight way between two points stays in the lumen.
    bool leads(glm::dvec3 p, glm::dvec3 q) const {
        return staysInside(labels_, voxel(p), voxel(q));
    }

    /// Middle of what the plane through `p` across `along` (unit) cuts; `p` where it cuts nothing.
    glm::dvec3 centroid(glm::dvec3 p, glm::dvec3 along) const {
        const double reachMm = std::min(reachPerRadius * distanceMm(p) + reachMoreMm, farthestMm);
        const int reach = int(reachMm / sampleMm), width = 2 * reach + 1;
        const glm::dvec3 aside =
            std::abs(along.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
        const glm::dvec3 u = glm::normalize(glm::cross(along, aside)), v = glm::cross(along, u);
        const auto place = [&](int a, int b) {
            return voxel(p + sampleMm * (double(a) * u + double(b) * v));
        };
        if (!insideLumen(labels_, place(0, 0))) return p;
        std::vector<char> seen(std::size_t(width) * std::size_t(width), 0);
        std::vector<std::array<int, 2>> front{{0, 0}};
        const auto at = [&](int a, int b) {
            return std::size_t(a + reach) + std::size_t(width) * std::size_t(b + reach);
        };
        seen[at(0, 0)] = 1;
        const auto beside = [](std::array<int, 2> p, const auto& visit) {
            for (const auto& [da, db] :
                 {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}})
                visit(std::array{p[0] + da, p[1] + db}, p);
        };
        floodFill(front, beside, [&](std::array<int, 2> to, std::array<int, 2> from) {
            const auto [c, d] = to;
            if (c * c + d * d > reach * reach || seen[at(c, d)]) return false;
            if (!staysInside(labels_, place(from[0], from[1]), place(c, d))) return false;
            seen[at(c, d)] = 1;
            return true;
        });
        glm::dvec2 sum(0.0);
        for (const auto& [a, b] : front)
            sum += glm::dvec2(a, b);
        sum *= sampleMm / double(front.size());
        return p + sum.x * u + sum.y * v;
    }

private:
    const Volume<std::uint8_t>& labels_;
    const Volume<float>& distanceMm_;
    const glm::dmat4 voxelFromPatient_;
};

}  // namespace

std::vector<glm::dvec3> atCrossSections(const std::vector<glm::dvec3>& curve,
                                        const Volume<std::uint8_t>& labels,
                                        const Volume<float>& distanceMm, int threads) {
    if (curve.size() < 2) return curve;
    const CrossSections sections(labels, distanceMm);
    std::vector<glm::dvec3> points = atSteps(curve);
    for (int round = 0; round < rounds && points.size() > 4; ++round) {
        const std::vector<glm::dvec3> course = smoothed(points, courseMm);
        std::vector<glm::dvec3> moved = points;
        parallelFor(points.size(), 16, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                if (n == 0 || n + 1 == points.size() || sections.isBridge(points[n])) continue;
                const glm::dvec3 along = course[n + 1] - course[n - 1];
                if (glm::length(along) > 0.0)
                    moved[n] = sections.centroid(points[n], glm::normalize(along));
            }
        });
        moved = smoothed(moved, smoothMm);
        for (std::size_t n = 0; n < points.size(); ++n) {
            if (sections.isBridge(points[n])) {
                moved[n] = points[n];
                continue;
            }
            const double leastMm = 0.5 * sections.distanceMm(points[n]);
            for (int h = 0; h <= halvings && (sections.distanceMm(moved[n]) < leastMm ||
                                              !sections.leads(points[n], moved[n]));
                 ++h)
                moved[n] = h < halvings ? glm::mix(moved[n], points[n], 0.5) : points[n];
        }
        points = atSteps(moved);
    }
    return points;
}

}  // namespace haustra::centerline
