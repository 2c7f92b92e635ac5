#include "coverage/corner_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <span>
#include <unordered_map>

namespace haustra::coverage {
namespace {

struct Place {
    glm::dvec3 mm{0.0};
    double radiusMm = 0.0;
    bool gap = false;
};

/// Dijkstra's search over voxels with room and the centerline's samples. Nodes are numbered:
/// samples first, then voxels by their index.
class Search {
public:
    Search(const Volume<float>& distance, const std::vector<CenterlinePoint>& samples,
           double clearanceMm)
        : distance_(distance),
          samples_(samples),
          clearanceMm_(clearanceMm),
          sampleReached_(samples.size()),
          voxelCost_(distance.grid(), 0.0),
          voxelStep_(distance.grid(), 0) {
        const Grid& grid = distance.grid();
        const glm::dmat4 toVoxel = grid.voxelFromPatient();
        for (std::size_t n = 0; n < samples.size(); ++n) {
            const glm::ivec3 voxel(
                glm::floor(glm::dvec3(toVoxel * glm::dvec4(samples[n].positionMm, 1.0)) + 0.5));
            const std::size_t index = grid.contains(voxel) ? grid.index(voxel) : none;
            voxelOf_.push_back(index != none && hasRoom(index) ? index : none);
            if (voxelOf_.back() != none) sampleIn_.emplace(index, n);
        }
        for (int n = 0; n < 27; ++n)
            stepMm_[n] = glm::length(glm::dmat3(grid.patientFromVoxel) * glm::dvec3(cornerStep(n)));
    }

    bool sampleHasRoom(std::size_t sample) const { return voxelOf_[sample] != none; }

    /// From one sample to another, of which there is a way along the samples.
    std::vector<Place> path(std::size_t from, std::size_t to) {
        reach(from, 0.0, none);
        while (open_.top().node != to) {
            const Open at = open_.top();
            open_.pop();
            if (at.cost > costOf(at.node)) continue;
            goOn(at.node, at.cost);
        }
        std::vector<Place> places;
        for (std::size_t node = to; node != none; node = before(node))
            places.push_back(placeOf(node));
        std::reverse(places.begin(), places.end());
        return places;
    }

private:
    static constexpr std::size_t none = std::size_t(-1);
    static constexpr std::uint8_t fromSample = 28;  // of voxelStep_; else a cornerStep's number + 1
    struct Open {
        double cost;
        std::size_t node;
        bool operator>(const Open& other) const {
            return cost != other.cost ? cost > other.cost : node > other.node;
        }
    };
    struct Reached {
        double cost = std::numeric_limits<double>::infinity();
        std::size_t before = none;
    };

    bool hasRoom(std::size_t index) const { return double(distance_[index]) >= clearanceMm_; }
    Place placeOf(std::size_t node) const {
        if (node < samples_.size())
            return {samples_[node].positionMm, samples_[node].radiusMm, samples_[node].gap};
        const std::size_t index = node - samples_.size();
        const Grid& grid = distance_.grid();
        return {grid.patientFromVoxelPoint(grid.voxelAt(index)), double(distance_[index]), false};
    }
    double toVoxel(std::size_t sample) const {
        return farFromVoxels * glm::distance(samples_[sample].positionMm,
                                             placeOf(samples_.size() + voxelOf_[sample]).mm);
    }
    double costOf(std::size_t node) const {
        return node < samples_.size() ? sampleReached_[node].cost
                                      : voxelCost_[node - samples_.size()];
    }
    std::size_t before(std::size_t node) const {
        if (node < samples_.size()) return sampleReached_[node].before;
        const std::size_t index = node - samples_.size();
        const std::uint8_t step = voxelStep_[index];
        if (step == fromSample) return sampleIn_.at(index);
        const Grid& grid = distance_.grid();
        return samples_.size() + grid.index(grid.voxelAt(index) - cornerStep(step - 1));
    }
    void reach(std::size_t sample, double cost, std::size_t before) {
        if (!(cost < sampleReached_[sample].cost)) return;
        sampleReached_[sample] = {cost, before};
        open_.push({cost, sample});
    }
    void reachVoxel(std::size_t index, double cost, std::uint8_t step) {
        double& known = voxelCosts_[index];
        std::uint8_t& by = voxelSteps_[index];
        if (by != 0 && !(cost < known)) return;
        known = cost, by = step;
        open_.push({cost, samples_.size() + index});
    }
    void goOn(std::size_t node, double cost) {
        if (node < samples_.size()) {
            const auto along = [&](std::size_t other) {
                reach(other,
                      cost + farFromVoxels * glm::distance(samples_[node].positionMm,
                                                           samples_[other].positionMm),
                      node);
            };
            if (node > 0) along(node - 1);
            if (node + 1 < samples_.size()) along(node + 1);
            if (voxelOf_[node] != none && sampleIn_.at(voxelOf_[node]) == node)
                reachVoxel(voxelOf_[node], cost + toVoxel(node), fromSample);
            return;
        }
        const std::size_t index = node - samples_.size();
        const Grid& grid = distance_.grid();
        const glm::ivec3 voxel = grid.voxelAt(index);
        for (int n = 0; n < 27; ++n) {
            const glm::ivec3 next = voxel + cornerStep(n);
            if (n == 13 || !grid.contains(next)) continue;
            if (const std::size_t other = grid.index(next); hasRoom(other))
                reachVoxel(other, cost + stepMm_[n], std::uint8_t(n + 1));
        }
        if (const auto sample = sampleIn_.find(index); sample != sampleIn_.end())
            reach(sample->second, cost + toVoxel(sample->second), node);
    }

