#include "phantom/colon_shape.h"

#include "phantom/colon_skeleton.h"
#include "phantom/implicit.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::phantom {
namespace {

/// Radius of the muscle of a collapsed segment, whose lumen is closed.
constexpr double collapsedRadiusMm = 5.5;
/// Sacculations bulge at most this much beyond the mean radius.
constexpr double mostBulge = 1.1;

PathSample between(const PathSample& a, const PathSample& b, double t) {
    PathSample s;
    s.position = glm::mix(a.position, b.position, t);
    s.tangent = glm::mix(a.tangent, b.tangent, t);
    s.normal = glm::mix(a.normal, b.normal, t);
    s.binormal = glm::mix(a.binormal, b.binormal, t);
    s.curvature = glm::mix(a.curvature, b.curvature, t);
    s.radiusMm = glm::mix(a.radiusMm, b.radiusMm, t);
    s.haustration = glm::mix(a.haustration, b.haustration, t);
    return s;
}

}  // namespace

double Growth::distance(glm::dvec3 p) const {
    const glm::dvec3 q = p - center;
    const glm::dvec3 side = glm::cross(inward, tangent);
    const glm::dvec3 local{glm::dot(q, tangent), glm::dot(q, side), glm::dot(q, inward)};
    const double size = std::max({semiAxes.x, semiAxes.y, semiAxes.z});
    const double lumps = 0.07 * size * valueNoise(seed, p, 0.9 * size);
    double d = ellipsoid(local, glm::dvec3(0.0), semiAxes) + lumps;
    if (stalkRadiusMm > 0.0) {
        const double stalk = capsule(p, root, center, stalkRadiusMm);
        d = -smoothMax(-d, -stalk, 1.0);
    }
    return d;
}

double Growth::reachMm() const {
    const double head =
        1.1 * std::max({semiAxes.x, semiAxes.y, semiAxes.z}) + std::max(1.0, footMm);
    return stalkRadiusMm > 0.0 ? std::max(head, glm::distance(root, center) + stalkRadiusMm + 1.0)
                               : head;
}

double Diverticulum::distance(glm::dvec3 p) const {
    // The neck begins inside the lumen, so that no film is left across the mouth.
    const glm::dvec3 within = mouth + (mouth - center) * (1.0 / glm::distance(mouth, center));
    const double neck = capsule(p, within, center, neckRadiusMm);
    return -smoothMax(sacRadiusMm - glm::distance(p, center), -neck, 0.6);
}

double Valve::slit(glm::dvec3 p) const {
    const glm::dvec3 q = p - at;
    const double a = glm::dot(q, along), b = glm::dot(q, glm::cross(inward, along));
    return ellipsoid({a, b, 0.0}, glm::dvec3(0.0), {0.55 * semiAxes.x, 0.5 * slitMm, 1e6});
}

double Valve::lips(glm::dvec3 p) const {
    const glm::dvec3 q = p - at;
    const glm::dvec3 local{glm::dot(q, along), glm::dot(q, glm::cross(inward, along)),
                           glm::dot(q, inward)};
    const double mound = ellipsoid(local, glm::dvec3(0.0), semiAxes);
    // Closed lips meet; only a groove tells where.
    const double groove = open ? slit(p) : std::max(slit(p), 0.7 * semiAxes.z - local.z);
    return smoothMax(mound, -groove, 1.0);
}

ColonShape::ColonShape(ColonPath path, std::uint64_t seed, double septumMm)
    : path_(std::move(path)), roughness_(mixBits(seed + 5)), septumMm_(septumMm) {
    addFolds(seed);
}

