#include "render/wall/wall_coverage.h"

#include "core/missed_patches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <type_traits>

namespace haustra::render {

namespace {

constexpr float cellMm = 16.0f;

/// A camera's picture, as far as it matters what lies in it.
class Sight {
public:
    Sight(const Camera& camera, glm::ivec2 size)
        : lens_(camera.lens), forward_(glm::normalize(camera.forward)) {
        right_ = glm::normalize(glm::cross(camera.forward, camera.up));
        down_ = glm::cross(glm::dvec3(forward_), glm::dvec3(right_));
        halfFov_ = glm::radians(0.5 * camera.fovDegrees);
        halfHeightMm_ = float(0.5 * camera.heightMm);
        aspect_ = float(size.x) / float(size.y);
        // In the picture's middle, where pixels of a perspective picture span the most.
        pixel_ = lens_ == Lens::orthographic  ? float(camera.heightMm / size.y)
                 : lens_ == Lens::perspective ? float(2.0 * std::tan(halfFov_) / size.y)
                                              : float(2.0 * halfFov_ / size.y);
    }

    bool parallel() const { return lens_ == Lens::orthographic; }
    /// Towards a place that lies `fromEyeMm` from the camera, unit; and how far.
    std::pair<glm::vec3, float> towards(glm::vec3 fromEyeMm) const {
        if (parallel()) return {forward_, glm::dot(fromEyeMm, forward_)};
        const float distance = glm::length(fromEyeMm);
        return {distance > 0.0f ? fromEyeMm / distance : forward_, distance};
    }
    float pixelMm(float distanceMm) const { return parallel() ? pixel_ : pixel_ * distanceMm; }

