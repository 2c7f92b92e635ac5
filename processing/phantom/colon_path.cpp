#include "phantom/colon_path.h"

#include "phantom/implicit.h"
#include "phantom/random.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::phantom {
namespace {

using Points = std::vector<glm::dvec3>;

constexpr double kNodeStepMm = 6.0;
constexpr double kWallRoomMm = 0.5;

/// Where the axis passes, and how the place moves in a longer colon.
struct ControlPoint {
    glm::dvec3 at;
    glm::dvec3 longer;
};

constexpr std::array kControl = {
    // rectum
    ControlPoint{{0, 46, 30}, {0, 0, 0}},
    ControlPoint{{0, 44, 52}, {0, 0, 0}},
    ControlPoint{{3, 42, 80}, {0, 0, 0}},
    ControlPoint{{-3, 42, 108}, {0, 0, 0}},
    ControlPoint{{4, 26, 134}, {0, 0, 0}},
    // sigmoid loop
    ControlPoint{{-20, 2, 142}, {-8, 0, 8}},
    ControlPoint{{-44, -22, 128}, {-14, 0, 14}},
    ControlPoint{{-38, -50, 104}, {-12, 0, 10}},
    ControlPoint{{-2, -58, 92}, {0, 0, 6}},
    ControlPoint{{26, -50, 112}, {-4, 0, 50}},
    ControlPoint{{40, -28, 150}, {-14, 4, 44}},
    ControlPoint{{54, -22, 140}, {12, 0, 14}},
    ControlPoint{{68, -24, 132}, {6, 0, -4}},
    ControlPoint{{84, -22, 156}, {0, 0, 0}},
    // descending colon
    ControlPoint{{100, -6, 192}, {0, 0, 0}},
    ControlPoint{{110, 24, 224}, {4, 6, 0}},
    ControlPoint{{108, 38, 255}, {-10, 0, 0}},
    ControlPoint{{112, 36, 288}, {4, 0, 0}},
    ControlPoint{{106, 24, 318}, {0, 0, 6}},
    // splenic flexure, transverse colon
    ControlPoint{{88, 0, 336}, {-6, 0, 12}},
    ControlPoint{{92, -30, 318}, {8, 0, 4}},
    ControlPoint{{86, -52, 290}, {14, -2, -20}},
    ControlPoint{{58, -64, 268}, {4, 0, -34}},
    ControlPoint{{24, -68, 252}, {0, 0, -44}},
    ControlPoint{{-12, -68, 246}, {0, 0, -42}},
    ControlPoint{{-46, -62, 256}, {-2, 0, -34}},
    ControlPoint{{-78, -50, 274}, {-10, 0, -20}},
    // hepatic flexure, ascending colon
    ControlPoint{{-82, -20, 298}, {8, 0, 10}},
    ControlPoint{{-100, 8, 296}, {0, 4, 4}},
    ControlPoint{{-108, 28, 270}, {0, 4, 0}},
    ControlPoint{{-106, 32, 240}, {6, 4, 0}},
    ControlPoint{{-108, 24, 212}, {0, 0, 0}},
    ControlPoint{{-100, 0, 184}, {0, 0, 0}},
    ControlPoint{{-84, -20, 156}, {0, 0, 0}},
    ControlPoint{{-72, -32, 130}, {0, 0, 0}},
};
// Control points at which the sections end, and the widths at some control points between.
constexpr int kRectumEnd = 4, kSigmoidEnd = 13, kDescendingEnd = 19, kTransverseEnd = 27;
constexpr std::array<std::array<double, 2>, 15> kRadius = {{{0, 9},
                                                            {0.7, 15},
                                                            {2, 23},
                                                            {3, 21},
                                                            {4.5, 14},
                                                            {8, 13},
                                                            {12, 13},
                                                            {14, 15.5},
                                                            {17, 17},
                                                            {19, 20},
                                                            {23, 21},
                                                            {27, 22},
                                                            {30, 24},
                                                            {33, 28},
                                                            {34, 27}}};

glm::dvec3 catmullRom(const Points& p, double u) {
    const int last = int(p.size()) - 1;
    const int n = std::clamp(int(std::floor(u)), 0, last - 1);
    const double t = std::clamp(u - n, 0.0, 1.0);
    const glm::dvec3 &b = p[n], &c = p[n + 1];
    const glm::dvec3 a = n > 0 ? p[n - 1] : 2.0 * b - c, d = n + 2 <= last ? p[n + 2] : 2.0 * c - b;
    return 0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * (t * t) +
                  (3.0 * b - a - 3.0 * c + d) * (t * t * t));
}