void ColonShape::addFolds(std::uint64_t seed) {
    Random random(seed, 2);
    const double length = path_.lengthMm();
    for (double arc = 40.0; arc < length - 12.0;) {
        const PathSample s = path_.at(arc);
        const bool rectum = arc < path_.rectumEndMm;
        // In the transverse colon the three crescents of a ring meet; elsewhere they alternate.
        const bool ring = arc > path_.descendingEndMm && arc < path_.transverseEndMm + 40.0;
        const double spacing = rectum ? random.uniform(28.0, 40.0)
                                      : std::max(14.0, s.radiusMm * random.uniform(0.95, 1.5));
        const double stagger = ring ? 3.0 : spacing * 0.33;
        for (int sector = 0; sector < 3; ++sector) {
            const double at = arc + sector * (ring ? 0.0 : stagger) + random.uniform(-2.5, 2.5);
            const bool present = random.chance(rectum ? 0.4 : 0.85);
            Fold fold;
            fold.arcMm = at;
            const double radius = path_.at(at).radiusMm;
            fold.heightMm = std::clamp(radius * random.uniform(0.28, 0.52), 3.0, 10.0);
            fold.heightMm =
                std::min(fold.heightMm, 0.5 * radius) * smoothstep(0.1, 0.5, s.haustration);
            fold.thicknessMm = random.uniform(2.0, 3.0);
            fold.slantMm = random.uniform(-5.0, 5.0);
            if (present && fold.heightMm > 1.0 && at < length - 10.0)
                folds_[sector].push_back(fold);
        }
        arc += spacing;
    }
    for (int sector = 0; sector < 3; ++sector) {
        auto& folds = folds_[sector];
        std::sort(folds.begin(), folds.end(),
                  [](const Fold& a, const Fold& b) { return a.arcMm < b.arcMm; });
        for (std::size_t n = 0; n < path_.samples.size(); ++n) {
            const double arc = path_.stepMm * double(n);
            foldAfter_[sector].push_back(
                int(std::lower_bound(folds.begin(), folds.end(), arc,
                                     [](const Fold& f, double a) { return f.arcMm < a; }) -
                    folds.begin()));
        }
    }
}

/// Signed distance to the tube's inner surface, from the cylinder coordinates about its axis.
double ColonShape::tube(glm::dvec3 p, const PathSample& s, double arcMm) const {
    const glm::dvec3 v = p - s.position;
    const double x = glm::dot(v, s.normal), y = glm::dot(v, s.binormal);
    const double rho = glm::length(v);
    const double turn = std::atan2(y, x) / (2.0 * std::numbers::pi);
    const double u3 = (turn - std::floor(turn)) * 3.0;
    const int sector = std::min(2, int(u3));
    const double u = u3 - sector;
    const double belly = std::sin(std::numbers::pi * u);  // 0 at the taeniae, 1 midway

    const auto& folds = folds_[sector];
    const std::size_t sample =
        std::min(std::size_t(arcMm / path_.stepMm), path_.samples.size() - 1);
    const int after = foldAfter_[sector][sample];
    const bool hasBefore = after > 0, hasAfter = after < int(folds.size());
    const double before = hasBefore ? folds[after - 1].arcMm : arcMm - 15.0;
    const double beyond = hasAfter ? folds[after].arcMm : arcMm + 15.0;
    const double bag = std::sqrt(std::max(
        0.0,
        std::sin(std::numbers::pi * std::clamp((arcMm - before) / (beyond - before), 0.0, 1.0))));

    const double shape =
        0.90 + 0.07 * belly + 0.13 * belly * bag * std::min(1.0, (beyond - before) / 25.0);
    const double radius = s.radiusMm * glm::mix(1.0, shape, s.haustration);
    double d = rho - radius;

    // Off the axis the sections of a bend lie closer together on its inner side.
    const double stretch = std::clamp(1.0 - glm::dot(v, s.curvature), 0.4, 1.8);
    for (int n = std::max(0, after - 1); n <= after && n < int(folds.size()); ++n) {
        const Fold& fold = folds[n];
        const double height = fold.heightMm * std::pow(belly, 0.8) + 0.03 * s.radiusMm;
        const double along = std::abs(arcMm - fold.arcMm - fold.slantMm * (u - 0.5)) * stretch;
        const double base = std::max(0.0, height - (radius - rho)) / std::max(1.0, height);
        const double half = 0.5 * fold.thicknessMm * (0.85 + 0.5 * (1.0 - std::min(1.0, base)));
        constexpr double round = 0.9;
        const double a = along - half + round, b = (radius - height) - rho + round;
        const double ridge =
            std::hypot(std::max(a, 0.0), std::max(b, 0.0)) + std::min(std::max(a, b), 0.0) - round;
        d = smoothMax(d, -ridge, 2.0);
    }
    return d;
}

