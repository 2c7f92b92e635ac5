#include "render/flat_painter.h"

#include "render/stored_value.h"
#include "shaders/shader_source.h"
#include "shaders/uniforms.h"

#include <cmath>
#include <utility>

namespace haustra::render {

namespace {

/// The lattice's phase is kept to this part of a pixel, so that windows whose centres differ by
/// whole pixels share one lattice in spite of rounding.
constexpr double phasesPerPixel = 65536.0;

shaders::FlatUniforms flatUniforms(const FlatWindow& window, glm::ivec2 size,
                                   const FlatSurface& surface, TriangleRange triangles,
                                   double stepMm) {
    const double pixels = window.pixelsPerUnit, units = surface.unitsPerCircumference();
    // Pixel (i, j) shows the flat coordinate (edge − (i, j) − ½) / pixels.
    const glm::dvec2 middle(window.center.x - std::floor(window.center.x), window.center.y);
    const glm::dvec2 edge =
        glm::round((middle * pixels + 0.5 * glm::dvec2(size)) * phasesPerPixel) / phasesPerPixel;
    const glm::dvec2 lattice = glm::floor(edge);
    shaders::FlatUniforms u{};
    u.phase = edge - lattice;
    u.scale = {units / pixels, pixels / units};
    const int firstCopy = int(std::floor((edge.x - size.x) / pixels));
    u.lattice = glm::ivec4(glm::ivec2(lattice), surface.unitsPerCircumference(), firstCopy);
    u.picture = glm::ivec4(size, triangles.first, surface.cameraCount() - 1);
    u.angles = glm::vec4(flatRay.mostRayAngle, flatRay.mostLightAngle, flatRay.lampAhead, 0.0);
    u.ray = glm::vec4(std::ceil(flatRay.backMm / stepMm), flatRay.riseHu / storedRange,
                      std::ceil(flatRay.depthMm / stepMm), 0.0);
    return u;
}

}  // namespace

Result<FlatPainter> FlatPainter::create(const FlatMap& map, const Grid& grid) {
    using shaders::shaderSource;
    // The centre of texture space.
    auto surface =
        FlatSurface::upload(map, grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size) - 0.5));
    if (!surface) return tl::make_unexpected(surface.error());
    const auto structs = shaderSource("uniforms.h"), flatMap = shaderSource("flat_map.glsl");
    auto triangles = gpu::RasterProgram::create(
        "flat_triangles", {structs, flatMap, shaderSource("flat_triangles.vert")},
        {structs, flatMap, shaderSource("flat_triangles.frag")});
    if (!triangles) return tl::make_unexpected(triangles.error());
    auto rays = gpu::ComputeProgram::create(
        "flattened.comp", {structs, shaderSource("march.glsl"), shaderSource("picture.glsl"),
                           flatMap, shaderSource("flattened.comp")});
    if (!rays) return tl::make_unexpected(rays.error());
    auto block = gpu::UniformBuffer::create(sizeof(shaders::FlatUniforms));
    if (!block) return tl::make_unexpected(block.error());
    return FlatPainter(std::move(*surface), std::move(*triangles), std::move(*rays),
                       std::move(*block));
}

FlatPainter::FlatPainter(FlatSurface surface, gpu::RasterProgram triangles,
                         gpu::ComputeProgram rays, gpu::UniformBuffer block)
    : surface_(std::move(surface)),
      triangles_(std::move(triangles)),
      rays_(std::move(rays)),
      block_(std::move(block)) {}

Result<void> FlatPainter::draw(const FlatWindow& window, double stepMm,
                               const gpu::Texture& picture) {
    const glm::ivec2 size(picture.size());
    if (!triangleOfPixel_ || glm::ivec2(triangleOfPixel_->size()) != size) {
        auto made = gpu::Texture::create(2, {size, 1}, gpu::TexelFormat::rg32i,
                                         gpu::Filter::nearest, "triangles of the picture");
        if (!made) return tl::make_unexpected(made.error());
        triangleOfPixel_ = std::move(*made);
    }
    const double pixelUnits = 1.0 / window.pixelsPerUnit;
    const double halfHeight = (0.5 * size.y + 1.0) * pixelUnits;
    const TriangleRange triangles =
        surface_.trianglesWithin(window.center.y - halfHeight, window.center.y + halfHeight);
    const shaders::FlatUniforms u = flatUniforms(window, size, surface_, triangles, stepMm);
    block_.write(u);
    block_.bind(shaders::flatUniformBinding);
    surface_.bind();
    const int lastCopy = int(std::floor((double(u.lattice.x) + u.phase.x) / window.pixelsPerUnit));
    triangles_.draw(*triangleOfPixel_, {-1, 0}, surface_.triangles(), triangles.first,
                    triangles.count, lastCopy - u.lattice.w + 1);
    triangleOfPixel_->bind(shaders::triangleUnit);
    picture.bindImage(shaders::pictureImage);
    rays_.dispatch(size);
    return {};
}

std::size_t FlatPainter::gpuBytes() const {
    return surface_.gpuBytes() + (triangleOfPixel_ ? triangleOfPixel_->bytes() : 0);
}

}  // namespace haustra::render