double lengthOf(const Points& p) {
    double sum = 0.0;
    for (std::size_t n = 1; n < p.size(); ++n)
        sum += glm::distance(p[n - 1], p[n]);
    return sum;
}

/// Points a constant arc apart (about `stepMm`), and each one's place on the input's index axis.
Points resample(const Points& fine, double stepMm, std::vector<double>* place = nullptr) {
    std::vector<double> arc(fine.size(), 0.0);
    for (std::size_t n = 1; n < fine.size(); ++n)
        arc[n] = arc[n - 1] + glm::distance(fine[n - 1], fine[n]);
    const int count = std::max(2, int(std::lround(arc.back() / stepMm)) + 1);
    Points even;
    if (place) place->clear();
    std::size_t n = 1;
    for (int k = 0; k < count; ++k) {
        const double s = arc.back() * k / (count - 1);
        while (n + 1 < fine.size() && arc[n] < s)
            ++n;
        const double t =
            std::clamp((s - arc[n - 1]) / std::max(1e-12, arc[n] - arc[n - 1]), 0.0, 1.0);
        even.push_back(glm::mix(fine[n - 1], fine[n], t));
        if (place) place->push_back(double(n - 1) + t);
    }
    return even;
}

double radiusAtControl(double u) {
    for (std::size_t n = 1; n < kRadius.size(); ++n) {
        if (u <= kRadius[n][0]) {
            const double t = (u - kRadius[n - 1][0]) / (kRadius[n][0] - kRadius[n - 1][0]);
            return glm::mix(kRadius[n - 1][1], kRadius[n][1], t);
        }
    }
    return kRadius.back()[1];
}

/// Moves a point out of a keep-out zone until it is `roomMm` away, by the numerical gradient.
template <class Distance>
glm::dvec3 keepAway(glm::dvec3 p, double roomMm, double share, const Distance& distance) {
    const double d = distance(p);
    if (d >= roomMm) return p;
    constexpr double h = 0.5;
    glm::dvec3 g{distance(p + glm::dvec3(h, 0, 0)) - distance(p - glm::dvec3(h, 0, 0)),
                 distance(p + glm::dvec3(0, h, 0)) - distance(p - glm::dvec3(0, h, 0)),
                 distance(p + glm::dvec3(0, 0, h)) - distance(p - glm::dvec3(0, 0, h))};
    const double size = glm::length(g);
    return size > 1e-6 ? p + g * (share * std::min(roomMm - d, 6.0) / size) : p;
}

struct Skeleton {
    Points nodes;
    std::vector<double> control;  ///< each node's place among the control points
};

/// Pushes on each node by the loops that come too near.
Points loopPushes(const Points& p, const std::vector<double>& radius) {
    Points push(p.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = i + 1; j < p.size(); ++j) {
            const double room = radius[i] + radius[j] + kWallRoomMm;
            const glm::dvec3 apart = p[j] - p[i];
            const double d2 = glm::dot(apart, apart);
            if (d2 >= room * room || d2 < 1e-18) continue;
            if (double(j - i) * kNodeStepMm < loopSeparationMm(radius[i], radius[j])) continue;
            const double d = std::sqrt(d2);
            const glm::dvec3 move = apart * (0.2 * (room - d) / d);
            push[i] -= move, push[j] += move;
        }
    }
    return push;
}

/// Rounds bends that are tighter than the tube is wide, which would fold its wall into itself.
void roundBends(Points& p, const std::vector<double>& radius) {
    const Points old = p;
    const int count = int(p.size());
    for (int n = 2; n + 2 < count; ++n) {
        const glm::dvec3 a = old[n] - old[n - 2], b = old[n + 2] - old[n];
        const double chord = 0.5 * (glm::length(a) + glm::length(b));
        const double turn = glm::length(b - a) / std::max(1e-9, chord);  // about the angle, rad
        const double bendRadius = chord / std::max(1e-9, turn);
        const double wanted = radius[n] + 1.0;
        if (bendRadius < wanted) {
            p[n] += std::min(0.5, 1.0 - bendRadius / wanted) *
                    (0.5 * (old[n - 1] + old[n + 1]) - old[n]);
        }
    }
}

