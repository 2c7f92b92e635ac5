#include "phantom/colon_path.h"

#include "phantom/colon_skeleton.h"
#include "phantom/implicit.h"
#include "phantom/polyline.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace haustra::phantom {
namespace {

/// The least radius stands for a closed lumen.
constexpr double closedMm = -3.0;

/// The axis's radius at a distance beyond a closed stretch of a colon that is `radiusMm` wide.
double taper(double radiusMm, double taperMm, double outsideMm) {
    return glm::mix(
        closedMm, radiusMm,
        smoothstep(-4.0 * (taperMm / ColonPath::Collapse{}.taperMm), taperMm, outsideMm));
}

/// How far beyond its stretch of least radius the lumen stays closed; negative where the bulging
/// ends of a wide colon reach into it.
double closedBeyondMm(double radiusMm, double taperMm) {
    double least = 1e9;
    for (double outside = -4.0; outside <= 20.0; outside += 0.25)
        least = std::min(least, outside - taper(radiusMm, taperMm, outside));
    return least;
}

/// Frames carried along without twist (double reflection, Wang et al. 2008), then turned slowly,
/// as the taeniae are.
void addFrames(ColonPath& path, double turnsPerMetre, double phase) {
    auto& s = path.samples;
    const int count = int(s.size());
    for (int n = 0; n < count; ++n) {
        const int a = std::max(0, n - 1), b = std::min(count - 1, n + 1);
        s[n].tangent = glm::normalize(s[b].position - s[a].position);
    }
    for (int n = 0; n < count; ++n) {
        const int a = std::max(0, n - 2), b = std::min(count - 1, n + 2);
        s[n].curvature = (s[b].tangent - s[a].tangent) / (path.stepMm * (b - a));
    }
    glm::dvec3 up = glm::normalize(glm::cross(s[0].tangent, glm::dvec3(1, 0, 0)));
    for (int n = 0; n < count; ++n) {
        if (n > 0) {
            const glm::dvec3 step = s[n].position - s[n - 1].position;
            const double c1 = glm::dot(step, step);
            const glm::dvec3 reflectedUp = up - (2.0 / c1) * glm::dot(step, up) * step;
            const glm::dvec3 reflectedTangent =
                s[n - 1].tangent - (2.0 / c1) * glm::dot(step, s[n - 1].tangent) * step;
            const glm::dvec3 v = s[n].tangent - reflectedTangent;
            const double c2 = glm::dot(v, v);
            up = c2 > 1e-18 ? reflectedUp - (2.0 / c2) * glm::dot(v, reflectedUp) * v : reflectedUp;
        }
        up = glm::normalize(up - glm::dot(up, s[n].tangent) * s[n].tangent);
        const glm::dvec3 side = glm::cross(s[n].tangent, up);
        const double turn = phase +
                            2.0 * 3.14159265358979 * turnsPerMetre * 1e-3 * path.stepMm * n +
                            0.35 * std::sin(0.011 * path.stepMm * n + phase);
        s[n].normal = std::cos(turn) * up + std::sin(turn) * side;
        s[n].binormal = glm::cross(s[n].tangent, s[n].normal);
    }
}

/// Puts each closed stretch somewhere between the rectum and the cecum, clear of the others; those
/// for which there is no room are left out.
std::vector<ColonPath::Collapse> drawCollapses(std::uint64_t seed, const ColonPath& path,
                                               const std::vector<double>& lengthsMm,
                                               const std::function<double(double)>& radiusAt) {
    Random random(seed, 20);
    std::vector<ColonPath::Collapse> collapses;
    for (const double lengthMm : lengthsMm) {
        for (int attempt = 0; attempt < 200; ++attempt) {
            // Spasm and dependence close the left colon more often than the right.
            const double from = path.rectumEndMm + 50.0;
            const double to = random.chance(0.7) ? path.descendingEndMm : path.lengthMm() - 160.0;
            const double begin = random.uniform(from, to - lengthMm);
            const double taperMm = std::clamp(0.6 * lengthMm, 6.0, 18.0);
            const double beyond = closedBeyondMm(radiusAt(begin + 0.5 * lengthMm), taperMm);
            const double core = std::max(0.5, lengthMm - 2.0 * beyond);
            const bool crowded =
                std::any_of(collapses.begin(), collapses.end(), [&](const auto& c) {
                    return begin < c.endMm + 70.0 && c.beginMm < begin + core + 70.0;
                });
            if (crowded) continue;
            collapses.push_back({begin, begin + core, taperMm});
            break;
        }
    }
    std::sort(collapses.begin(), collapses.end(),
              [](const auto& a, const auto& b) { return a.beginMm < b.beginMm; });
    return collapses;
}

/// All of the colon but a few bubbles and, on the right, longer stretches of stool.
std::vector<ColonPath::Collapse> squeeze(std::uint64_t seed, const ColonPath& path) {
    Random random(seed, 21);
    std::vector<ColonPath::Collapse> closed;
    double arc = -20.0;
    while (arc < path.lengthMm()) {
        const bool right = arc > path.transverseEndMm - 60.0;
        const double shut = right ? random.uniform(25.0, 50.0) : random.uniform(70.0, 160.0);
        const double open = right ? random.uniform(80.0, 140.0) : random.uniform(30.0, 60.0);
        closed.push_back({arc, std::min(arc + shut, path.lengthMm()), 18.0});
        arc += shut + open;
    }
    return closed;
}

/// One closed stretch of the sigmoid or of the descending colon.
ColonPath::Collapse drawSpasm(Random& random, const ColonPath& path) {
    const double length = random.uniform(28.0, 50.0);
    const bool sigmoid = random.chance(0.5);
    const double from = sigmoid ? path.rectumEndMm + 60.0 : path.sigmoidEndMm + 20.0;
    const double to = sigmoid ? path.sigmoidEndMm - 30.0 : path.descendingEndMm - 60.0;
    const double begin = random.uniform(from, std::max(from, to - length));
    return {begin, begin + length, 18.0};
}

/// The shape of a colon, laid out in the abdomen.
struct Layout {
    Variation vary;
    Skeleton skeleton;
};

/// A colon as long as `targetMm`, and then `moreSigmoidMm` longer in its sigmoid.
Layout layoutOfLength(Random& random, double targetMm, const BodyPlan& body, double moreSigmoidMm) {
    Layout best;
    // Crowded loops may not reach every length; then another variation does.
    double error = 1e9, drawn = 0.0;
    for (int attempt = 0; attempt < 6 && error > 40.0; ++attempt) {
        const Variation other = drawVariation(random);
        double lo = -0.2, hi = 2.0;
        for (int round = 0; round < 8; ++round) {
            const double redundancy = 0.5 * (lo + hi);
            Skeleton candidate = layOut(other, redundancy, body);
            const double length = lengthOf(candidate.nodes);
            (length < targetMm ? lo : hi) = redundancy;
            if (std::abs(length - targetMm) >= error) continue;
            error = std::abs(length - targetMm);
            best = {other, std::move(candidate)}, drawn = redundancy;
        }
    }
    if (moreSigmoidMm <= 0.0) return best;
    const double wantedMm = lengthOf(best.skeleton.nodes) + moreSigmoidMm;
    double lo = 0.0, hi = 5.0, least = 1e9;
    for (int round = 0; round < 7; ++round) {
        const double extra = 0.5 * (lo + hi);
        Skeleton candidate = layOut(best.vary, drawn, body, extra);
        const double length = lengthOf(candidate.nodes);
        (length < wantedMm ? lo : hi) = extra;
        if (std::abs(length - wantedMm) >= least) continue;
        least = std::abs(length - wantedMm);
        best.skeleton = std::move(candidate);
    }
    return best;
}

/// The nodes' spline, smoothed over about the node distance, 1 mm apart; `place` has where the
/// samples before the smoothing are, in eighths of nodes.
Points evenSamples(const Points& nodes, std::vector<double>& place) {
    Points fine;
    for (int k = 0; k <= int(nodes.size() - 1) * 8; ++k)
        fine.push_back(catmullRom(nodes, k / 8.0));
    Points even = resample(fine, 1.0, &place);
    for (int round = 0; round < 60; ++round) {
        const Points old = even;
        for (std::size_t n = 1; n + 1 < even.size(); ++n)
            even[n] = 0.25 * old[n - 1] + 0.5 * old[n] + 0.25 * old[n + 1];
    }
    return resample(even, 1.0);
}

/// A path that has no width yet.
struct Axis {
    ColonPath path;               ///< samples' positions, step and sections alone
    std::vector<double> control;  ///< of each sample, its place among the control points
};

Axis axisOf(const Skeleton& skeleton) {
    std::vector<double> place;
    const Points even = evenSamples(skeleton.nodes, place);
    Axis axis;
    ColonPath& path = axis.path;
    path.stepMm = lengthOf(even) / double(even.size() - 1);
    for (std::size_t n = 0; n < even.size(); ++n) {
        path.samples.emplace_back().position = even[n];
        const double u = place[std::min(n, place.size() - 1)] / 8.0;
        const std::size_t k = std::min(std::size_t(u), skeleton.control.size() - 2);
        axis.control.push_back(
            glm::mix(skeleton.control[k], skeleton.control[k + 1], std::min(1.0, u - double(k))));
    }
    const auto arcOf = [&](double c) {
        const auto& control = axis.control;
        return path.stepMm *
               double(std::lower_bound(control.begin(), control.end(), c) - control.begin());
    };
    path.rectumEndMm = arcOf(rectumEnd), path.sigmoidEndMm = arcOf(sigmoidEnd);
    path.descendingEndMm = arcOf(descendingEnd), path.transverseEndMm = arcOf(transverseEnd);
    return axis;
}

/// Radius and haustration of sample `n` of a colon that is `radiusMm` wide there.
void setWidth(ColonPath& path, std::size_t n, double radiusMm, bool insufflated) {
    PathSample& s = path.samples[n];
    const double arc = path.stepMm * double(n), left = path.lengthMm() - arc;
    s.radiusMm = radiusMm;
    // The cecum ends as a ball: the axis runs on to near its pole.
    if (left < radiusMm)
        s.radiusMm = std::max(
            5.0,
            std::sqrt(std::max(0.0, radiusMm * radiusMm - (radiusMm - left) * (radiusMm - left))));
    s.haustration =
        0.25 + 0.75 * smoothstep(path.rectumEndMm - 20.0, path.sigmoidEndMm + 40.0, arc);
    s.haustration *= smoothstep(0.0, 30.0, arc) * smoothstep(0.0, 25.0, left);
    if (!insufflated) {
        // What gas and stool hold open is narrower than what a pump does.
        s.radiusMm *= arc < path.transverseEndMm ? 0.62 : 0.75;
        s.haustration *= 0.5;
    }
    for (const ColonPath::Collapse& collapse : path.collapses) {
        const double outside = std::max(collapse.beginMm - arc, arc - collapse.endMm);
        s.radiusMm = taper(s.radiusMm, collapse.taperMm, outside);
        s.haustration *= smoothstep(0.0, 25.0, outside);
    }
}

}  // namespace