    bool inPicture(glm::vec3 fromEyeMm) const {
        const float depth = glm::dot(fromEyeMm, forward_);
        const glm::vec2 aside(glm::dot(fromEyeMm, right_), glm::dot(fromEyeMm, down_));
        glm::vec2 halves;  // from the middle, in half heights
        if (parallel()) {
            halves = aside / halfHeightMm_;
        } else if (lens_ == Lens::perspective) {
            if (depth <= 0.0f) return false;
            halves = aside / (depth * float(std::tan(halfFov_)));
        } else {
            const float radius = glm::length(aside);
            const float angle = std::atan2(radius, depth);
            halves = radius > 0.0f ? aside * (angle / float(halfFov_) / radius) : glm::vec2(0.0f);
        }
        return std::abs(halves.x) <= aspect_ && std::abs(halves.y) <= 1.0f;
    }

private:
    Lens lens_;
    glm::vec3 forward_, right_{0.0f}, down_{0.0f};
    double halfFov_ = 0.0;
    float halfHeightMm_ = 0.0f, aspect_ = 1.0f, pixel_ = 0.0f;
};

}  // namespace

WallCoverage::WallCoverage(std::shared_ptr<const WallSight> sight, const SeenLimits& limits)
    : sight_(std::move(sight)),
      limits_(limits),
      enough_(std::uint32_t(std::max(limits.leastMs * 1000, 1))) {
    forget();
}

void WallCoverage::makeCells() {
    const auto& facets = sight_->facets();
    std::map<std::tuple<int, int, int>, std::vector<int>> blocks;
    for (int t = 0; t < int(facets.size()); ++t) {
        if (!(facets[std::size_t(t)].areaMm2 > 0.0f) || sight_->isBridge(t)) continue;
        const glm::ivec3 block(glm::floor(facets[std::size_t(t)].middleMm / cellMm));
        blocks[{block.x, block.y, block.z}].push_back(t);
    }
    cells_.clear();
    for (auto& [block, triangles] : blocks) {
        glm::vec3 low(facets[std::size_t(triangles.front())].middleMm), high = low;
        for (const int t : triangles) {
            low = glm::min(low, facets[std::size_t(t)].middleMm);
            high = glm::max(high, facets[std::size_t(t)].middleMm);
        }
        cells_.push_back(
            {0.5f * (low + high), 0.5f * glm::distance(low, high), std::move(triangles)});
    }
}

void WallCoverage::forget() {
    times_.assign(sight_->facets().size(), 0);
    last_ = {};
    cells_.clear();
    share_.reset();
}

void WallCoverage::add(std::span<const std::uint32_t> times) {
    for (std::size_t t = 0; t < times_.size(); ++t)
        times_[t] += std::min(times[t], enough_ - times_[t]);
    share_.reset();
}

int WallCoverage::show(const ViewState& shown, glm::ivec2 size, std::int64_t microseconds) {
    Picture& last = last_[shown.index()];
    if (last.size != size || last.shown != shown) {
        last = {shown, size, {}};
        if (cells_.empty()) makeCells();
        std::visit(
            [&](const auto& what) {
                if constexpr (requires { collect(what, size, last.triangles); })
                    collect(what, size, last.triangles);
            },
            shown);
    }
    const std::int64_t pixels = std::int64_t(size.x) * size.y;
    if (!std::holds_alternative<Camera>(shown))
        microseconds = microseconds * eyeFieldPixels / std::max(pixels, eyeFieldPixels);
    const auto more = std::uint32_t(std::clamp<std::int64_t>(microseconds, 0, enough_));
    int added = 0;
    for (const int triangle : last.triangles) {
        std::uint32_t& time = times_[std::size_t(triangle)];
        added += more > 0 && time < enough_;
        time += std::min(more, enough_ - time);
    }
    if (added > 0) share_.reset();
    return added;
}

void WallCoverage::collect(const Camera& camera, glm::ivec2 size, std::vector<int>& triangles) {
    const Sight sight(camera, size);
    const auto& facets = sight_->facets();
    const glm::vec3 eye(camera.positionMm - sight_->originMm());
    const float nearest = float(sightLimits.nearestMm), farthest = float(sightLimits.farthestMm),
                leastCosine = float(std::cos(glm::radians(sightLimits.mostAngleDegrees))),
                mostPixelMm = float(1.0 / limits_.pixelsPerMm);
    const auto shows = [&](int triangle) {
        const WallSight::Facet& facet = facets[std::size_t(triangle)];
        const glm::vec3 fromEye = facet.middleMm - eye;
        const auto [direction, distance] = sight.towards(fromEye);
        if (!(distance >= nearest && distance <= farthest) ||
            sight.pixelMm(distance) > mostPixelMm ||
            -glm::dot(direction, facet.inward) < leastCosine || !sight.inPicture(fromEye))
            return false;
        // Parallel rays start in the camera's plane, each before its own place.
        const glm::dvec3 from =
            sight.parallel()
                ? sight_->originMm() + glm::dvec3(facet.middleMm - distance * direction)
                : camera.positionMm;
        return !sight_->hides(from, triangle);
    };
    for (Cell& cell : cells_) {
        const glm::vec3 fromEye = cell.middleMm - eye;
        // Of an orthographic camera the way across counts too, and is bounded by the picture.
        if (!sight.parallel() && glm::length(fromEye) > farthest + cell.radiusMm) continue;
        std::erase_if(cell.unshown, [&](int triangle) {
            if (isShown(triangle)) return true;
            if (shows(triangle)) triangles.push_back(triangle);
            return false;
        });
    }
}

void WallCoverage::collect(const FlatWindow& window, glm::ivec2 size, std::vector<int>& triangles) {
    collectLarge(window.pixelsPerUnit, &window, size, triangles);
}

void WallCoverage::collect(const WholeStrip&, glm::ivec2 size, std::vector<int>& triangles) {
    const StripLayout layout = layOutStrip(sight_->map().height, size);
    collectLarge(layout.columns.front().window.pixelsPerUnit, nullptr, size, triangles);
}

// Within a window, which repeats beyond the seam; null: everywhere.
void WallCoverage::collectLarge(double pixelsPerUnit, const FlatWindow* window, glm::ivec2 size,
                                std::vector<int>& triangles) {
    const glm::dvec2 half = 0.5 * glm::dvec2(size);
    for (Cell& cell : cells_) {
        std::erase_if(cell.unshown, [&](int triangle) {
            if (isShown(triangle)) return true;
            const WallSight::Facet& facet = sight_->facets()[std::size_t(triangle)];
            if (pixelsPerUnit * double(facet.circumferencesPerMm) < limits_.pixelsPerMm)
                return false;
            if (window) {
                glm::dvec2 aside = window->center - glm::dvec2(facet.flat);
                aside.x -= std::round(aside.x);
                aside = glm::abs(aside) * pixelsPerUnit;
                if (aside.x > half.x || aside.y > half.y) return false;
            }
            triangles.push_back(triangle);
            return false;
        });
    }
}

std::vector<std::uint8_t> WallCoverage::shownTriangles() const {
    std::vector<std::uint8_t> shown(times_.size());
    for (std::size_t t = 0; t < times_.size(); ++t)
        shown[t] = isShown(int(t));
    return shown;
}

std::vector<std::uint8_t> WallCoverage::seenTriangles() const {
    return withoutSingles(sight_->neighbours(), shownTriangles(), sight_->bridges());
}

double WallCoverage::share() const {
    if (share_) return *share_;
    const auto seen = seenTriangles();
    double seenMm2 = 0.0, unseenMm2 = 0.0;
    for (std::size_t t = 0; t < seen.size(); ++t)
        if (!sight_->isBridge(int(t)))
            (seen[t] ? seenMm2 : unseenMm2) += double(sight_->facets()[t].areaMm2);
    share_ = unseenMm2 == 0.0 ? 1.0 : seenMm2 / (seenMm2 + unseenMm2);
    return *share_;
}

}  // namespace haustra::render