    const Volume<float>& distance_;
    const std::vector<CenterlinePoint>& samples_;
    double clearanceMm_;
    std::vector<std::size_t> voxelOf_;  // of each sample the voxel with room that it lies in
    std::unordered_map<std::size_t, std::size_t> sampleIn_;  // the first that lies in a voxel
    double stepMm_[27];
    std::vector<Reached> sampleReached_;
    Volume<double> voxelCost_;
    Volume<std::uint8_t> voxelStep_;  // 0: not reached
    std::span<double> voxelCosts_ = voxelCost_.writable();
    std::span<std::uint8_t> voxelSteps_ = voxelStep_.writable();
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

Centerline measured(const std::vector<Place>& places) {
    Centerline line;
    double arcMm = 0.0;
    for (const Place& place : places) {
        if (!line.points.empty()) {
            const double step = glm::distance(place.mm, line.points.back().positionMm);
            if (!(step > 1e-6)) continue;
            arcMm += step;
        }
        line.points.push_back({place.mm, arcMm, place.radiusMm, place.gap});
    }
    return line;
}

/// Means over ±smoothingMm of arc, fewer towards the ends, where the wall allows it.
Centerline smoothed(const Centerline& line, const Volume<float>& distance, double clearanceMm) {
    const glm::dmat4 toVoxel = distance.grid().voxelFromPatient();
    std::vector<Place> places;
    for (const CenterlinePoint& point : line.points) {
        const double reach = std::min({smoothingMm, point.arcMm, line.lengthMm() - point.arcMm});
        const auto at = [&](double arcMm) {
            return std::lower_bound(
                line.points.begin(), line.points.end(), arcMm,
                [](const CenterlinePoint& p, double arc) { return p.arcMm < arc; });
        };
        const auto first = at(point.arcMm - reach - 1e-9), end = at(point.arcMm + reach + 1e-9);
        glm::dvec3 mean(0.0);
        for (auto near = first; near != end; ++near)
            mean += near->positionMm / double(end - first);
        const double room = trilinear(distance, glm::dvec3(toVoxel * glm::dvec4(mean, 1.0)));
        if (!point.gap && room >= std::min(clearanceMm, point.radiusMm))
            places.push_back({mean, room, point.gap});
        else
            places.push_back({point.positionMm, point.radiusMm, point.gap});
    }
    return measured(places);
}

template <class CameraAt>
std::vector<CenterlineCamera> evenly(double lengthMm, int count, const CameraAt& cameraAt) {
    std::vector<CenterlineCamera> cameras;
    for (int n = 0; n < count; ++n)
        cameras.push_back(cameraAt(count > 1 ? lengthMm * n / (count - 1) : 0.5 * lengthMm));
    return cameras;
}

}  // namespace

Result<CornerPath> cornerPath(const Volume<float>& distanceMm, const Centerline& centerline,
                              double clearanceMm) {
    const auto& samples = centerline.points;
    if (samples.empty()) return fail(ErrorKind::noResult, "the centerline is empty");
    Search search(distanceMm, samples, clearanceMm);
    std::size_t first = 0, last = samples.size() - 1;
    while (first < samples.size() && !search.sampleHasRoom(first))
        ++first;
    while (last > first && !search.sampleHasRoom(last))
        --last;
    CornerPath found;
    if (first >= last) {
        found.path = centerline;
    } else {
        found.path = smoothed(measured(search.path(first, last)), distanceMm, clearanceMm);
    }
    const auto& points = found.path.points;
    for (std::size_t n = 0; n + 1 < points.size(); ++n)
        if (0.5 * (points[n].radiusMm + points[n + 1].radiusMm) < clearanceMm - 1e-3)
            found.narrowMm += points[n + 1].arcMm - points[n].arcMm;
    return found;
}

std::vector<CenterlineCamera> scopeCameras(const Centerline& path, int count,
                                           FlightDirection direction) {
    const auto ups = rotationMinimizingUps(path, flightPreferredUp);
    return evenly(path.lengthMm(), count, [&](double arcMm) {
        const CenterlinePose pose = poseAtArc(path, arcMm);
        const auto after =
            std::lower_bound(path.points.begin(), path.points.end(), arcMm,
                             [](const CenterlinePoint& p, double arc) { return p.arcMm < arc; });
        const std::size_t sample =
            std::min<std::size_t>(after - path.points.begin(), path.points.size() - 1);
        const glm::dvec3 forward =
            direction == FlightDirection::antegrade ? pose.tangent : -pose.tangent;
        glm::dvec3 up = ups[sample] - glm::dot(ups[sample], forward) * forward;
        if (!(glm::length(up) > 1e-6))
            up = glm::cross(forward, std::abs(forward.x) < 0.8 ? glm::dvec3(1.0, 0.0, 0.0)
                                                               : glm::dvec3(0.0, 1.0, 0.0));
        return CenterlineCamera{pose.point.positionMm, forward, glm::normalize(up)};
    });
}

std::vector<CenterlineCamera> flightCameras(const Centerline& centerline, int count,
                                            FlightDirection direction) {
    const auto ups = rotationMinimizingUps(centerline, flightPreferredUp);
    return evenly(centerline.lengthMm(), count,
                  [&](double arcMm) { return cameraAtArc(centerline, ups, arcMm, direction); });
}

}  // namespace haustra::coverage
