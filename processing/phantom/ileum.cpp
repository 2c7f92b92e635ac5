#include "phantom/ileum.h"

#include "phantom/implicit.h"
#include "phantom/random.h"
#include "phantom/wall_place.h"

#include <algorithm>
#include <cmath>

namespace haustra::phantom {
namespace {

constexpr double stepMm = 4.0;
/// Loops that touch press on each other by this much.
constexpr double pressMm = 1.5;
constexpr double behindValveMm = 3.0;

/// One walk from the valve.
class Walk {
public:
    Walk(const ColonShape& shape, const BodyPlan& body, const BowelOptions& bowel,
         std::uint64_t seed)
        : shape_(shape), body_(body), bowel_(bowel), seed_(seed), random_(seed, 24) {}

    std::vector<Tube::Node> from(const Valve& valve) {
        glm::dvec3 heading = -valve.inward;
        glm::dvec3 at = valve.at + heading * (behindValveMm + radius(0.0));
        std::vector<Tube::Node> nodes = {{at, radius(0.0)}};
        double hugUntilMm = 40.0, freeUntilMm = 0.0;
        for (double arc = stepMm; arc < bowel_.ileumMm; arc += stepMm) {
            if (arc > hugUntilMm) {
                freeUntilMm = arc + random_.uniform(15.0, 40.0);
                hugUntilMm = freeUntilMm + random_.uniform(60.0, 160.0);
            }
            const double r = radius(arc);
            // The terminal ileum leaves the cecum before it turns back to it.
            const bool hug = arc > freeUntilMm && arc > 30.0;
            const auto next = step(nodes, heading, arc, r, hug);
            if (!next) break;
            heading = glm::normalize(*next - nodes.back().position);
            nodes.push_back({*next, r});
        }
        return nodes;
    }

private:
    double radius(double arcMm) const {
        const double full =
            0.5 * bowel_.ileumCalibreMm * (1.0 + 0.13 * valueNoise(seed_, {arcMm, 0, 0}, 35.0));
        const double r = std::clamp(full, 6.0, 15.0);
        return glm::mix(std::min(r, 5.0), r, smoothstep(0.0, 25.0, arcMm));
    }

    std::optional<glm::dvec3> step(const std::vector<Tube::Node>& nodes, glm::dvec3 heading,
                                   double arcMm, double r, bool hug) {
        const glm::dvec3 from = nodes.back().position;
        std::optional<glm::dvec3> best;
        double least = 40.0;
        for (int n = 0; n < 40; ++n) {
            // No bend tighter than the tube is wide.
            const double most = std::min(0.8, stepMm / (1.15 * r));
            const glm::dvec3 to = glm::normalize(
                heading + most * random_.uniform() * glm::normalize(random_.normal3() + 1e-6));
            const glm::dvec3 p = from + stepMm * to;
            // Look a little ahead, so as not to run into a corner.
            const double cost = costOf(p, nodes, arcMm, r, hug) +
                                0.5 * costOf(p + 2.5 * stepMm * to, nodes, arcMm, r, hug) +
                                1.5 * (1.0 - glm::dot(heading, to));
            if (cost < least) least = cost, best = p;
        }
        return best;
    }

    double costOf(glm::dvec3 p, const std::vector<Tube::Node>& nodes, double arcMm, double r,
                  bool hug) const {
        const auto tooNear = [](double distance, double room) {
            return distance < room ? 2.0 * (room - distance) * (room - distance) : 0.0;
        };
        double cost = tooNear(-body_.cavity(p), r + 3.0) +
                      tooNear(BodyPlan::spineColumn(p), r + 12.0) +
                      tooNear(BodyPlan::iliacWing(p), r + 6.0) + tooNear(p.z, 92.0) +
                      tooNear(292.0 - p.z, 0.0);
        // The first millimetres stand on the colon's wall.
        if (arcMm > 12.0) {
            const double apart = shape_.smoothTubeMm(p) - r;
            const double wanted = shape_.septumMm() - pressMm;
            cost += tooNear(apart, hug ? wanted : 4.0);
            if (hug && apart > wanted) cost += 0.25 * std::min(apart - wanted, 40.0);
        }
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const double between = arcMm - stepMm * double(n);
            if (between < 3.2 * (r + nodes[n].radiusMm)) break;
            cost += 3.0 * tooNear(glm::distance(p, nodes[n].position),
                                  r + nodes[n].radiusMm + 2.0 * Ileum::wallMm);
        }
        return cost;
    }

