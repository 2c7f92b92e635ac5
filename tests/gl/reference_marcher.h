// The ray caster again, plainly, in double precision on the CPU: what the others are held against.
#pragma once

#include "core/volume.h"
#include "render/scene/picture.h"
#include "render_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace haustra::tests {

struct Classified {
    glm::dvec3 color{0.0};  // linear light
    double opacity = 0.0;   // for 1 mm
};

using Points = std::vector<render::TransferFunctionPoint>;

/// Colour as displayed.
inline Classified lookedUp(const Points& points, double hu) {
    const auto above =
        std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.hu > hu; });
    const auto& b = above == points.end() ? points.back() : *above;
    const auto& a = above == points.begin() ? points.front() : *(above - 1);
    const double share = b.hu > a.hu ? std::clamp((hu - a.hu) / (b.hu - a.hu), 0.0, 1.0) : 1.0;
    return {glm::mix(a.color, b.color, share), glm::mix(a.opacity, b.opacity, share)};
}

inline Classified inLinearLight(Classified c) {
    return {{linearOf(c.color.r), linearOf(c.color.g), linearOf(c.color.b)}, c.opacity};
}

/// For one step. `huPerMm` is the gradient's magnitude.
inline Classified classify(const render::TransferFunction& function, double hu, double huPerMm,
                           double stepMm) {
    Classified here = lookedUp(function.points, hu);
    double below = 0.0;
    for (const render::GradientRow& row : function.rows) {
        const Classified there = lookedUp(row.points, hu);
        const double share = std::min((huPerMm - below) / (row.gradientHuPerMm - below), 1.0);
        here = {glm::mix(here.color, there.color, share),
                glm::mix(here.opacity, there.opacity, share)};
        if (share < 1.0) break;
        below = row.gradientHuPerMm;
    }
    here.opacity = 1.0 - std::pow(1.0 - here.opacity, stepMm);
    return inLinearLight(here);
}

/// Of the segment between two values, by adding up many small parts of it.
inline Classified classifySegment(const Points& points, double front, double back, double stepMm) {
    const double low = std::min(front, back), high = std::max(front, back);
    const bool shows =
        lookedUp(points, low).opacity > 0.0 || lookedUp(points, high).opacity > 0.0 ||
        std::any_of(points.begin(), points.end(),
                    [&](const auto& p) { return p.opacity > 0.0 && p.hu > low && p.hu < high; });
    if (!shows) return {};
    constexpr int parts = 400;
    glm::dvec3 color(0.0);
    double depth = 0.0;
    for (int i = 0; i < parts; ++i) {
        const Classified here =
            inLinearLight(lookedUp(points, glm::mix(front, back, (i + 0.5) / parts)));
        const double extinction =
            -stepMm * std::log(std::max(1.0 - here.opacity, std::exp2(-14.0))) / parts;
        color += extinction * here.color;
        depth += extinction;
    }
    return {depth > 0.0 ? color / depth : color, 1.0 - std::exp(-depth)};
}

/// A ray in voxel coordinates, at n = 0 and one step on; the light's direction in the patient,
/// unit.
struct ReferenceRay {
    glm::dvec3 origin, step, light;
};

/// Along one ray.
class ReferenceMarcher {
public:
    ReferenceMarcher(const Volume<std::int16_t>& volume, const ReferenceRay& ray,
                     const render::Optics& optics, double stepMm)
        : volume_(volume),
          ray_(ray),
          optics_(optics),
          stepMm_(stepMm),
          linear_(volume.grid().voxelFromPatient()) {}

