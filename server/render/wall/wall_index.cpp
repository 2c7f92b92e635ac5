#include "render/wall/wall_index.h"

#include "render/wall/wall_projection.h"
#include "shaders/shader_source.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::render {

namespace {

/// Pixels along a cube's side, so that they are at most half as wide as the fisheye's: those in the
/// middle of a side, where it is coarsest, span 2 / side radians.
int cubeSidePixels(const Camera& camera, const Band& band) {
    const double pixelsPerRadian = band.pictureSize.y / glm::radians(camera.fovDegrees);
    return std::clamp(int(std::ceil(4.0 * pixelsPerRadian)), 16, maxPictureSide);
}

constexpr int trianglesOfRun = 1024;

}  // namespace

Result<WallIndex> WallIndex::create() {
    using shaders::shaderSource;
    const auto structs = shaderSource("uniforms.h"), flatMap = shaderSource("flat_map.glsl"),
               own = shaderSource("wall_uniforms.h"), lens = shaderSource("lens.glsl"),
               wall = shaderSource("wall.glsl");
    auto triangles = TRY(gpu::RasterProgram::create(
        "wall_triangles", {structs, flatMap, own, lens, wall, shaderSource("wall_triangles.vert")},
        {structs, own, lens, wall, shaderSource("wall_triangles.frag")}));
    auto places = TRY(gpu::ComputeProgram::create(
        "wall_index.comp", {structs, flatMap, own, lens, wall, shaderSource("wall_index.comp")}));
    auto block = TRY(gpu::UniformBuffer::create(sizeof(shaders::WallUniforms)));
    return WallIndex(std::move(triangles), std::move(places), std::move(block));
}

WallIndex::WallIndex(gpu::RasterProgram triangles, gpu::ComputeProgram places,
                     gpu::UniformBuffer block)
    : triangles_(std::move(triangles)), places_(std::move(places)), block_(std::move(block)) {}

Result<void> WallIndex::makeTargets(glm::ivec2 picture, glm::ivec2 raster) {
    using gpu::Filter, gpu::RasterTarget, gpu::TexelFormat, gpu::Texture;
    if (!triangleOfPixel_ || triangleOfPixel_->size() != raster) {
        auto made = TRY(RasterTarget::create(raster, TexelFormat::rg32i, "triangles of the wall"));
        triangleOfPixel_ = std::move(made);
    }
    if (!placeOfPixel_ || glm::ivec2(placeOfPixel_->size()) != picture) {
        auto made = TRY(Texture::create(2, {picture, 1}, TexelFormat::rgba32f, Filter::nearest,
                                        "places of the wall"));
        placeOfPixel_ = std::move(made);
    }
    return {};
}

void WallIndex::makeRuns(const FlatGeometry& geometry) {
    const auto& triangles = geometry.triangles();
    for (int first = 0; first < int(triangles.size()); first += trianglesOfRun) {
        Run run{{first, std::min(trianglesOfRun, int(triangles.size()) - first)}};
        glm::vec3 low(INFINITY), high(-INFINITY);
        for (int t = first; t < first + run.triangles.count; ++t) {
            for (int corner = 0; corner < 3; ++corner) {
                const int vertex = triangles[std::size_t(t)][corner];
                const glm::vec3 place = geometry.vertices()[std::size_t(vertex)].placeMm;
                low = glm::min(low, place);
                high = glm::max(high, place);
            }
        }
        run.middleMm = 0.5f * (low + high);
        run.radiusMm = 0.5f * glm::distance(low, high);
        runs_.push_back(run);
    }
}

// In one draw where nothing is left out between two runs.
void WallIndex::drawSeen(const FlatSurface& surface, shaders::WallUniforms& pass) {
    block_.bind(shaders::wallUniformBinding);
    surface.bind();
    triangleOfPixel_->clear(glm::ivec4(-1, 0, 0, 0));
    TriangleRange draw;
    const auto flush = [&] {
        if (draw.count == 0) return;
        pass.firstTriangle = draw.first;
        block_.write(pass);
        triangles_.drawNearest(*triangleOfPixel_, surface.triangles(), draw.first, draw.count);
        draw = {};
    };
    for (const Run& run : runs_) {
        if (!mayShow(pass, run.middleMm - pass.eyeMm, run.radiusMm)) continue;
        if (draw.count > 0 && draw.first + draw.count != run.triangles.first) flush();
        if (draw.count == 0) draw.first = run.triangles.first;
        draw.count += run.triangles.count;
    }
    flush();
    block_.write(pass);  // for the pass that finds places, also where nothing was drawn
}

Result<std::vector<WallPixel>> WallIndex::find(gpu::Context& context, const FlatSurface& surface,
                                               const Camera& camera, const Band& band) {
    const int errorsBefore = context.errorCount();
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    const bool cube = camera.lens == Lens::fisheye;
    const int side = cube ? cubeSidePixels(camera, band) : 0;
    TRY(makeTargets(size, cube ? glm::ivec2(side) : size));
    // What lies within 125° of the axis is on the first five sides, to their corners.
    const bool behind =
        camera.fovDegrees * std::hypot(1.0, double(size.x) / band.pictureSize.y) > 2.0 * 125.0;
    if (runs_.empty()) makeRuns(surface.geometry());
    const int passes = !cube ? 1 : behind ? 6 : 5;
    for (int pass = 0; pass < passes; ++pass) {
        shaders::WallUniforms u = cube ? cubeSide(camera, band, surface.originMm(), pass)
                                       : wallProjection(camera, band, surface.originMm());
        u.unitsPerCircumference = float(surface.unitsPerCircumference());
        drawSeen(surface, u);
        triangleOfPixel_->texture().bind(shaders::triangleUnit);
        placeOfPixel_->bindImage(shaders::pictureImage);
        places_.dispatch(size);
    }
    std::vector<WallPixel> pixels(std::size_t(size.x) * std::size_t(size.y));
    static_assert(sizeof(WallPixel) == 16, "a texel of four floats");
    placeOfPixel_->read(pixels.data(), placeOfPixel_->bytes());
    if (context.errorCount() != errorsBefore)
        return fail(ErrorKind::device, "the graphics driver reported an error", "wall index");
    return pixels;
}

std::size_t WallIndex::gpuBytes() const {
    return (triangleOfPixel_ ? triangleOfPixel_->bytes() : 0) +
           (placeOfPixel_ ? placeOfPixel_->bytes() : 0);
}

}  // namespace haustra::render