void ColonShape::findNearby(glm::dvec3 center, double radiusMm, Nearby& nearby) const {
    nearby.segments.clear();
    nearby.growths.clear();
    nearby.diverticula.clear();
    for (std::size_t n = 0; n + 1 < path_.samples.size(); ++n) {
        const PathSample& s = path_.samples[n];
        // Beyond the nearest tube's reach, a neighbour matters as far as the septum does.
        const double reach =
            mostBulge * std::max(s.radiusMm, collapsedRadiusMm) + wallMm + reachMm + radiusMm + 1.0;
        const glm::dvec3 v = s.position - center;
        if (glm::dot(v, v) < reach * reach) nearby.segments.push_back(int(n));
    }
    for (std::size_t n = 0; n < growths_.size(); ++n) {
        const double reach = growths_[n].reachMm() + radiusMm + 3.0;
        const glm::dvec3 v = growths_[n].center - center;
        if (glm::dot(v, v) < reach * reach) nearby.growths.push_back(int(n));
    }
    for (std::size_t n = 0; n < diverticula_.size(); ++n) {
        const Diverticulum& pouch = diverticula_[n];
        const double reach =
            glm::distance(pouch.mouth, pouch.center) + pouch.sacRadiusMm + reachMm + radiusMm + 3.0;
        const glm::dvec3 v = pouch.center - center;
        if (glm::dot(v, v) < reach * reach) nearby.diverticula.push_back(int(n));
    }
}

ColonPoint ColonShape::evaluate(glm::dvec3 p, const Nearby& nearby) const {
    ColonPoint point;
    const auto& samples = path_.samples;
    // Signed distance to the smooth tube at each nearby segment; the least one owns the point.
    thread_local std::vector<double> depth;
    depth.resize(nearby.segments.size());
    double best = 1e9, bestT = 0.0;
    int bestSegment = -1;
    for (std::size_t n = 0; n < nearby.segments.size(); ++n) {
        const int k = nearby.segments[n];
        const PathSample &a = samples[k], &b = samples[k + 1];
        const glm::dvec3 ab = b.position - a.position, ap = p - a.position;
        const double t = std::clamp(glm::dot(ap, ab) / glm::dot(ab, ab), 0.0, 1.0);
        const double radius = std::max(a.radiusMm + t * (b.radiusMm - a.radiusMm), 2.0);
        const double d = glm::length(ap - t * ab) - radius;
        depth[n] = d;
        if (d < best) best = d, bestT = t, bestSegment = k;
    }
    if (bestSegment < 0) return point;
    const PathSample s = between(samples[bestSegment], samples[bestSegment + 1], bestT);
    point.arcMm = path_.stepMm * (bestSegment + bestT);

    double d = tube(p, s, point.arcMm);
    // Wrinkles of the mucosa.
    if (d > -6.0)
        d += 0.35 * valueNoise(roughness_, p, 6.0) + 0.6 * valueNoise(roughness_ + 1, p, 14.0);
    double outer = d - wallMm;
    if (s.radiusMm < collapsedRadiusMm) {
        outer = std::min(outer, glm::distance(p, s.position) - collapsedRadiusMm);
    }

    double other = 1e9;
    for (std::size_t n = 0; n < nearby.segments.size(); ++n) {
        const int k = nearby.segments[n];
        if (path_.stepMm * std::abs(k - bestSegment) >
            loopSeparationMm(s.radiusMm, samples[k].radiusMm)) {
            other = std::min(other, depth[n]);
        }
    }
    if (other < 1e8) d = smoothMax(d, 0.5 * (septumMm_ - (other - best)), 1.0);

    for (const int n : nearby.diverticula) {
        const double pouch = diverticula_[n].distance(p);
        d = std::min(d, pouch);
        outer = std::min(outer, pouch - Diverticulum::wallMm);
    }
    if (valve_ && glm::distance(p, valve_->at) < valve_->reachMm() + 3.0)
        d = smoothMax(d, -valve_->lips(p), 0.8);
    for (const int n : nearby.growths) {
        const Growth& growth = growths_[n];
        if (growth.kind == Growth::Kind::taggedStool) continue;
        const double g = growth.distance(p);
        if (g < 0.0 && d < 0.8) point.growth = n;
        d = smoothMax(d, -g, growth.stool() ? 0.4 : growth.footMm);
    }
    point.lumenMm = d;
    point.outerMm = outer;
    return point;
}

double ColonShape::smoothTubeMm(glm::dvec3 p, double arcMm, double beyondMm) const {
    double least = 1e9;
    // Spheres 3 mm apart, whose hull is the tube to a tenth of a millimetre.
    for (std::size_t n = 0; n < path_.samples.size(); n += 3) {
        if (std::abs(path_.stepMm * double(n) - arcMm) <= beyondMm) continue;
        const PathSample& s = path_.samples[n];
        least =
            std::min(least, glm::distance(p, s.position) - std::max(s.radiusMm, collapsedRadiusMm));
    }
    return least;
}

ColonPoint ColonShape::evaluate(glm::dvec3 p) const {
    Nearby nearby;
    findNearby(p, 0.1, nearby);
    return evaluate(p, nearby);
}

}  // namespace haustra::phantom
