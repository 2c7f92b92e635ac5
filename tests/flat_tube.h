// A straight tube with ring folds whose conformal map is known: scan, flat map, centerline.
#pragma once

#include "core/centerline.h"
#include "core/flat_map.h"
#include "core/volume.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::tests {

/// What a tube looks like. Its axis is the patient's z; the rectum is at z = 0.
struct FlatTubeShape {
    double lengthMm = 60.0;
    double radiusMm = 12.0;
    double foldMm = 3.0;  ///< the folds' height is twice this
    double foldPeriodMm = 15.0;
    /// How far the folds' crests lean towards +z. Over about 0.32·foldPeriodMm they overhang: then
    /// a place behind a fold cannot be seen from the axis across from it.
    double leanMm = 0.0;
};

/// The surface of revolution of a fold-shaped curve. It maps conformally onto the strip by
/// x = angle / 2π and dy = ds / (2π r) along the curve.
class FlatTube {
public:
    explicit FlatTube(const FlatTubeShape& shape = {}) : shape_(shape) {
        const double dt = shape_.lengthMm / steps;
        flatY_.resize(steps + 1, 0.0);
        // Simpson's rule on each interval.
        for (int n = 0; n < steps; ++n)
            flatY_[n + 1] = flatY_[n] + dt / 6.0 *
                                            (flatSlope(n * dt) + 4.0 * flatSlope((n + 0.5) * dt) +
                                             flatSlope((n + 1) * dt));
    }

    const FlatTubeShape& shape() const { return shape_; }
    /// Of the strip, in circumferences.
    double height() const { return flatY_.back(); }

    /// The wall's place at a flat coordinate; y is clamped to the strip.
    glm::dvec3 positionMm(glm::dvec2 flat) const {
        const glm::dvec2 at = profile(parameterAt(flat.y));
        const double angle = 2.0 * std::numbers::pi * flat.x;
        return {at.x * std::cos(angle), at.x * std::sin(angle), at.y};
    }
    /// Unit, from the wall into the lumen.
    glm::dvec3 inwardNormal(glm::dvec2 flat) const {
        const glm::dvec2 along = profileSlope(parameterAt(flat.y));
        const glm::dvec2 inward = glm::normalize(glm::dvec2(-along.y, along.x));
        const double angle = 2.0 * std::numbers::pi * flat.x;
        return {inward.x * std::cos(angle), inward.x * std::sin(angle), inward.y};
    }

    /// `cells.x` triangle pairs around and `cells.y` along, vertices exact, the seam at angle 0.
    /// Cameras stand on the axis `cameraSpacingMm` apart; each vertex has the nearest.
    FlatMap map(glm::ivec2 cells = {72, 120}, double cameraSpacingMm = 1.0) const {
        FlatMap map;
        map.height = height();
        const int cameras = int(std::lround(shape_.lengthMm / cameraSpacingMm)) + 1;
        for (int n = 0; n < cameras; ++n) {
            const double z = shape_.lengthMm * n / (cameras - 1);
            map.cameras.push_back({{0.0, 0.0, z}, z});
        }
        for (int j = 0; j <= cells.y; ++j) {
            for (int i = 0; i <= cells.x; ++i) {
                const glm::dvec2 flat(double(i) / cells.x, height() * j / cells.y);
                map.flat.push_back(flat);
                // The seam's two sides are one place, to the bit.
                map.surface.vertices.push_back(positionMm({i == cells.x ? 0.0 : flat.x, flat.y}));
                const double nearest = map.surface.vertices.back().z / shape_.lengthMm;
                map.camera.push_back(
                    std::int32_t(std::lround(std::clamp(nearest, 0.0, 1.0) * (cameras - 1))));
            }
        }
        for (int j = 0; j < cells.y; ++j) {
            for (int i = 0; i < cells.x; ++i) {
                const int a = j * (cells.x + 1) + i, b = a + 1, d = a + cells.x + 1, c = d + 1;
                const auto add = [&](glm::ivec3 triangle) {
                    map.sourceTriangle.push_back(std::int32_t(map.surface.triangles.size()));
                    map.surface.triangles.push_back(triangle);
                };
                if ((i + j) % 2) {
                    add({a, b, c}), add({a, c, d});
                } else {
                    add({a, b, d}), add({b, c, d});
                }
            }
        }
        return map;
    }