bool ColonPath::collapsedWithin(double arcMm, double marginMm) const {
    return std::any_of(collapses.begin(), collapses.end(), [&](const Collapse& c) {
        return arcMm > c.beginMm - marginMm && arcMm < c.endMm + marginMm;
    });
}

PathSample ColonPath::at(double arcMm) const {
    const double u = std::clamp(arcMm / stepMm, 0.0, double(samples.size() - 1));
    const std::size_t n = std::min(std::size_t(u), samples.size() - 2);
    const double t = u - double(n);
    const PathSample &a = samples[n], &b = samples[n + 1];
    PathSample s;
    s.position = glm::mix(a.position, b.position, t);
    s.tangent = glm::normalize(glm::mix(a.tangent, b.tangent, t));
    s.normal = glm::normalize(glm::mix(a.normal, b.normal, t));
    s.binormal = glm::normalize(glm::mix(a.binormal, b.binormal, t));
    s.curvature = glm::mix(a.curvature, b.curvature, t);
    s.radiusMm = glm::mix(a.radiusMm, b.radiusMm, t);
    s.haustration = glm::mix(a.haustration, b.haustration, t);
    return s;
}

ColonPath makeColonPath(std::uint64_t seed, Preset preset, const BodyPlan& body,
                        const BowelOptions& bowel) {
    Random random(seed, 1);
    const double targetMm = random.uniform(1270.0, 1620.0);
    const double turns = random.uniform(-0.7, 0.7), phase = random.uniform(0.0, 6.28);
    const Layout layout = layoutOfLength(random, targetMm, body, bowel.redundantSigmoidMm);
    Axis axis = axisOf(layout.skeleton);
    ColonPath& path = axis.path;
    const auto radiusAt = [&](std::size_t n) {
        return layout.vary.scale * radiusAtControl(axis.control[n]);
    };
    if (!bowel.insufflated) {
        path.collapses = squeeze(seed, path);
    } else if (!bowel.collapsesMm.empty()) {
        path.collapses = drawCollapses(seed, path, bowel.collapsesMm, [&](double arc) {
            return radiusAt(std::min(std::size_t(arc / path.stepMm), axis.control.size() - 1));
        });
    } else if (preset == Preset::hard) {
        path.collapses.push_back(drawSpasm(random, path));
    }
    const std::uint64_t widthNoise = mixBits(seed + 77);
    for (std::size_t n = 0; n < path.samples.size(); ++n) {
        const double arc = path.stepMm * double(n);
        setWidth(path, n, radiusAt(n) * (1.0 + 0.09 * valueNoise(widthNoise, {arc, 0, 0}, 70.0)),
                 bowel.insufflated);
    }
    addFrames(path, turns, phase);
    return path;
}

}  // namespace haustra::phantom