    /// Displayed colour, 0…1, of the samples from n = 0 to `last`, before linear light from behind.
    glm::dvec3 pixel(double last, glm::dvec3 behind = glm::dvec3(0.0)) const {
        glm::dvec4 sum(0.0);
        switch (optics_.composition) {
            case render::Composition::emissionAbsorption:
                sum = absorbed(last);
                break;
            case render::Composition::maximumIntensity:
                sum = greatest(last);
                break;
            case render::Composition::firstHit:
                sum = hit(last);
                break;
        }
        const bool ended = optics_.composition != render::Composition::maximumIntensity &&
                           sum.a >= render::terminationOpacity;
        glm::dvec3 color =
            ended ? glm::dvec3(sum) / sum.a : glm::dvec3(sum) + (1.0 - sum.a) * behind;
        for (int c = 0; c < 3; ++c)
            color[c] = displayedOf(std::clamp(color[c], 0.0, 1.0));
        return color;
    }

private:
    bool inside(double n) const {
        const glm::dvec3 at = ray_.origin + n * ray_.step;
        return glm::all(glm::greaterThanEqual(at, glm::dvec3(-0.5))) &&
               glm::all(glm::lessThanEqual(at, glm::dvec3(volume_.grid().size) - 0.5));
    }
    double valueAt(double n) const { return trilinear(volume_, ray_.origin + n * ray_.step); }
    /// In the patient, HU/mm.
    glm::dvec3 gradientAt(double n) const {
        const glm::dvec3 at = ray_.origin + n * ray_.step;
        glm::dvec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 one(0.0);
            one[axis] = 1.0;
            gradient[axis] = 0.5 * (trilinear(volume_, at + one) - trilinear(volume_, at - one));
        }
        return glm::transpose(linear_) * gradient;
    }
    glm::dvec3 lit(glm::dvec3 color, double n) const {
        if (!optics_.shading) return color;
        const glm::dvec3 normal = gradientAt(n);
        const render::Headlight& light = optics_.light;
        const bool flat = glm::length(normal) < 1e-6;
        const double facing = flat ? 1.0 : std::abs(glm::dot(glm::normalize(normal), ray_.light));
        const double mirror = std::max(2.0 * facing * facing - 1.0, 0.0);
        const double gloss = flat ? 0.0 : light.specular * std::pow(mirror, light.shininess);
        const double depth = n * stepMm_ / light.halfDepthMm;
        return (color * (light.ambient + light.diffuse * facing) + gloss) / (1.0 + depth * depth);
    }

    glm::dvec4 absorbed(double last) const {
        glm::dvec4 sum(0.0);
        std::optional<double> front;
        for (double n = 0.0; n <= last && sum.a < render::terminationOpacity; n += 1.0) {
            if (!inside(n)) continue;
            const double value = valueAt(n), shadedAt = optics_.preIntegrated ? n - 0.5 : n;
            const bool steep = !optics_.transferFunction.rows.empty();
            const Classified here =
                optics_.preIntegrated ? classifySegment(optics_.transferFunction.points,
                                                        front.value_or(value), value, stepMm_)
                                      : classify(optics_.transferFunction, value,
                                                 steep ? glm::length(gradientAt(n)) : 0.0, stepMm_);
            front = value;
            if (here.opacity <= 0.0) continue;
            const double share = (1.0 - sum.a) * here.opacity;
            sum += glm::dvec4(share * lit(here.color, shadedAt), share);
        }
        return sum;
    }
    glm::dvec4 greatest(double last) const {
        double most = -std::numeric_limits<double>::infinity();
        for (double n = 0.0; n <= last; n += 1.0)
            if (inside(n)) most = std::max(most, valueAt(n));
        const Classified here = inLinearLight(lookedUp(optics_.transferFunction.points, most));
        return std::isinf(most) ? glm::dvec4(0.0)
                                : glm::dvec4(here.opacity * here.color, here.opacity);
    }
    glm::dvec4 hit(double last) const {
        const auto reaches = [&](double n) {
            return lookedUp(optics_.transferFunction.points, valueAt(n)).opacity >=
                   render::firstHitOpacity;
        };
        for (double n = 0.0; n <= last; n += 1.0) {
            if (!inside(n) || !reaches(n)) continue;
            double before = n > 0.0 && inside(n - 1.0) ? n - 1.0 : n, at = n;
            for (int i = 0; i < 40; ++i) {
                const double middle = 0.5 * (before + at);
                (reaches(middle) ? at : before) = middle;
            }
            const Classified here =
                inLinearLight(lookedUp(optics_.transferFunction.points, valueAt(at)));
            return {lit(here.color, at), 1.0};
        }
        return glm::dvec4(0.0);
    }

    const Volume<std::int16_t>& volume_;
    ReferenceRay ray_;
    const render::Optics& optics_;
    double stepMm_;
    glm::dmat3 linear_;
};

