#include "phantom/colon_skeleton.h"

#include "phantom/implicit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::phantom {
namespace {

constexpr double nodeStepMm = 6.0;
constexpr double wallRoomMm = 0.5;

/// Where the axis passes, and how the place moves in a longer colon.
struct ControlPoint {
    glm::dvec3 at;
    glm::dvec3 longer;
};

constexpr std::array controlPoints = {
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

// Control point and radius, mm; linear between.
constexpr std::array<std::array<double, 2>, 15> radiusAlong = {{{0, 9},
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

/// Pushes on each node by the loops that come too near.
Points loopPushes(const Points& p, const std::vector<double>& radius) {
    Points push(p.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = i + 1; j < p.size(); ++j) {
            const double room = radius[i] + radius[j] + wallRoomMm;
            const glm::dvec3 apart = p[j] - p[i];
            const double d2 = glm::dot(apart, apart);
            if (d2 >= room * room || d2 < 1e-18) continue;
            if (double(j - i) * nodeStepMm < loopSeparationMm(radius[i], radius[j])) continue;
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
    path.nodes = resample(path.nodes, nodeStepMm, &place);
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

}  // namespace

double radiusAtControl(double control) {
    for (std::size_t n = 1; n < radiusAlong.size(); ++n) {
        if (control <= radiusAlong[n][0]) {
            const double t =
                (control - radiusAlong[n - 1][0]) / (radiusAlong[n][0] - radiusAlong[n - 1][0]);
            return glm::mix(radiusAlong[n - 1][1], radiusAlong[n][1], t);
        }
    }
    return radiusAlong.back()[1];
}

Variation drawVariation(Random& random) {
    Variation vary;
    for (std::size_t n = 0; n < controlPoints.size(); ++n) {
        const glm::dvec3 j = 5.0 * random.normal3();
        vary.jitter.push_back(n < 2 ? glm::dvec3(0.0) : j);
    }
    vary.scale = random.uniform(0.98, 1.13);
    vary.sigmoid = random.uniform(0.4, 1.4), vary.transverse = random.uniform(0.4, 1.4);
    vary.waves = random.bits();
    return vary;
}

Skeleton layOut(const Variation& vary, double redundancy, const BodyPlan& body, double sigmoid) {
    Points control;
    for (int n = 0; n < int(controlPoints.size()); ++n) {
        const double share = n <= sigmoidEnd      ? vary.sigmoid
                             : n <= transverseEnd ? vary.transverse
                                                  : 1.0;
        control.push_back(controlPoints[n].at + redundancy * share * controlPoints[n].longer +
                          vary.jitter[n]);
        if (n <= sigmoidEnd) control.back() += sigmoid * controlPoints[n].longer;
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
    path.nodes = resample(fine, nodeStepMm, &path.control);
    for (double& c : path.control)
        c /= perSpan;
    relax(path, vary.scale, body);
    return path;
}

}  // namespace haustra::phantom
