// The ray caster again, plainly, in double precision on the CPU: what the shader is held against.
#pragma once

#include "core/volume.h"
#include "render/view.h"
#include "render_scene.h"

#include <algorithm>
#include <cmath>

namespace haustra::tests {

struct Classified {
    glm::dvec3 color{0.0};  // linear light
    double opacity = 0.0;   // for one step
};

inline Classified classify(const render::TransferFunction& function, double hu, double stepMm) {
    const auto& points = function.points;
    const auto above =
        std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.hu > hu; });
    const auto& b = above == points.end() ? points.back() : *above;
    const auto& a = above == points.begin() ? points.front() : *(above - 1);
    const double share = b.hu > a.hu ? std::clamp((hu - a.hu) / (b.hu - a.hu), 0.0, 1.0) : 1.0;
    const glm::dvec3 displayed = glm::mix(a.color, b.color, share);
    return {{linearOf(displayed.r), linearOf(displayed.g), linearOf(displayed.b)},
            1.0 - std::pow(1.0 - glm::mix(a.opacity, b.opacity, share), stepMm)};
}

/// A ray in voxel coordinates, at n = 0 and one step on; the light's direction in the patient,
/// unit.
struct ReferenceRay {
    glm::dvec3 origin, step, light;
};

/// Displayed colour, 0…1, of a ray's samples from n = 0 to `last`.
inline glm::dvec3 marchRay(const Volume<std::int16_t>& volume, const ReferenceRay& ray,
                           const render::TransferFunction& function, bool shading, double stepMm,
                           double last) {
    const Grid& grid = volume.grid();
    const glm::dmat3 linear(grid.voxelFromPatient());
    const render::Headlight& light = render::headlight;
    glm::dvec3 color(0.0);
    double opacity = 0.0;
    for (double n = 0.0; n <= last && opacity < render::terminationOpacity; n += 1.0) {
        const glm::dvec3 at = ray.origin + n * ray.step;
        if (glm::any(glm::lessThan(at, glm::dvec3(-0.5))) ||
            glm::any(glm::greaterThan(at, glm::dvec3(grid.size) - 0.5)))
            continue;
        const Classified here = classify(function, trilinear(volume, at), stepMm);
        if (here.opacity <= 0.0) continue;
        glm::dvec3 lit = here.color;
        if (shading) {
            glm::dvec3 gradient;
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 one(0.0);
                one[axis] = 1.0;
                gradient[axis] = trilinear(volume, at + one) - trilinear(volume, at - one);
            }
            const glm::dvec3 normal = glm::transpose(linear) * gradient;
            const bool flat = glm::length(normal) < 1e-6;
            const double facing =
                flat ? 1.0 : std::abs(glm::dot(glm::normalize(normal), ray.light));
            const double gloss =
                flat ? 0.0
                     : light.specular *
                           std::pow(std::max(2.0 * facing * facing - 1.0, 0.0), light.shininess);
            const double depth = n * stepMm / light.halfDepthMm;
            lit = (here.color * (light.ambient + light.diffuse * facing) + gloss) /
                  (1.0 + depth * depth);
        }
        color += (1.0 - opacity) * here.opacity * lit;
        opacity += (1.0 - opacity) * here.opacity;
    }
    if (opacity >= render::terminationOpacity) color /= opacity;
    for (int c = 0; c < 3; ++c)
        color[c] = displayedOf(std::clamp(color[c], 0.0, 1.0));
    return color;
}

inline void append(render::Image& image, glm::dvec3 color) {
    for (int c = 0; c < 3; ++c)
        image.rgb.push_back(std::uint8_t(std::lround(255.0 * color[c])));
}

inline render::Image referenceEndoscopic(const Volume<std::int16_t>& volume,
                                         const render::CameraView& view, int width, int height) {
    const Grid& grid = volume.grid();
    const glm::dmat3 linear(grid.voxelFromPatient());
    const glm::dvec3 spacing = grid.spacingMm();
    const double stepMm = view.march.stepVoxels * std::min({spacing.x, spacing.y, spacing.z});
    const glm::dvec3 forward = glm::normalize(view.camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double slope = std::tan(glm::radians(view.camera.fovDegrees) / 2.0);
    const glm::dvec3 eye = grid.voxelFromPatientPoint(view.camera.positionMm);
    const double most = 4.0 * glm::length(glm::dvec3(grid.size) * spacing) / stepMm;

    render::Image image{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double across = slope * (2.0 * (x + 0.5) - width) / height;
            const double upwards = slope * (height - 2.0 * (y + 0.5)) / height;
            const glm::dvec3 ray = glm::normalize(forward + across * right + upwards * up);
            append(image,
                   marchRay(volume, {eye, linear * ray * stepMm, ray}, view.optics.transferFunction,
                            view.optics.shading, stepMm, most));
        }
    }
    return image;
}

inline double psnr(const render::Image& a, const render::Image& b) {
    double squares = 0.0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
        squares += std::pow(double(a.rgb[i]) - double(b.rgb[i]), 2.0);
    return 10.0 * std::log10(255.0 * 255.0 / std::max(squares / double(a.rgb.size()), 1e-9));
}

}  // namespace haustra::tests