    /// Air in the tube, which goes on straight for 4 mm past the map's ends and is closed there;
    /// soft tissue around; blurred as by a scanner. The wall lies at −480 HU.
    Volume<std::int16_t> scan(double spacingMm = 0.8) const {
        constexpr double beyondMm = 4.0, aroundMm = 8.0;
        const double outer = shape_.radiusMm + shape_.foldMm + aroundMm;
        const double low = -beyondMm - aroundMm,
                     high = shape_.lengthMm + std::max(shape_.leanMm, 0.0) + beyondMm + aroundMm;
        const glm::ivec3 size =
            glm::ivec3(glm::ceil(glm::dvec3(2.0 * outer, 2.0 * outer, high - low) / spacingMm)) + 1;
        const double side = 0.5 * spacingMm * (size.x - 1);
        Volume<std::int16_t> volume(
            axisAlignedGrid(size, glm::dvec3(spacingMm), {-side, -side, low}));

        // The distance to the wall depends on the distance from the axis and on z alone.
        constexpr double cell = 0.2;
        const std::vector<glm::dvec2> outline = closedProfile(beyondMm);
        const glm::ivec2 cells(int(std::sqrt(2.0) * side / cell) + 2, int((high - low) / cell) + 8);
        std::vector<double> distance;
        for (int k = 0; k < cells.y; ++k)
            for (int r = 0; r < cells.x; ++r)
                distance.push_back(signedDistance(outline, {r * cell, low + k * cell}));
        const auto at = [&](glm::dvec2 p) {
            const glm::dvec2 q = (p - glm::dvec2(0.0, low)) / cell;
            const glm::ivec2 i = glm::min(glm::ivec2(q), cells - 2);
            const glm::dvec2 f = q - glm::dvec2(i);
            const double* row =
                &distance[std::size_t(i.y) * std::size_t(cells.x) + std::size_t(i.x)];
            return glm::mix(glm::mix(row[0], row[1], f.x),
                            glm::mix(row[cells.x], row[cells.x + 1], f.x), f.y);
        };
        for (std::size_t n = 0; n < volume.grid().voxelCount(); ++n) {
            const glm::dvec3 p = volume.grid().patientFromVoxelPoint(volume.grid().voxelAt(n));
            const double outside = at({std::hypot(p.x, p.y), p.z});
            volume.writable()[n] =
                std::int16_t(std::lround(-480.0 + 520.0 * std::tanh(outside / 0.9)));
        }
        return volume;
    }

    /// The axis, a point each millimetre.
    Centerline centerline() const {
        Centerline line;
        const int points = int(std::lround(shape_.lengthMm)) + 1;
        for (int n = 0; n < points; ++n) {
            const double z = shape_.lengthMm * n / (points - 1);
            line.points.push_back({{0.0, 0.0, z}, z, shape_.radiusMm - shape_.foldMm, false});
        }
        return line;
    }

private:
    static constexpr int steps = 6000;

    double wave() const { return 2.0 * std::numbers::pi / shape_.foldPeriodMm; }
    /// (radius, z) of the curve; its parameter is z less the lean. It is widest at both ends if the
    /// length is a whole number of periods.
    glm::dvec2 profile(double t) const {
        const double c = std::cos(wave() * t);
        return {shape_.radiusMm + shape_.foldMm * c, t + 0.5 * shape_.leanMm * (1.0 - c)};
    }
    glm::dvec2 profileSlope(double t) const {
        const double s = wave() * std::sin(wave() * t);
        return {-shape_.foldMm * s, 1.0 + 0.5 * shape_.leanMm * s};
    }
    double flatSlope(double t) const {
        return glm::length(profileSlope(t)) / (2.0 * std::numbers::pi * profile(t).x);
    }
    double parameterAt(double y) const {
        const double clamped = std::clamp(y, 0.0, height());
        const auto above = std::upper_bound(flatY_.begin() + 1, flatY_.end() - 1, clamped);
        const double part = (clamped - above[-1]) / (above[0] - above[-1]);
        return shape_.lengthMm / steps * (double(above - flatY_.begin()) - 1.0 + part);
    }
    std::vector<glm::dvec2> closedProfile(double beyondMm) const {
        std::vector<glm::dvec2> points;
        const glm::dvec2 first = profile(0.0), last = profile(shape_.lengthMm);
        points.push_back({0.0, first.y - beyondMm});
        points.push_back({first.x, first.y - beyondMm});
        constexpr int chords = 300;
        for (int n = 0; n <= chords; ++n)
            points.push_back(profile(shape_.lengthMm * n / chords));
        points.push_back({last.x, last.y + beyondMm});
        points.push_back({0.0, last.y + beyondMm});
        return points;
    }
    /// To an outline that the axis closes; negative inside.
    static double signedDistance(const std::vector<glm::dvec2>& outline, glm::dvec2 p) {
        double best = 1e9;
        bool inside = false;
        for (std::size_t n = 1; n < outline.size(); ++n) {
            const glm::dvec2 a = outline[n - 1], chord = outline[n] - a;
            const double s = std::clamp(glm::dot(p - a, chord) / glm::dot(chord, chord), 0.0, 1.0);
            best = std::min(best, glm::distance(p, a + s * chord));
            // Crossings of the ray from p away from the axis.
            if ((a.y > p.y) != (a.y + chord.y > p.y))
                inside = inside != (p.x < a.x + chord.x * (p.y - a.y) / chord.y);
        }
        return inside ? -best : best;
    }

    FlatTubeShape shape_;
    std::vector<double> flatY_;
};

}  // namespace haustra::tests
