#include "render/wall/wall_projection.h"

#include <array>
#include <cmath>

namespace haustra::render {

namespace {

constexpr double nearMm = 0.1, farMm = 10000.0;

struct CameraAxes {
    glm::dvec3 forward, right, down;
};

CameraAxes axesOf(const Camera& camera) {
    const glm::dvec3 forward = glm::normalize(camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    return {forward, right, glm::cross(forward, right)};
}

/// Everything but how the pass itself projects.
shaders::WallUniforms lensOf(const Camera& camera, const Band& band, glm::dvec3 originMm) {
    const CameraAxes axes = axesOf(camera);
    const double aspect = double(band.pictureSize.x) / band.pictureSize.y;
    const bool parallel = camera.lens == Lens::orthographic;
    double half = 1.0;
    if (camera.lens == Lens::perspective) half = std::tan(glm::radians(0.5 * camera.fovDegrees));
    if (parallel) half = 0.5 * camera.heightMm;
    shaders::WallUniforms u{};
    u.eyeMm = glm::vec4(camera.positionMm - originMm, parallel ? 1.0 : 0.0);
    u.lensAhead = glm::vec4(axes.forward, 0.0);
    u.lensRight = glm::vec4(half * aspect * axes.right, 0.0);
    u.lensDown = glm::vec4(half * axes.down, 0.0);
    u.down.w = camera.lens == Lens::fisheye ? float(glm::radians(0.5 * camera.fovDegrees)) : 0.0f;
    u.picture = glm::ivec4(band.pictureSize, band.firstRow, 0);
    return u;
}

void project(shaders::WallUniforms& u, glm::dvec3 forward, glm::dvec3 right, glm::dvec3 down,
             bool parallel) {
    const double range = farMm - nearMm;
    u.forward = glm::vec4(forward, parallel ? 2.0 / range : (farMm + nearMm) / range);
    u.right =
        glm::vec4(right, parallel ? -(farMm + nearMm) / range : -2.0 * farMm * nearMm / range);
    u.down = glm::vec4(down, u.down.w);
}

}  // namespace

shaders::WallUniforms wallProjection(const Camera& camera, const Band& band, glm::dvec3 originMm) {
    shaders::WallUniforms u = lensOf(camera, band, originMm);
    const CameraAxes axes = axesOf(camera);
    const double halfWidth = glm::length(glm::dvec3(u.lensRight)),
                 halfHeight = glm::length(glm::dvec3(u.lensDown));
    project(u, axes.forward, axes.right / halfWidth, axes.down / halfHeight,
            camera.lens == Lens::orthographic);
    // Of the whole picture's rows, the band's are spread over the target's.
    const double share = double(band.pictureSize.y) / band.rows;
    u.rows = glm::vec4(share, share - 2.0 * band.firstRow / band.rows - 1.0, 0.0, 0.0);
    return u;
}

shaders::WallUniforms cubeSide(const Camera& camera, const Band& band, glm::dvec3 originMm,
                               int side) {
    const auto [ahead, right, down] = axesOf(camera);
    const std::array<CameraAxes, 6> sides = {{{ahead, right, down},
                                              {right, -ahead, down},
                                              {-right, ahead, down},
                                              {down, right, -ahead},
                                              {-down, right, ahead},
                                              {-ahead, -right, down}}};
    const CameraAxes& axes = sides[std::size_t(side)];
    shaders::WallUniforms u = lensOf(camera, band, originMm);
    project(u, axes.forward, axes.right, axes.down, false);
    u.rows = glm::vec4(1.0, 0.0, 0.0, 0.0);
    u.picture.w = 1;
    return u;
}

}  // namespace haustra::render
