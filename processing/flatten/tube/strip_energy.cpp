#include "flatten/tube/strip_energy.h"

#include "core/parallel.h"
#include "flatten/tube/flat_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::flatten {
namespace {

constexpr std::size_t grain = 4096;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The triangle laid in the plane, its first edge along x.
std::array<glm::dvec2, 3> laidFlat(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::dvec3 along = b - a, other = c - a;
    const double length = glm::length(along);
    if (!(length > 0.0)) return {};
    return {glm::dvec2(0.0), glm::dvec2(length, 0.0),
            glm::dvec2(glm::dot(other, along), glm::length(glm::cross(along, other))) / length};
}

/// cosh l − 1 as a function of c = cosh l, where l is the logarithm of a ratio; from a ratio of ten
/// on it grows as l: the tiny places of blind pouches must not outweigh all others.
struct Growth {
    static constexpr double start = 5.05;            // cosh ln 10
    static constexpr double steepness = 4.95;        // sinh ln 10
    static constexpr double startLog = 2.302585093;  // ln 10
    double value, slope, curve;                      ///< by c

    explicit Growth(double c) : value(c - 1.0), slope(1.0), curve(0.0) {
        if (c <= start) return;
        const double sinh = std::sqrt(c * c - 1.0);
        value = start - 1.0 + steepness * (std::log(c + sinh) - startLog);
        slope = steepness / sinh;
        curve = -slope * c / (sinh * sinh);
    }
};

double coshLog(double ratio) {
    return 0.5 * (ratio + 1.0 / ratio);
}

/// The slopes of one triangle's energy by p = |f_z|² and q = |f_z̄|².
struct Slopes {
    double p, q, pp, pq, qq;
};

Slopes slopesOf(double p, double q, double d, double scale, StripEnergy::Weights weights) {
    const double d2 = d * d, d3 = d2 * d;
    const double byP = -2.0 * q / d2, byQ = 2.0 * p / d2;
    const Growth angle((p + q) / d);
    const double slope = weights.angle * angle.slope, curve = weights.angle * angle.curve;
    Slopes all{slope * byP, slope * byQ, curve * byP * byP + slope * 4.0 * q / d3,
               curve * byP * byQ - slope * 2.0 * (p + q) / d3,
               curve * byQ * byQ + slope * 4.0 * p / d3};

    const Growth area(coshLog(scale * d));
    const double byD = 0.5 * (scale - 1.0 / (scale * d2));
    const double first = weights.area * area.slope * byD;
    const double second = weights.area * (area.curve * byD * byD + area.slope / (scale * d3));
    all.p += first, all.q -= first;
    all.pp += second, all.qq += second, all.pq -= second;
    return all;
}

struct Eigen2 {
    double first, second;  ///< values
    double cosine, sine;   ///< of the first's vector; the second's is (−sine, cosine)
};

Eigen2 eigenOf(double a, double b, double c) {  // [a b; b c]
    const double angle = 0.5 * std::atan2(2.0 * b, a - c);
    const double middle = 0.5 * (a + c), half = std::hypot(0.5 * (a - c), b);
    return {middle + half, middle - half, std::cos(angle), std::sin(angle)};
}

}  // namespace

StripEnergy::StripEnergy(const TriMesh& tube, const PeriodicMap& start, Weights weights,
                         int threads)
    : tube_(tube), turns_(start.turns), weights_(weights), threads_(threads) {
    const std::size_t count = tube.triangles.size();
    references_.resize(count);
    std::vector<std::array<glm::dvec2, 3>> shapes(count);
    double total = 0.0;
    for (std::size_t t = 0; t < count; ++t) {
        const glm::ivec3 v = tube.triangles[t];
        shapes[t] = laidFlat(tube.vertices[std::size_t(v.x)], tube.vertices[std::size_t(v.y)],
                             tube.vertices[std::size_t(v.z)]);
        total += cross(shapes[t][1], shapes[t][2]);
    }
    const double least = 1e-8 * total / double(count);
    double counted = 0.0;
    for (std::size_t t = 0; t < count; ++t) {
        Reference& reference = references_[t];
        reference.doubleArea = cross(shapes[t][1], shapes[t][2]);
        if (!(reference.doubleArea > least)) {
            shapes[t] = corners(t, start.flat);
            const double flatArea = cross(shapes[t][1] - shapes[t][0], shapes[t][2] - shapes[t][0]);
            const double zoom = std::sqrt(least / flatArea);
            for (glm::dvec2& corner : shapes[t])
                corner *= zoom;
            reference.doubleArea = least;
        }
        counted += reference.doubleArea;
        for (std::size_t c = 0; c < 3; ++c) {
            const glm::dvec2 opposite = shapes[t][(c + 2) % 3] - shapes[t][(c + 1) % 3];
            // ½(∂x − i∂y) of the hat function, whose gradient is the opposite edge turned left.
            reference.hat[c] = Complex(-opposite.y, -opposite.x) / (2.0 * reference.doubleArea);
        }
    }
    for (Reference& reference : references_)
        reference.weight = reference.doubleArea / counted;
}