/// Spreads the nodes evenly again.
void respace(Skeleton& path) {
    std::vector<double> place;
    path.nodes = resample(path.nodes, kNodeStepMm, &place);
    std::vector<double> control;
    for (double u : place) {
        const std::size_t n = std::min(std::size_t(u), path.control.size() - 2);
        control.push_back(glm::mix(path.control[n], path.control[n + 1], u - double(n)));
    }
    path.control = control;
}

/// Drives loops, bones and walls apart while keeping the curve smooth.
void relax(Skeleton& path, double scale, const BodyPlan& body) {
    std::vector<double> radius;
    for (int round = 0; round < 180; ++round) {
        if (round % 10 == 0) {
            respace(path);
            radius.clear();
            for (double c : path.control)
                radius.push_back(scale * radiusAtControl(c));
        }
        Points& p = path.nodes;
        const std::size_t count = p.size();
        const Points push = loopPushes(p, radius);
        for (std::size_t n = 2; n < count; ++n) {
            const double size = glm::length(push[n]);
            p[n] += size > 3.0 ? push[n] * (3.0 / size) : push[n];
            p[n] = keepAway(p[n], radius[n] + 5.0, 0.5, BodyPlan::iliacWing);
            p[n] = keepAway(p[n], radius[n] + 4.0, 0.5, BodyPlan::spineColumn);
            p[n] =
                keepAway(p[n], radius[n] + 3.0, 0.5, [&](glm::dvec3 q) { return -body.cavity(q); });
            p[n] = keepAway(p[n], radius[n] + 12.0, 0.5, [](glm::dvec3 q) {
                return 0.8 * (BodyPlan::diaphragmZ(q.x, q.y) - q.z);
            });
        }
        // Taubin's pair of steps smooths without shrinking the loops.
        for (double weight : {0.45, -0.46}) {
            const Points old = p;
            for (std::size_t n = 2; n + 1 < count; ++n) {
                p[n] += weight * (0.5 * (old[n - 1] + old[n + 1]) - old[n]);
            }
        }
        roundBends(p, radius);
    }
    respace(path);
}

/// What makes one patient's path differ from another's of the same length.
struct Variation {
    Points jitter;                           ///< of the control points
    double sigmoid = 1.0, transverse = 1.0;  ///< shares of the extra length
    double scale = 1.0;                      ///< of the radii
    std::uint64_t waves = 0;                 ///< seed of the axis's meanders
};

Variation drawVariation(Random& random) {
    Variation vary;
    for (std::size_t n = 0; n < kControl.size(); ++n) {
        const glm::dvec3 j = 5.0 * random.normal3();
        vary.jitter.push_back(n < 2 ? glm::dvec3(0.0) : j);
    }
    vary.scale = random.uniform(0.98, 1.13);
    vary.sigmoid = random.uniform(0.4, 1.4), vary.transverse = random.uniform(0.4, 1.4);
    vary.waves = random.bits();
    return vary;
}

Skeleton layOut(const Variation& vary, double redundancy, const BodyPlan& body) {
    Points control;
    for (int n = 0; n < int(kControl.size()); ++n) {
        const double share = n <= kSigmoidEnd      ? vary.sigmoid
                             : n <= kTransverseEnd ? vary.transverse
                                                   : 1.0;
        control.push_back(kControl[n].at + redundancy * share * kControl[n].longer +
                          vary.jitter[n]);
    }
    Points fine;
    constexpr int perSpan = 24;
    const int spans = int(control.size()) - 1;
    for (int k = 0; k <= spans * perSpan; ++k) {
        const double u = double(k) / perSpan;
        const double reach =
            (4.0 + 12.0 * redundancy) * smoothstep(4.0, 7.0, u) * (1.0 - smoothstep(31.0, 34.0, u));
        glm::dvec3 wave;
        for (int axis = 0; axis < 3; ++axis)
            wave[axis] = valueNoise(vary.waves + axis, {u, 0.5, 0.5}, 1.3);
        fine.push_back(catmullRom(control, u) + reach * wave);
    }
    Skeleton path;
    path.nodes = resample(fine, kNodeStepMm, &path.control);
    for (double& c : path.control)
        c /= perSpan;
    relax(path, vary.scale, body);
    return path;
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

}  // namespace

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

