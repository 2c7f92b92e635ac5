#include "centerline/spline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::centerline {
namespace {

constexpr double smoothingPerRadius = 0.3;           // ℓ over the distance to the boundary
constexpr double shortestMm = 1.5, longestMm = 8.0;  // bounds of ℓ at first
constexpr int samplesPerKnot = 8;
constexpr int relaxations = 12;
// ℓ over the knots' distance at which a spline follows its samples as well as knots let it. Under
// it weights, which go with ℓ⁻⁴, would only drown each other: at 1/1000 of the longest ℓ nothing of
// the rest is left in a double, and the curve swings across walls.
constexpr double leastPerKnot = 1.0 / 16.0;

/// One point of the path, where the spline's parameter is its place in the list.
struct PathSample {
    glm::dvec3 positionMm{0.0};
    double radiusMm = 0.0;
    double smoothingMm = 0.0;
};

/// The polyline through the voxels' centres at equal distances of about `stepMm`.
std::vector<PathSample> samplePath(const std::vector<glm::ivec3>& path,
                                   const Volume<float>& distanceMm, double stepMm) {
    const Grid& grid = distanceMm.grid();
    std::vector<double> arc(path.size(), 0.0);
    for (std::size_t n = 1; n < path.size(); ++n) {
        arc[n] = arc[n - 1] + glm::distance(grid.patientFromVoxelPoint(path[n]),
                                            grid.patientFromVoxelPoint(path[n - 1]));
    }
    const auto intervals = std::max<std::size_t>(1, std::size_t(std::lround(arc.back() / stepMm)));
    std::vector<PathSample> samples(intervals + 1);
    std::size_t n = 0;
    for (std::size_t i = 0; i <= intervals; ++i) {
        const double at = arc.back() * double(i) / double(intervals);
        while (n + 2 < path.size() && arc[n + 1] < at)
            ++n;
        const std::size_t next = std::min(n + 1, path.size() - 1);
        const double t =
            next > n ? std::clamp((at - arc[n]) / (arc[next] - arc[n]), 0.0, 1.0) : 0.0;
        const glm::dvec3 voxel = glm::mix(glm::dvec3(path[n]), glm::dvec3(path[next]), t);
        const double radius =
            glm::mix(double(distanceMm.at(path[n])), double(distanceMm.at(path[next])), t);
        samples[i] = {grid.patientFromVoxelPoint(voxel), radius,
                      std::clamp(smoothingPerRadius * radius, shortestMm, longestMm)};
    }
    return samples;
}

/// The four uniform cubic B-splines that are not zero at fraction t of a knot interval.
std::array<double, 4> basis(double t) {
    const double s = 1.0 - t;
    return {s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
            (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0, t * t * t / 6.0};
}

/// A symmetric positive definite matrix with three bands below its diagonal.
class BandedSystem {
public:
    explicit BandedSystem(std::size_t size) : bands_(size), right_(size, glm::dvec3(0.0)) {}

    void add(std::size_t row, std::size_t column, double value) {
        if (column <= row) bands_[row][row - column] += value;
    }
    void addRight(std::size_t row, glm::dvec3 value) { right_[row] += value; }

    /// Cholesky in place.
    std::vector<glm::dvec3> solve() {
        const std::size_t size = bands_.size();
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t d = std::min<std::size_t>(3, i) + 1; d-- > 0;) {
                const std::size_t j = i - d;
                double sum = bands_[i][d];
                for (std::size_t e = d + 1; e <= std::min<std::size_t>(3, i) && e - d <= 3; ++e) {
                    sum -= bands_[i][e] * bands_[j][e - d];
                }
                bands_[i][d] = d == 0 ? std::sqrt(sum) : sum / bands_[j][0];
            }
            for (std::size_t d = 1; d <= std::min<std::size_t>(3, i); ++d)
                right_[i] -= bands_[i][d] * right_[i - d];
            right_[i] /= bands_[i][0];
        }
        for (std::size_t i = size; i-- > 0;) {
            for (std::size_t d = 1; d <= 3 && i + d < size; ++d)
                right_[i] -= bands_[i + d][d] * right_[i + d];
            right_[i] /= bands_[i][0];
        }
        return std::move(right_);
    }

private:
    std::vector<std::array<double, 4>> bands_;  // [row][row − column]
    std::vector<glm::dvec3> right_;
};

