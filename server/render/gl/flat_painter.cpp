#include "render/gl/flat_painter.h"

#include "render/scene/stored_value.h"
#include "shaders/shader_source.h"

#include <cmath>
#include <utility>

namespace haustra::render {

Result<FlatPainter> FlatPainter::create(const FlatMap& map, const Grid& grid) {
    const auto geometry = TRY(FlatGeometry::of(map, grid));
    auto surface = TRY(FlatSurface::upload(geometry));
    return create(std::make_shared<const FlatSurface>(std::move(surface)));
}

Result<FlatPainter> FlatPainter::create(std::shared_ptr<const FlatSurface> surface) {
    using shaders::shaderSource;
    const auto structs = shaderSource("uniforms.h"), flatMap = shaderSource("flat_map.glsl");
    auto triangles = TRY(gpu::RasterProgram::create(
        "flat_triangles", {structs, flatMap, shaderSource("flat_triangles.vert")},
        {structs, flatMap, shaderSource("flat_triangles.frag")}));
    auto block = TRY(gpu::UniformBuffer::create(sizeof(shaders::FlatUniforms)));
    FlatPainter made(std::move(surface), std::move(triangles), std::move(block));
    // A driver that refuses the text is found here, not in a reader's session.
    TRY(made.rays_.program({}));
    return made;
}

FlatPainter::FlatPainter(std::shared_ptr<const FlatSurface> surface, gpu::RasterProgram triangles,
                         gpu::UniformBuffer block)
    : surface_(std::move(surface)), triangles_(std::move(triangles)), block_(std::move(block)) {}

Result<void> FlatPainter::findTriangles(const FlatWindow& window, const Band& band) {
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    if (!triangleOfPixel_ || glm::ivec2(triangleOfPixel_->size()) != size) {
        auto made = TRY(gpu::Texture::create(2, {size, 1}, gpu::TexelFormat::rg32i,
                                             gpu::Filter::nearest, "triangles of the picture"));
        triangleOfPixel_ = std::move(made);
    }
    const FlatLattice lattice = surface_->geometry().lattice(window, band);
    uniforms_ = lattice.uniforms;
    uniforms_.reachPixels = float(gpu::RasterProgram::reachPixels);
    block_.write(uniforms_);
    block_.bind(shaders::flatUniformBinding);
    surface_->bind();
    triangles_.draw(*triangleOfPixel_, {-1, 0}, surface_->triangles(), lattice.triangles.first,
                    lattice.triangles.count, lattice.copies);
    return {};
}

std::vector<int> FlatPainter::triangleOfPixel() const {
    if (!triangleOfPixel_) return {};
    const glm::ivec3 size = triangleOfPixel_->size();
    std::vector<glm::ivec2> found(std::size_t(size.x) * std::size_t(size.y));
    triangleOfPixel_->read(found.data(), triangleOfPixel_->bytes());
    std::vector<int> triangles;
    for (const glm::ivec2 one : found)
        triangles.push_back(one.x < 0 ? -1 : surface_->geometry().mapTriangle(one.x));
    return triangles;
}

Result<void> FlatPainter::castRays(const MarchVariant& variant, double stepMm,
                                   const gpu::Texture& picture) {
    const auto rays = TRY(rays_.program(variant));
    uniforms_.mostStepsBack = float(std::ceil(flatRay.backMm / stepMm));
    uniforms_.riseThatEnds = float(flatRay.riseHu / storedRange);
    uniforms_.mostStepsOn = float(std::ceil(flatRay.depthMm / stepMm));
    block_.write(uniforms_);
    block_.bind(shaders::flatUniformBinding);
    surface_->bind();
    triangleOfPixel_->bind(shaders::triangleUnit);
    picture.bindImage(shaders::pictureImage);
    rays->dispatch(glm::ivec2(picture.size()));
    return {};
}

std::size_t FlatPainter::gpuBytes() const {
    return triangleOfPixel_ ? triangleOfPixel_->bytes() : 0;
}

}  // namespace haustra::render
