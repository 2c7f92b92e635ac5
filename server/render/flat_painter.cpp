#include "render/flat_painter.h"

#include "render/stored_value.h"
#include "shaders/shader_source.h"

#include <cmath>
#include <utility>

namespace haustra::render {

namespace {

/// The lattice's phase is kept to this part of a pixel, so that windows whose centres differ by
/// whole pixels share one lattice in spite of rounding.
constexpr double phasesPerPixel = 65536.0;

shaders::FlatUniforms flatUniforms(const FlatWindow& window, glm::ivec2 size,
                                   const FlatSurface& surface, TriangleRange triangles) {
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
    auto block = gpu::UniformBuffer::create(sizeof(shaders::FlatUniforms));
    if (!block) return tl::make_unexpected(block.error());
    FlatPainter made(std::move(*surface), std::move(*triangles), std::move(*block));
    // A driver that refuses the text is found here, not in a reader's session.
    if (auto rays = made.rays_.program({}); !rays) return tl::make_unexpected(rays.error());
    return made;
}

FlatPainter::FlatPainter(FlatSurface surface, gpu::RasterProgram triangles,
                         gpu::UniformBuffer block)
    : surface_(std::move(surface)), triangles_(std::move(triangles)), block_(std::move(block)) {}

Result<void> FlatPainter::findTriangles(const FlatWindow& window, glm::ivec2 size) {
    if (!triangleOfPixel_ || glm::ivec2(triangleOfPixel_->size()) != size) {
        auto made = gpu::Texture::create(2, {size, 1}, gpu::TexelFormat::rg32i,
                                         gpu::Filter::nearest, "triangles of the picture");
        if (!made) return tl::make_unexpected(made.error());
        triangleOfPixel_ = std::move(*made);
    }
    const double halfHeight = (0.5 * size.y + 1.0) / window.pixelsPerUnit;
    const TriangleRange triangles =
        surface_.trianglesWithin(window.center.y - halfHeight, window.center.y + halfHeight);
    uniforms_ = flatUniforms(window, size, surface_, triangles);
    block_.write(uniforms_);
    block_.bind(shaders::flatUniformBinding);
    surface_.bind();
    const double rightmost = double(uniforms_.lattice.x) + uniforms_.phase.x;
    const int lastCopy = int(std::floor(rightmost / window.pixelsPerUnit));
    triangles_.draw(*triangleOfPixel_, {-1, 0}, surface_.triangles(), triangles.first,
                    triangles.count, lastCopy - uniforms_.lattice.w + 1);
    return {};
}

std::vector<int> FlatPainter::triangleOfPixel() const {
    if (!triangleOfPixel_) return {};
    const glm::ivec3 size = triangleOfPixel_->size();
    std::vector<glm::ivec2> found(std::size_t(size.x) * std::size_t(size.y));
    triangleOfPixel_->read(found.data(), triangleOfPixel_->bytes());
    std::vector<int> triangles;
    for (const glm::ivec2 one : found)
        triangles.push_back(one.x < 0 ? -1 : surface_.mapTriangle(one.x));
    return triangles;
}

Result<void> FlatPainter::castRays(const MarchVariant& variant, double stepMm,
                                   const gpu::Texture& picture) {
    const auto rays = rays_.program(variant);
    if (!rays) return tl::make_unexpected(rays.error());
    uniforms_.ray = glm::vec4(std::ceil(flatRay.backMm / stepMm), flatRay.riseHu / storedRange,
                              std::ceil(flatRay.depthMm / stepMm), 0.0);
    block_.write(uniforms_);
    block_.bind(shaders::flatUniformBinding);
    surface_.bind();
    triangleOfPixel_->bind(shaders::triangleUnit);
    picture.bindImage(shaders::pictureImage);
    (*rays)->dispatch(glm::ivec2(picture.size()));
    return {};
}

std::size_t FlatPainter::gpuBytes() const {
    return surface_.gpuBytes() + (triangleOfPixel_ ? triangleOfPixel_->bytes() : 0);
}

}  // namespace haustra::render