/// The penalised least-squares spline's values at the samples (Eilers and Marx, P-splines, 1996).
std::vector<glm::dvec3> fitSpline(const std::vector<PathSample>& samples, double sampleMm) {
    const std::size_t knots = (samples.size() + samplesPerKnot - 2) / samplesPerKnot;
    const double knotMm = sampleMm * samplesPerKnot;
    BandedSystem system(knots + 3);
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const std::size_t knot = std::min(n / samplesPerKnot, knots - 1);
        const std::array<double, 4> b = basis(double(n) / samplesPerKnot - double(knot));
        const double weight = sampleMm / std::pow(samples[n].smoothingMm, 4);
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j <= i; ++j)
                system.add(knot + i, knot + j, weight * b[i] * b[j]);
            system.addRight(knot + i, weight * b[i] * samples[n].positionMm);
        }
    }
    constexpr std::array<double, 3> difference{1.0, -2.0, 1.0};
    for (std::size_t first = 0; first + 2 < knots + 3; ++first) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                system.add(first + i, first + j,
                           difference[i] * difference[j] / (knotMm * knotMm * knotMm));
            }
        }
    }
    const std::vector<glm::dvec3> controls = system.solve();
    std::vector<glm::dvec3> curve(samples.size());
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const std::size_t knot = std::min(n / samplesPerKnot, knots - 1);
        const std::array<double, 4> b = basis(double(n) / samplesPerKnot - double(knot));
        curve[n] = b[0] * controls[knot] + b[1] * controls[knot + 1] + b[2] * controls[knot + 2] +
                   b[3] * controls[knot + 3];
    }
    return curve;
}

}  // namespace

bool insideLumen(const Volume<std::uint8_t>& labels, glm::dvec3 voxel) {
    const glm::ivec3 nearest(glm::floor(voxel + 0.5));
    return labels.grid().contains(nearest) && labels.at(nearest) != 0;
}

bool staysInside(const Volume<std::uint8_t>& labels, glm::dvec3 a, glm::dvec3 b) {
    glm::ivec3 at(glm::floor(a + 0.5));
    const glm::ivec3 last(glm::floor(b + 0.5));
    const auto isInside = [&](glm::ivec3 v) {
        return labels.grid().contains(v) && labels.at(v) != 0;
    };
    const glm::dvec3 way = b - a;
    // Of the way from 0 to 1: where it next passes a face across each axis.
    const auto faceAhead = [&](int axis) {
        if (at[axis] == last[axis]) return 2.0;
        const double face = double(at[axis]) + (way[axis] > 0.0 ? 0.5 : -0.5);
        return (face - a[axis]) / way[axis];
    };
    while (at != last) {
        if (!isInside(at)) return false;
        int axis = 0;
        for (int n = 1; n < 3; ++n) {
            if (faceAhead(n) < faceAhead(axis)) axis = n;
        }
        at[axis] += way[axis] > 0.0 ? 1 : -1;
    }
    return isInside(at);
}

std::vector<glm::dvec3> smoothInsideLumen(const std::vector<glm::ivec3>& path,
                                          const Volume<std::uint8_t>& labels,
                                          const Volume<float>& distanceMm) {
    const Grid& grid = labels.grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const glm::dvec3 spacing = grid.spacingMm();
    const double sampleMm = 0.25 * std::min({spacing.x, spacing.y, spacing.z});
    std::vector<PathSample> samples = samplePath(path, distanceMm, sampleMm);
    const auto leaves = [&](glm::dvec3 pointMm, double radiusMm) {
        const glm::dvec3 voxel(voxelFromPatient * glm::dvec4(pointMm, 1.0));
        return !insideLumen(labels, voxel) || trilinear(distanceMm, voxel) < 0.5 * radiusMm;
    };

    const double leastMm = leastPerKnot * sampleMm * samplesPerKnot;
    std::vector<glm::dvec3> curve;
    std::vector<bool> relax(samples.size());
    for (int round = 0; round <= relaxations; ++round) {
        curve = fitSpline(samples, sampleMm);
        bool anyLeaves = false;
        std::fill(relax.begin(), relax.end(), false);
        for (std::size_t n = 0; n < samples.size(); ++n) {
            if (!leaves(curve[n], samples[n].radiusMm)) continue;
            anyLeaves = true;
            const std::size_t reach = 2 * samplesPerKnot;
            const std::size_t end = std::min(n + reach + 1, samples.size());
            for (std::size_t near = n > reach ? n - reach : 0; near < end; ++near)
                relax[near] = true;
        }
        if (!anyLeaves) return curve;
        bool anyRelaxed = false;
        for (std::size_t n = 0; n < samples.size(); ++n) {
            if (!relax[n] || samples[n].smoothingMm <= leastMm) continue;
            samples[n].smoothingMm = std::max(0.5 * samples[n].smoothingMm, leastMm);
            anyRelaxed = true;
        }
        if (!anyRelaxed) break;
    }
    // What no spline of this knot spacing follows, the path itself does.
    for (std::size_t n = 0; n < samples.size(); ++n) {
        if (leaves(curve[n], samples[n].radiusMm)) curve[n] = samples[n].positionMm;
    }
    return curve;
}

}  // namespace haustra::centerline
