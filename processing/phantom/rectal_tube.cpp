#include "phantom/rectal_tube.h"

#include "phantom/implicit.h"
#include "phantom/random.h"

#include <algorithm>

namespace haustra::phantom {
namespace {

constexpr double shaftRadiusMm = 4.5, boreRadiusMm = 2.5, balloonWallMm = 0.8;
constexpr double siliconeHu = 160.0, latexHu = 60.0, gasHu = -990.0;

}  // namespace

RectalTube::RectalTube(const ColonPath& path, std::uint64_t seed) {
    Random random(seed, 27);
    const double tipMm = random.uniform(60.0, 90.0), balloonArc = random.uniform(32.0, 45.0);
    std::vector<Tube::Node> nodes;
    const PathSample& anus = path.samples.front();
    for (double below = 40.0; below > 0.0; below -= 4.0)
        nodes.push_back({anus.position - below * anus.tangent, shaftRadiusMm});
    for (double arc = 0.0; arc < std::min(tipMm, path.lengthMm()); arc += 4.0)
        nodes.push_back({path.at(arc).position, shaftRadiusMm});
    lowMm_ = highMm_ = nodes[0].position;
    for (const Tube::Node& node : nodes)
        lowMm_ = glm::min(lowMm_, node.position), highMm_ = glm::max(highMm_, node.position);
    const PathSample middle = path.at(balloonArc);
    balloonAt_ = middle.position, balloonAxis_ = middle.tangent;
    balloonRadiusMm_ = random.uniform(12.5, 17.0),
    balloonHalfLengthMm_ = random.uniform(14.0, 20.0);
    lowMm_ -= 22.0, highMm_ += 22.0;
    shaft_ = Tube(std::move(nodes), 3.0);
}

RectalTube::Point RectalTube::at(glm::dvec3 p, double colonLumenMm) const {
    const double shaft = std::min(shaft_.at(p).distanceMm, 1e9);
    const glm::dvec3 q = p - balloonAt_;
    const double along = glm::dot(q, balloonAxis_);
    const double across = glm::length(q - along * balloonAxis_);
    const double balloon = std::max(ellipsoid({across, along, 0.0}, glm::dvec3(0.0),
                                              {balloonRadiusMm_, balloonHalfLengthMm_, 1e6}),
                                    colonLumenMm + 0.2);
    Point point;
    point.outerMm = std::min(shaft, balloon);
    if (shaft < 0.0) {
        point.hu = shaft < boreRadiusMm - shaftRadiusMm ? gasHu : siliconeHu;
    } else {
        point.hu = shaft < balloon ? siliconeHu : balloon < -balloonWallMm ? gasHu : latexHu;
    }
    return point;
}

Structure::RectalTube RectalTube::structure() const {
    Structure::RectalTube tube{
        {}, shaftRadiusMm, balloonAt_, balloonRadiusMm_, balloonHalfLengthMm_};
    for (const Tube::Node& node : shaft_.nodes())
        tube.axisMm.push_back(node.position);
    return tube;
}

}  // namespace haustra::phantom