    const ColonShape& shape_;
    const BodyPlan& body_;
    const BowelOptions& bowel_;
    std::uint64_t seed_;
    Random random_;
};

}  // namespace

Ileum::Ileum(Tube tube, const Valve& valve, double septumMm, std::uint64_t seed)
    : tube_(std::move(tube)), valve_(valve), septumMm_(septumMm), roughness_(mixBits(seed + 91)) {}

double Ileum::bare(glm::dvec3 p) const {
    const double d = tube_.at(p).distanceMm;
    return d < reachMm ? d + 0.4 * valueNoise(roughness_, p, 5.0) : 1e9;
}

double Ileum::lumenMm(glm::dvec3 p, double colonLumenMm) const {
    double d = std::max(bare(p), septumMm_ - colonLumenMm);
    if (valve_.open && glm::distance(p, valve_.at) < 25.0) {
        const double height = valve_.heightMm(p);
        // From the mucosa of the cecum, with which it overlaps a little, into the tube.
        const double behind = behindValveMm + tube_.nodes().front().radiusMm;
        d = std::min(d, std::max({valve_.slit(p), height - 1.0, -behind - height}));
    }
    return d;
}

double Ileum::outerMm(glm::dvec3 p) const {
    return bare(p) - wallMm;
}

std::optional<Ileum> addIleum(ColonShape& shape, std::uint64_t seed, const BodyPlan& body,
                              const BowelOptions& bowel) {
    Random random(seed, 23);
    const ColonPath& path = shape.path();
    std::vector<Tube::Node> longest;
    Valve chosen;
    for (int attempt = 0; attempt < 40; ++attempt) {
        const double arc = path.lengthMm() - random.uniform(50.0, 75.0);
        const PathSample s = path.at(arc);
        // Medially and a little backward, where the mesentery's root is.
        const glm::dvec3 wanted{0.9, 0.35, 0.1};
        const double angle = std::atan2(glm::dot(wanted, s.binormal), glm::dot(wanted, s.normal)) +
                             random.uniform(-0.7, 0.7);
        const auto place = castToWall(shape, arc, angle);
        if (!place) continue;
        Valve valve;
        // The wall's own direction, not that of a fold on it.
        valve.at = place->at;
        valve.inward = glm::normalize(s.position - place->at);
        valve.inward = glm::normalize(valve.inward - glm::dot(valve.inward, s.tangent) * s.tangent);
        valve.along = glm::normalize(glm::cross(valve.inward, s.tangent));
        valve.arcMm = arc;
        valve.open = bowel.valveOpen;
        valve.slitMm = random.uniform(3.5, 6.0);
        valve.semiAxes = {random.uniform(12.0, 15.0), random.uniform(7.5, 9.5),
                          random.uniform(7.0, 10.0)};
        const bool crowded =
            std::any_of(shape.growths().begin(), shape.growths().end(), [&](const Growth& g) {
                return glm::distance(g.center, valve.at) < g.reachMm() + valve.reachMm() + 2.0;
            });
        if (crowded || shape.smoothTubeMm(valve.at - 12.0 * valve.inward, arc, 70.0) < 10.0)
            continue;
        Walk walk(shape, body, bowel, mixBits(seed * 64 + std::uint64_t(attempt)));
        auto nodes = walk.from(valve);
        if (nodes.size() > longest.size()) longest = std::move(nodes), chosen = valve;
        if (stepMm * double(longest.size()) >= 0.98 * bowel.ileumMm) break;
    }
    if (longest.size() < 8) return std::nullopt;
    shape.setValve(chosen);
    // Fluid stands in the lowest tenth or so.
    Random contents(seed, 26 + 100 * std::uint64_t(body.position));
    const glm::dvec3 up = -gravityDirection(body.position);
    std::vector<double> heights;
    for (const Tube::Node& node : longest)
        heights.push_back(glm::dot(up, node.position));
    std::sort(heights.begin(), heights.end());
    const double level =
        heights[std::size_t(contents.uniform(0.05, 0.15) * double(heights.size()))] -
        0.25 * bowel.ileumCalibreMm;
    Ileum ileum(Tube(std::move(longest), Ileum::reachMm + 2.0), chosen, shape.septumMm(), seed);
    ileum.levelMm = level;
    ileum.fluidHu =
        contents.chance(0.5) ? contents.uniform(200.0, 500.0) : contents.uniform(8.0, 30.0);
    return ileum;
}

}  // namespace haustra::phantom