ColonPath makeColonPath(std::uint64_t seed, Preset preset, const BodyPlan& body) {
    Random random(seed, 1);
    const double targetMm = random.uniform(1270.0, 1620.0);
    const double turns = random.uniform(-0.7, 0.7), phase = random.uniform(0.0, 6.28);
    // Crowded loops may not reach every length; then another variation does.
    Variation vary;
    Skeleton skeleton;
    double error = 1e9;
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
            skeleton = std::move(candidate), vary = other;
        }
    }

    // Fine samples: the nodes' spline, smoothed over about the node distance, 1 mm apart.
    Points fine;
    for (int k = 0; k <= int(skeleton.nodes.size() - 1) * 8; ++k) {
        fine.push_back(catmullRom(skeleton.nodes, k / 8.0));
    }
    std::vector<double> place;
    Points even = resample(fine, 1.0, &place);
    for (int round = 0; round < 60; ++round) {
        const Points old = even;
        for (std::size_t n = 1; n + 1 < even.size(); ++n) {
            even[n] = 0.25 * old[n - 1] + 0.5 * old[n] + 0.25 * old[n + 1];
        }
    }
    even = resample(even, 1.0);

    ColonPath path;
    path.samples.resize(even.size());
    path.stepMm = lengthOf(even) / double(even.size() - 1);
    std::vector<double> control(even.size());
    for (std::size_t n = 0; n < even.size(); ++n) {
        const double u = place[std::min(n, place.size() - 1)] / 8.0;
        const std::size_t k = std::min(std::size_t(u), skeleton.control.size() - 2);
        control[n] =
            glm::mix(skeleton.control[k], skeleton.control[k + 1], std::min(1.0, u - double(k)));
    }
    auto arcOf = [&](double c) {
        return path.stepMm *
               double(std::lower_bound(control.begin(), control.end(), c) - control.begin());
    };
    path.rectumEndMm = arcOf(kRectumEnd), path.sigmoidEndMm = arcOf(kSigmoidEnd);
    path.descendingEndMm = arcOf(kDescendingEnd), path.transverseEndMm = arcOf(kTransverseEnd);

    if (preset == Preset::hard) {
        const double length = random.uniform(28.0, 50.0);
        const bool sigmoid = random.chance(0.5);
        const double from = sigmoid ? path.rectumEndMm + 60.0 : path.sigmoidEndMm + 20.0;
        const double to = sigmoid ? path.sigmoidEndMm - 30.0 : path.descendingEndMm - 60.0;
        path.collapseBeginMm = random.uniform(from, std::max(from, to - length));
        path.collapseEndMm = path.collapseBeginMm + length;
    }

    const std::uint64_t widthNoise = mixBits(seed + 77);
    for (std::size_t n = 0; n < even.size(); ++n) {
        PathSample& s = path.samples[n];
        const double arc = path.stepMm * double(n), left = path.lengthMm() - arc;
        s.position = even[n];
        s.radiusMm = vary.scale * radiusAtControl(control[n]) *
                     (1.0 + 0.09 * valueNoise(widthNoise, {arc, 0, 0}, 70.0));
        // The cecum ends as a ball: the axis runs on to near its pole.
        const double ball = s.radiusMm;
        if (left < ball)
            s.radiusMm = std::max(
                5.0, std::sqrt(std::max(0.0, ball * ball - (ball - left) * (ball - left))));
        s.haustration =
            0.25 + 0.75 * smoothstep(path.rectumEndMm - 20.0, path.sigmoidEndMm + 40.0, arc);
        s.haustration *= smoothstep(0.0, 30.0, arc) * smoothstep(0.0, 25.0, left);
        if (path.collapseEndMm > path.collapseBeginMm) {
            const double outside = std::max(path.collapseBeginMm - arc, arc - path.collapseEndMm);
            s.radiusMm = glm::mix(-3.0, s.radiusMm, smoothstep(-4.0, 18.0, outside));
            s.haustration *= smoothstep(0.0, 25.0, outside);
        }
    }
    addFrames(path, turns, phase);
    return path;
}

}  // namespace haustra::phantom
