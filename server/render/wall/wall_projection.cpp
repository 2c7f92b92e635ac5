#include "render/wall/wall_projection.h"

#include "render/scene/lens.h"

#include <array>

namespace haustra::render {

namespace {

constexpr double nearMm = 0.1, farMm = 10000.0;

struct CameraAxes {
    glm::dvec3 forward, right, down;
};

/// Everything but how the pass itself projects.
shaders::WallUniforms lensOf(const LensFrame& frame, const Camera& camera, const Band& band,
                             glm::dvec3 originMm) {
    shaders::WallUniforms u{};
    u.eyeMm = camera.positionMm - originMm;
    u.lens = int(frame.lens);
    u.lensAhead = frame.ahead;
    u.lensRight = frame.right;
    u.lensDown = frame.down;
    u.pictureSize = band.pictureSize;
    u.firstRow = band.firstRow;
    return u;
}

void project(shaders::WallUniforms& u, const CameraAxes& axes, bool parallel) {
    const double range = farMm - nearMm;
    u.forward = axes.forward;
    u.right = axes.right;
    u.down = axes.down;
    u.depthScale = float(parallel ? 2.0 / range : (farMm + nearMm) / range);
    u.depthBias = float(parallel ? -(farMm + nearMm) / range : -2.0 * farMm * nearMm / range);
}

LensFrame frameOf(const Camera& camera, const Band& band) {
    return lensFrame(camera, double(band.pictureSize.x) / band.pictureSize.y);
}

}  // namespace

shaders::WallUniforms wallProjection(const Camera& camera, const Band& band, glm::dvec3 originMm) {
    const LensFrame frame = frameOf(camera, band);
    shaders::WallUniforms u = lensOf(frame, camera, band, originMm);
    project(u,
            {frame.ahead, frame.right / glm::dot(frame.right, frame.right),
             frame.down / glm::dot(frame.down, frame.down)},
            camera.lens == Lens::orthographic);
    // Of the whole picture's rows, the band's are spread over the target's.
    const double share = double(band.pictureSize.y) / band.rows;
    u.rowScale = float(share);
    u.rowBias = float(share - 2.0 * band.firstRow / band.rows - 1.0);
    return u;
}

shaders::WallUniforms cubeSide(const Camera& camera, const Band& band, glm::dvec3 originMm,
                               int side) {
    const LensFrame frame = frameOf(camera, band);
    const glm::dvec3 ahead = frame.ahead, right = glm::normalize(frame.right),
                     down = glm::normalize(frame.down);
    const std::array<CameraAxes, 6> sides = {{{ahead, right, down},
                                              {right, -ahead, down},
                                              {-right, ahead, down},
                                              {down, right, -ahead},
                                              {-down, right, ahead},
                                              {-ahead, -right, down}}};
    shaders::WallUniforms u = lensOf(frame, camera, band, originMm);
    project(u, sides[std::size_t(side)], false);
    u.rowScale = 1.0f;
    u.isCubeSide = 1;
    return u;
}

bool mayShow(const shaders::WallUniforms& pass, glm::vec3 middle, float radius) {
    const bool parallel = pass.lens == int(Lens::orthographic);
    radius += 0.01f + 1e-4f * glm::length(middle);  // rounding
    if (glm::dot(pass.forward, middle) < -radius) return false;
    for (const glm::vec3 side : {pass.right, -pass.right, pass.down, -pass.down}) {
        const glm::vec3 outward = parallel ? side : side - pass.forward;
        if (glm::dot(outward, middle) - (parallel ? 1.0f : 0.0f) > radius * glm::length(outward))
            return false;
    }
    return true;
}

}  // namespace haustra::render
