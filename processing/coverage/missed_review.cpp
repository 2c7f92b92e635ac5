#include "coverage/missed_review.h"

#include <algorithm>
#include <cmath>

namespace haustra::coverage {
namespace {

constexpr int mostRounds = 10, trialSide = 128;
constexpr double tiltDegrees = 40.0, farthestMm = 50.0, besideMm = 15.0;

/// Directions orthogonal to a unit one and to each other.
std::array<glm::dvec3, 2> across(glm::dvec3 direction) {
    const glm::dvec3 axis =
        std::abs(direction.z) < 0.8 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 first = glm::normalize(glm::cross(direction, axis));
    return {first, glm::cross(direction, first)};
}

CenterlineCamera lookingAt(glm::dvec3 from, glm::dvec3 at) {
    const glm::dvec3 forward = glm::normalize(at - from);
    return {from, forward, across(forward)[1]};
}

std::vector<CenterlineCamera> trials(const SightTree& tree, const CoverageWall& wall,
                                     const MissedPatch& patch) {
    std::vector<CenterlineCamera> cameras;
    const WallRays& rays = tree.rays();
    const auto sides = across(patch.inward);
    const double tilt = std::tan(glm::radians(tiltDegrees));
    for (const glm::dvec2 turn : {glm::dvec2(0.0), glm::dvec2(tilt, 0.0), glm::dvec2(-tilt, 0.0),
                                  glm::dvec2(0.0, tilt), glm::dvec2(0.0, -tilt)}) {
        const glm::dvec3 away =
            glm::normalize(patch.inward + turn.x * sides[0] + turn.y * sides[1]);
        constexpr double offMm = 0.05;  // off the wall
        const glm::vec3 start(patch.centerMm + offMm * away - rays.originMm());
        const auto met = rays.firstMet(start, glm::vec3(away), 0.0f, float(farthestMm / 0.9));
        const double freeMm = met.triangle < 0 ? farthestMm / 0.9 : double(met.distanceMm) + offMm;
        for (const double share : {0.5, 0.9})
            if (share * freeMm > offMm)
                cameras.push_back(
                    lookingAt(patch.centerMm + share * freeMm * away, patch.centerMm));
    }
    if (!wall.centerline.points.empty()) {
        for (const double beside : {0.0, -besideMm, besideMm}) {
            const glm::dvec3 from =
                poseAtArc(wall.centerline, patch.arcMm + beside).point.positionMm;
            if (glm::distance(from, patch.centerMm) > 1.0)
                cameras.push_back(lookingAt(from, patch.centerMm));
        }
    }
    return cameras;
}

}  // namespace

std::vector<MissedPatch> CoverageWall::missed(const std::vector<Visibility>& seen) const {
    std::vector<std::uint8_t> observed;
    observed.reserve(seen.size());
    for (const Visibility one : seen)
        observed.push_back(one != Visibility::unseen);
    return missedPatches(mesh, neighbours, observed, bridged, centerline);
}

double CoverageWall::areaMm2(std::size_t triangle) const {
    return triangleAreaMm2(mesh, mesh.triangles[triangle]);
}

std::optional<CenterlineCamera> cameraForPatch(const SightTree& tree, const CoverageWall& wall,
                                               const MissedPatch& patch) {
    PinholePicture picture;
    picture.side = trialSide;
    const Eyepiece eyepiece = Eyepiece::of(picture);
    std::optional<CenterlineCamera> best;
    double mostMm2 = 0.0;
    for (const CenterlineCamera& camera : trials(tree, wall, patch)) {
        double shownMm2 = 0.0;
        auto next = patch.triangles.begin();
        for (const std::int32_t triangle : trianglesSeen(tree.rays(), eyepiece, camera)) {
            next = std::lower_bound(next, patch.triangles.end(), triangle);
            if (next == patch.triangles.end()) break;
            if (*next == triangle) shownMm2 += wall.areaMm2(std::size_t(triangle));
        }
        if (shownMm2 > mostMm2) mostMm2 = shownMm2, best = camera;
    }
    return best;
}

Result<Review> reviewMissed(const SightTree& tree, const CoverageWall& wall,
                            const Eyepiece& eyepiece, double leastMm2,
                            std::vector<Visibility>& seen, const SightOptions& options) {
    Review review;
    double unseenMm2 = std::numeric_limits<double>::infinity();
    SightOptions quiet = options;
    quiet.progress = {};
    for (int round = 0; round < mostRounds; ++round) {
        if (options.progress) options.progress(double(round) / mostRounds);
        std::vector<MissedPatch> patches = wall.missed(seen);
        double nowMm2 = 0.0;
        for (const MissedPatch& patch : patches)
            nowMm2 += patch.areaMm2;
        std::erase_if(patches, [&](const MissedPatch& patch) { return patch.areaMm2 < leastMm2; });
        if (patches.empty() || !(nowMm2 < unseenMm2)) break;
        unseenMm2 = nowMm2;
        std::vector<std::optional<CenterlineCamera>> found(patches.size());
        parallelFor(patches.size(), 1, options.threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n)
                if (!options.cancelled || !options.cancelled())
                    found[n] = cameraForPatch(tree, wall, patches[n]);
        });
        std::vector<CenterlineCamera> cameras;
        for (const auto& camera : found)
            if (camera) cameras.push_back(*camera);
        TRY(look(tree, eyepiece, cameras, seen, quiet));
        review.cameras.insert(review.cameras.end(), cameras.begin(), cameras.end());
        review.patches += int(cameras.size());
        ++review.rounds;
    }
    if (options.progress) options.progress(1.0);
    return review;
}

}  // namespace haustra::coverage