std::array<glm::dvec2, 3> StripEnergy::corners(std::size_t triangle,
                                               const std::vector<glm::dvec2>& flat) const {
    std::array<glm::dvec2, 3> at;
    for (std::size_t c = 0; c < 3; ++c)
        at[c] = flat[std::size_t(tube_.triangles[triangle][int(c)])] +
                glm::dvec2(turns_[triangle][c], 0.0);
    return at;
}

template <class Term>
double StripEnergy::mean(const Term& term) const {
    std::vector<double> chunks((references_.size() + grain - 1) / grain);
    parallelFor(references_.size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t t = begin; t < end; ++t)
            sum += references_[t].weight * term(t);
        chunks[begin / grain] = sum;
    });
    double sum = 0.0;
    for (const double chunk : chunks)
        sum += chunk;
    return sum;
}

double StripEnergy::value(const std::vector<glm::dvec2>& flat) {
    stretch_.resize(references_.size());
    const double angle = mean([&](std::size_t t) {
        const Reference& reference = references_[t];
        const auto [a, b, c] = corners(t, flat);
        const double d = cross(b - a, c - a) / reference.doubleArea;
        stretch_[t] = d;
        if (!(d > 0.0)) return infinity;
        const Complex u(b.x - a.x, b.y - a.y), v(c.x - a.x, c.y - a.y);
        const double q =
            std::norm(u * std::conj(reference.hat[1]) + v * std::conj(reference.hat[2]));
        return Growth(1.0 + 2.0 * q / d).value;
    });
    if (!std::isfinite(angle)) return infinity;
    findScale();
    const double area =
        mean([&](std::size_t t) { return Growth(coshLog(scale_ * stretch_[t])).value; });
    const double energy = weights_.angle * angle + weights_.area * area;
    return std::isfinite(energy) ? energy : infinity;
}

void StripEnergy::findScale() {
    // The slope by the scale's logarithm rises with it; its root is held between `low` and `high`.
    double low = -infinity, high = infinity;
    for (int n = 0; n < 60; ++n) {
        const double slope = mean([&](std::size_t t) {
            const double ratio = scale_ * stretch_[t];
            return std::clamp(0.5 * (ratio - 1.0 / ratio), -Growth::steepness, Growth::steepness);
        });
        const double curve = mean([&](std::size_t t) {
            const double c = coshLog(scale_ * stretch_[t]);
            return c < Growth::start ? c : 0.0;
        });
        scaleCurvature_ = weights_.area * curve;
        if (std::abs(slope) <= 1e-13 * Growth::steepness) return;
        const double at = std::log(scale_);
        (slope > 0.0 ? high : low) = at;
        double next = at + std::clamp(-slope / std::max(curve, 1e-3), -3.0, 3.0);
        if (next <= low || next >= high) next = 0.5 * (low + high);
        if (std::abs(next - at) <= 1e-15 * (1.0 + std::abs(at))) return;
        scale_ = std::exp(next);
    }
}