inline void append(Image& image, glm::dvec3 color) {
    for (int c = 0; c < 3; ++c)
        image.rgb.push_back(std::uint8_t(std::lround(255.0 * color[c])));
}

/// Where a camera's ray begins and which way it goes, through a place of the picture: y upwards
/// from its middle in half heights, x to the right in the same unit.
struct LensRay {
    glm::dvec3 originMm, direction;
};
inline std::optional<LensRay> lensRay(const Camera& camera, double x, double y) {
    const glm::dvec3 forward = glm::normalize(camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::dvec3 up = glm::cross(right, forward), aside = x * right + y * up;
    const double half = 0.5 * glm::radians(camera.fovDegrees);
    switch (camera.lens) {
        case Lens::perspective:
            return LensRay{camera.positionMm, glm::normalize(forward + std::tan(half) * aside)};
        case Lens::fisheye: {
            const double angle = half * std::hypot(x, y);
            if (angle > glm::radians(180.0)) return std::nullopt;
            if (angle == 0.0) return LensRay{camera.positionMm, forward};
            return LensRay{camera.positionMm,
                           std::cos(angle) * forward + std::sin(angle) * glm::normalize(aside)};
        }
        case Lens::orthographic:
            return LensRay{camera.positionMm + 0.5 * camera.heightMm * aside, forward};
    }
    return std::nullopt;
}

/// What a camera sees.
inline Image referenceEndoscopic(const Volume<std::int16_t>& volume, const render::CameraView& view,
                                 int width, int height) {
    const Grid& grid = volume.grid();
    const glm::dmat3 linear(grid.voxelFromPatient());
    const glm::dvec3 spacing = grid.spacingMm();
    const double stepMm = view.march.stepVoxels * std::min({spacing.x, spacing.y, spacing.z});
    double farthestMm = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        farthestMm =
            std::max(farthestMm,
                     glm::distance(view.camera.positionMm,
                                   grid.patientFromVoxelPoint(side * glm::dvec3(grid.size) - 0.5)));
    }
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto ray = lensRay(view.camera, (2.0 * (x + 0.5) - width) / height,
                                     (height - 2.0 * (y + 0.5)) / height);
            glm::dvec3 behind(0.0);
            double last = ray ? std::ceil(farthestMm / stepMm) : -1.0;
            if (view.backdrop) {
                const glm::vec4 one =
                    view.backdrop->pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
                behind = glm::dvec3(one);
                last = std::min(last, std::floor(double(one.w) / stepMm));
            }
            if (!ray) {
                append(image, glm::dvec3(displayedOf(behind.r), displayedOf(behind.g),
                                         displayedOf(behind.b)));
                continue;
            }
            const ReferenceMarcher marcher(volume,
                                           {grid.voxelFromPatientPoint(ray->originMm),
                                            linear * ray->direction * stepMm, ray->direction},
                                           view.optics, stepMm);
            append(image, marcher.pixel(last, behind));
        }
    }
    return image;
}

inline double psnr(const Image& a, const Image& b) {
    double squares = 0.0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
        squares += std::pow(double(a.rgb[i]) - double(b.rgb[i]), 2.0);
    return 10.0 * std::log10(255.0 * 255.0 / std::max(squares / double(a.rgb.size()), 1e-9));
}

}  // namespace haustra::tests
