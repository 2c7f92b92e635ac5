#include "coverage/path_planning.h"

#include "coverage/corner_path.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <queue>
#include <thread>

namespace haustra::coverage {
namespace {

constexpr int directionsAcross = 6;
constexpr double towardsWall = 0.6, mostBesideMm = 25.0, leastBesideMm = 2.0;

struct Candidate {
    CenterlineCamera camera;
    double arcMm = 0.0;
};

std::vector<Candidate> candidatesAlong(const WallRays& rays, const Centerline& centerline,
                                       double stepMm) {
    std::vector<Candidate> candidates;
    const auto ups = rotationMinimizingUps(centerline, flightPreferredUp);
    const int steps = std::max(1, int(std::ceil(centerline.lengthMm() / stepMm)));
    for (int n = 0; n <= steps; ++n) {
        const double arcMm = centerline.lengthMm() * n / steps;
        const CenterlinePose pose = poseAtArc(centerline, arcMm);
        for (const auto direction : {FlightDirection::antegrade, FlightDirection::retrograde}) {
            const CenterlineCamera flight = cameraAtArc(centerline, ups, arcMm, direction);
            candidates.push_back({flight, arcMm});
            const glm::dvec3 ahead = flight.positionMm + flightLookAheadMm * flight.forward,
                             aside = glm::cross(pose.tangent, flight.up);
            const glm::dvec3 right = glm::length(aside) > 1e-6
                                         ? glm::normalize(aside)
                                         : glm::normalize(glm::cross(flight.forward, flight.up)),
                             up = glm::normalize(glm::cross(right, pose.tangent));
            for (int turn = 0; turn < directionsAcross; ++turn) {
                const double angle = 2.0 * std::numbers::pi * turn / directionsAcross;
                const glm::dvec3 across = std::cos(angle) * right + std::sin(angle) * up;
                const auto met =
                    rays.firstMet(glm::vec3(flight.positionMm - rays.originMm()), glm::vec3(across),
                                  0.0f, float(mostBesideMm / towardsWall));
                const double besideMm =
                    met.triangle < 0 ? mostBesideMm : towardsWall * double(met.distanceMm);
                if (besideMm < leastBesideMm) continue;
                CenterlineCamera beside = flight;
                beside.positionMm += besideMm * across;
                beside.forward = glm::normalize(ahead - beside.positionMm);
                const glm::dvec3 upright =
                    flight.up - glm::dot(flight.up, beside.forward) * beside.forward;
                if (!(glm::length(upright) > 1e-6)) continue;
                beside.up = glm::normalize(upright);
                candidates.push_back({beside, arcMm});
            }
        }
    }
    return candidates;
}

}  // namespace

Result<std::vector<CenterlineCamera>> plannedCameras(const SightTree& tree,
                                                     const CoverageWall& wall,
                                                     const PinholePicture& picture, int count,
                                                     const PlanOptions& options) {
    if (wall.centerline.points.empty()) return fail(ErrorKind::noResult, "the centerline is empty");
    PinholePicture trial = picture;
    trial.side = std::min(trial.side, options.trialSide);
    const Eyepiece eyepiece = Eyepiece::of(trial);
    const auto candidates = candidatesAlong(tree.rays(), wall.centerline, options.stepMm);
    std::vector<std::vector<std::int32_t>> shows(candidates.size());
    std::atomic<std::size_t> done{0};
    std::atomic<bool> cancelled{false};
    const std::thread::id caller = std::this_thread::get_id();
    parallelFor(candidates.size(), 8, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            if (options.cancelled && options.cancelled()) cancelled = true;
            if (cancelled) return;
            shows[n] = trianglesSeen(tree.rays(), eyepiece, candidates[n].camera);
            const std::size_t now = ++done;
            if (options.progress && std::this_thread::get_id() == caller)
                options.progress(double(now) / double(candidates.size()));
        }
    });
    if (cancelled) return fail(ErrorKind::wrongState, "interrupted");

    std::vector<double> areas(wall.mesh.triangles.size());
    for (std::size_t n = 0; n < areas.size(); ++n)
        areas[n] = wall.areaMm2(n);
    std::vector<Visibility> seen(areas.size(), Visibility::unseen);
    const auto gainOf = [&](std::size_t candidate) {
        double gain = 0.0;
        for (const std::int32_t triangle : shows[candidate])
            if (seen[std::size_t(triangle)] == Visibility::unseen)
                gain += areas[std::size_t(triangle)];
        return gain;
    };
    // What a candidate adds only shrinks: one whose gain is up to date and still the greatest is
    // the best (lazy greedy; Minoux 1978).
    struct Offer {
        double gain;
        std::size_t candidate;
        std::size_t chosenThen;
        bool operator<(const Offer& other) const {
            return gain != other.gain ? gain < other.gain : candidate > other.candidate;
        }
    };
    std::priority_queue<Offer> offers;
    for (std::size_t n = 0; n < candidates.size(); ++n)
        offers.push({gainOf(n), n, 0});
    std::vector<Candidate> chosen;
    while (!offers.empty() && chosen.size() < std::size_t(count)) {
        const Offer best = offers.top();
        offers.pop();
        if (best.chosenThen != chosen.size()) {
            offers.push({gainOf(best.candidate), best.candidate, chosen.size()});
            continue;
        }
        if (!(best.gain > 0.0)) break;
        for (const std::int32_t triangle : shows[best.candidate])
            seen[std::size_t(triangle)] = Visibility::partly;
        chosen.push_back(candidates[best.candidate]);
    }

    for (bool gains = true; gains && chosen.size() < std::size_t(count);) {
        gains = false;
        for (const MissedPatch& patch : wall.missed(seen)) {
            if (chosen.size() == std::size_t(count)) break;
            if (options.cancelled && options.cancelled())
                return fail(ErrorKind::wrongState, "interrupted");
            const auto camera = cameraForPatch(tree, wall, patch);
            if (!camera) continue;
            bool shown = false;
            for (const std::int32_t triangle : trianglesSeen(tree.rays(), eyepiece, *camera)) {
                Visibility& known = seen[std::size_t(triangle)];
                shown |= known == Visibility::unseen;
                known = Visibility::partly;
            }
            if (!shown) continue;
            gains = true;
            chosen.push_back({*camera, patch.arcMm});
        }
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const Candidate& a, const Candidate& b) { return a.arcMm < b.arcMm; });
    std::vector<CenterlineCamera> cameras;
    for (const Candidate& candidate : chosen)
        cameras.push_back(candidate.camera);
    return cameras;
}

}  // namespace haustra::coverage