const std::vector<StripEnergy::Derivatives>& StripEnergy::derivatives(
    const std::vector<glm::dvec2>& flat) {
    derivatives_.resize(references_.size());
    parallelFor(references_.size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const Reference& reference = references_[t];
            const auto [a, b, c] = corners(t, flat);
            const double d = cross(b - a, c - a) / reference.doubleArea;
            const Complex u(b.x - a.x, b.y - a.y), v(c.x - a.x, c.y - a.y);
            const Complex z = u * reference.hat[1] + v * reference.hat[2];
            const Complex w = u * std::conj(reference.hat[1]) + v * std::conj(reference.hat[2]);
            const double q = std::norm(w), p = q + d;
            const double lengthZ = std::sqrt(p), lengthW = std::sqrt(q);
            const Complex alongZ = z / std::abs(z);
            const Complex alongW = lengthW > 0.0 ? w / lengthW : Complex(1.0, 0.0);
            const Slopes slope = slopesOf(p, q, d, scale_, weights_);

            // ∂ of r·Re(conj(e)·f_z) + s·Re(conj(g)·f_z̄) by the corners.
            const auto pulled = [&](double r, Complex e, double s, Complex g) {
                std::array<double, 6> row;
                for (std::size_t k = 0; k < 3; ++k) {
                    const Complex toZ = r * std::conj(e) * reference.hat[k],
                                  toW = s * std::conj(g) * std::conj(reference.hat[k]);
                    row[2 * k] = toZ.real() + toW.real();
                    row[2 * k + 1] = -toZ.imag() - toW.imag();
                }
                return row;
            };
            Derivatives& made = derivatives_[t];
            made.gradient =
                pulled(2.0 * slope.p * lengthZ, alongZ, 2.0 * slope.q * lengthW, alongW);
            const double ratioCosh = coshLog(scale_ * d);
            const double mixed = ratioCosh < Growth::start ? weights_.area * ratioCosh / d : 0.0;
            made.scaleMixed = pulled(2.0 * mixed * lengthZ, alongZ, -2.0 * mixed * lengthW, alongW);

            // The Hessian by (f_z, f_z̄) has its eigenvectors across both, and in the plane of both.
            const Eigen2 plane =
                eigenOf(2.0 * slope.p + 4.0 * slope.pp * p, 4.0 * slope.pq * lengthZ * lengthW,
                        2.0 * slope.q + 4.0 * slope.qq * q);
            const Complex i(0.0, 1.0);
            // A little of a uniform metric keeps the sum definite, also to rounding.
            const double least = std::max({1e-3 * (weights_.angle + weights_.area) / p,
                                           1e-12 * plane.first, 2e-12 * slope.q});
            const std::array<std::array<double, 6>, 4> rows{
                pulled(1.0, i * alongZ, 0.0, alongW), pulled(0.0, alongZ, 1.0, i * alongW),
                pulled(plane.cosine, alongZ, plane.sine, alongW),
                pulled(-plane.sine, alongZ, plane.cosine, alongW)};
            const std::array<double, 4> values{2.0 * slope.p, 2.0 * slope.q, plane.first,
                                               plane.second};
            made.hessian.fill(0.0);
            for (std::size_t k = 0; k < 4; ++k) {
                const double kept = std::max(values[k], least) * reference.weight;
                std::size_t at = 0;
                for (std::size_t row = 0; row < 6; ++row) {
                    for (std::size_t column = 0; column <= row; ++column)
                        made.hessian[at++] += kept * rows[k][row] * rows[k][column];
                }
            }
            for (std::size_t k = 0; k < 6; ++k) {
                made.gradient[k] *= reference.weight;
                made.scaleMixed[k] *= reference.weight;
            }
        }
    });
    return derivatives_;
}

double StripEnergy::firstFlip(const std::vector<glm::dvec2>& flat,
                              const std::vector<glm::dvec2>& step) const {
    std::vector<double> chunks((references_.size() + grain - 1) / grain, infinity);
    parallelFor(references_.size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
        double first = infinity;
        for (std::size_t t = begin; t < end; ++t) {
            const auto [a, b, c] = corners(t, flat);
            const glm::ivec3 v = tube_.triangles[t];
            const glm::dvec2 u = step[std::size_t(v.y)] - step[std::size_t(v.x)],
                             w = step[std::size_t(v.z)] - step[std::size_t(v.x)];
            // Area along the step: k + m·s + n·s².
            const double k = cross(b - a, c - a), m = cross(b - a, w) + cross(u, c - a),
                         n = cross(u, w);
            const double under = m * m - 4.0 * k * n;
            if (under < 0.0) continue;
            // The smaller root that is positive, without cancellation.
            const double half = -0.5 * (m + std::copysign(std::sqrt(under), m));
            for (const double root : {half / n, k / half}) {
                if (root > 0.0) first = std::min(first, root);
            }
        }
        chunks[begin / grain] = first;
    });
    return *std::min_element(chunks.begin(), chunks.end());
}

}  // namespace haustra::flatten
