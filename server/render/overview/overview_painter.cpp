#include "render/overview/overview_painter.h"

#include "core/srgb.h"
#include "render/overview/overview_marks.h"
#include "render/scene/lens.h"
#include "shaders/shader_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace haustra::render {

namespace {

/// Linear light where neither wall nor body is, and how far away it is.
constexpr glm::vec4 background{0.0065f, 0.0080f, 0.0100f, 1e9f};
/// Pixels of a mark's or wall's picture along a pixel of the view's, in pictures up to this size.
constexpr int fineSide = 2;
constexpr std::int64_t finePixels = 1 << 20;
/// How far behind a wall marks fade, mm: a wide colon's diameter.
constexpr double fadeMm = 80.0;
constexpr double farthestShare = 0.45;

double displayed(double linear) {
    return displayedLight(std::clamp(linear, 0.0, 1.0));
}

std::uint8_t byteOf(double displayed) {
    return std::uint8_t(std::lround(255.0 * displayed));
}

struct Range {
    double low = INFINITY, high = -INFINITY;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

/// Where the corners of a box lie before the camera, mm.
Range depthsOf(const Camera& camera, glm::dvec3 low, glm::dvec3 high) {
    const glm::dvec3 forward = glm::normalize(camera.forward);
    Range depths;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                            corner & 4 ? high.z : low.z);
        depths.add(glm::dot(at - camera.positionMm, forward));
    }
    return depths;
}

shaders::OverviewUniforms uniformsOf(const OverviewView& view, const Scene& scene,
                                     glm::dvec3 originMm, glm::ivec2 size) {
    const Camera& camera = view.camera;
    const LensFrame frame = lensFrame(camera, double(size.x) / size.y);
    const glm::dvec3 forward = frame.ahead, right = glm::normalize(frame.right),
                     down = glm::normalize(frame.down);
    const bool perspective = camera.lens == Lens::perspective;
    const glm::dvec3 eye = camera.positionMm - originMm;

    glm::dvec3 low(INFINITY), high(-INFINITY);
    const auto include = [&](glm::dvec3 mm) {
        low = glm::min(low, mm);
        high = glm::max(high, mm);
    };
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        include(scene.grid().patientFromVoxelPoint(side * glm::dvec3(scene.grid().size) - 0.5));
    }
    Range wall = depthsOf(camera, low, high);
    if (scene.wall && !scene.wall->vertices.empty()) {
        wall = {};
        for (const glm::dvec3 vertex : scene.wall->vertices) {
            include(vertex);
            wall.add(glm::dot(vertex - camera.positionMm, forward));
        }
    }
    // Marks stand out of the volume by no more than their size.
    const Range all = depthsOf(camera, low, high);
    const double margin = 0.1 * (all.high - all.low);
    const double near = std::max(all.low - margin, perspective ? 1.0 : 0.0);
    const double far = std::max(all.high + margin, near + 1.0);

    // A row that is linear in the place: (place − eye) · axis.
    const auto row = [&](glm::dvec3 axis, double offset = 0.0) {
        return glm::vec4(axis, offset - glm::dot(eye, axis));
    };
    shaders::OverviewUniforms u{};
    u.clipRowX = row(frame.right / glm::dot(frame.right, frame.right));
    u.clipRowY = row(frame.down / glm::dot(frame.down, frame.down));
    if (perspective) {
        u.clipRowZ = row(forward * ((far + near) / (far - near)), -2.0 * far * near / (far - near));
        u.clipRowW = row(forward);
    } else {
        u.clipRowZ = row(forward * (2.0 / (far - near)), -(far + near) / (far - near));
        u.clipRowW = glm::vec4(0.0, 0.0, 0.0, 1.0);
    }
    u.eye = eye;
    u.raysBeginAtEye = perspective ? 1.0f : 0.0f;
    u.forward = forward;
    // From the upper left, as shapes are drawn.
    u.light = glm::normalize(-forward - 0.55 * down - 0.40 * right);
    u.farthestShare = float(farthestShare);
    u.wallBegins = float(wall.low);
    u.perWallDepth = float(1.0 / std::max(wall.high - wall.low, 1.0));
    u.fadeMm = float(fadeMm);
    return u;
}

template <class Texel>
std::vector<Texel> read(const gpu::RasterTarget& target) {
    std::vector<Texel> pixels(std::size_t(target.size().x) * std::size_t(target.size().y));
    target.texture().read(pixels.data(), pixels.size() * sizeof(Texel));
    return pixels;
}

/// combine(the fine pixels of one pixel) of each, rows from the top.
template <class Texel, class Combine>
std::vector<glm::vec4> reduced(const std::vector<Texel>& fine, glm::ivec2 size, int side,
                               Combine&& combine) {
    std::vector<glm::vec4> pixels;
    pixels.reserve(std::size_t(size.x) * std::size_t(size.y));
    std::array<Texel, fineSide * fineSide> parts;
    const auto count = std::size_t(side) * std::size_t(side);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            for (int i = 0; i < side * side; ++i)
                parts[std::size_t(i)] =
                    fine[std::size_t(y * side + i / side) * std::size_t(size.x * side) +
                         std::size_t(x * side + i % side)];
            pixels.push_back(combine(std::span<const Texel>(parts).first(count)));
        }
    return pixels;
}

/// Mean colour, and the depth of the wall where there is any.
glm::vec4 meanWall(std::span<const glm::vec4> parts) {
    glm::vec4 mean(0.0f, 0.0f, 0.0f, background.w);
    for (const glm::vec4& part : parts)
        mean = glm::vec4(glm::vec3(mean) + glm::vec3(part) / float(parts.size()),
                         std::min(mean.w, part.w));
    return mean;
}

/// Mean colour as displayed, multiplied by how much of the pixel shows it.
glm::vec4 meanMark(std::span<const glm::u8vec4> parts) {
    glm::vec4 sum(0.0f);
    for (const glm::u8vec4 part : parts) {
        const glm::vec4 mark = glm::vec4(part) / 255.0f;
        sum += glm::vec4(mark.w * glm::vec3(mark), mark.w) / float(parts.size());
    }
    return sum;
}

}  // namespace

Result<std::unique_ptr<OverviewPainter>> OverviewPainter::create(
    gpu::Context& context, std::shared_ptr<const Scene> scene) {
    using gpu::RasterProgram, gpu::StorageBuffer, shaders::shaderSource;
    const auto structs = shaderSource("uniforms.h"), own = shaderSource("overview_uniforms.h"),
               curve = shaderSource("srgb.glsl"), shared = shaderSource("overview.glsl"),
               vertex = shaderSource("overview.vert");
    auto wall =
        TRY(RasterProgram::create("overview_wall", {structs, own, vertex},
                                  {structs, own, shared, shaderSource("overview_wall.frag")}));
    auto marks = TRY(
        RasterProgram::create("overview_marks", {structs, own, vertex},
                              {structs, own, curve, shared, shaderSource("overview_marks.frag")}));
    auto block = TRY(gpu::UniformBuffer::create(sizeof(shaders::OverviewUniforms)));
    std::unique_ptr<OverviewPainter> painter(new OverviewPainter(
        context, std::move(scene), std::move(wall), std::move(marks), std::move(block)));
    const TriMesh* mesh = painter->scene_->wall.get();
    if (mesh && !mesh->triangles.empty()) {
        const OverviewShapes shape = wallShape(*mesh, painter->originMm_);
        auto vertices =
            TRY(StorageBuffer::create(std::span(shape.vertices), "the wall's vertices"));
        auto triangles =
            TRY(StorageBuffer::create(std::span(shape.indices), "the wall's triangles"));
        painter->wallVertices_ = std::move(vertices);
        painter->wallTriangles_ = std::move(triangles);
    }
    return painter;
}

OverviewPainter::OverviewPainter(gpu::Context& context, std::shared_ptr<const Scene> scene,
                                 gpu::RasterProgram wall, gpu::RasterProgram marks,
                                 gpu::UniformBuffer block)
    : context_(context),
      scene_(std::move(scene)),
      originMm_(scene_->grid().patientFromVoxelPoint(0.5 * glm::dvec3(scene_->grid().size - 1))),
      wall_(std::move(wall)),
      marks_(std::move(marks)),
      block_(std::move(block)) {}

bool OverviewPainter::shows(const OverviewView& view, glm::ivec2 size) const {
    if (!ground_ || glm::ivec2(ground_->picture.width, ground_->picture.height) != size)
        return false;
    const OverviewView& last = ground_->view;
    if (!(last.camera == view.camera) || last.body != view.body) return false;
    return !view.body || (last.optics == view.optics && last.march == view.march);
}

Result<void> OverviewPainter::makeTargets(glm::ivec2 size) {
    const int side = std::int64_t(size.x) * size.y <= finePixels ? fineSide : 1;
    if (wallTarget_ && wallTarget_->size() == side * size) return {};
    using gpu::TexelFormat;
    auto wall =
        TRY(gpu::RasterTarget::create(side * size, TexelFormat::rgba32f, "wall from outside"));
    auto marks =
        TRY(gpu::RasterTarget::create(side * size, TexelFormat::rgba8, "marks on the overview"));
    wallTarget_ = std::move(wall);
    marksTarget_ = std::move(marks);
    inTarget_.reset();
    return {};
}

void OverviewPainter::rasterizeWall(const Sight& sight) {
    block_.bind(shaders::uniformBinding);
    if (inTarget_ == sight) return;
    wallTarget_->clear(background);
    if (wallTriangles_) {
        wallVertices_->bind(shaders::overviewVertexBinding);
        wall_.drawNearest(*wallTarget_, *wallTriangles_, 0, int(scene_->wall->triangles.size()));
    }
    inTarget_ = sight;
}

std::shared_ptr<const Backdrop> OverviewPainter::wallOf(const Sight& sight) {
    if (const Wall* known = walls_.find([&](const Wall& wall) { return wall.sight == sight; }))
        return known->backdrop;
    rasterizeWall(sight);
    auto backdrop = std::make_shared<Backdrop>();
    backdrop->size = sight.size;
    backdrop->pixels = reduced(read<glm::vec4>(*wallTarget_), sight.size,
                               wallTarget_->size().x / sight.size.x, meanWall);
    return walls_.keep({sight, std::move(backdrop)})->backdrop;
}

Result<void> OverviewPainter::drawGround(const OverviewView& view, const Band& band,
                                         Raycaster& raycaster, Image& picture) {
    const std::size_t row = 3 * std::size_t(band.pictureSize.x);
    const std::size_t begin = row * std::size_t(band.firstRow),
                      bytes = row * std::size_t(band.rows);
    if (shows(view, band.pictureSize) && ground_->rows >= band.firstRow + band.rows) {
        std::copy_n(&ground_->picture.rgb[begin], bytes, &picture.rgb[begin]);
        return {};
    }
    auto wall = wallOf({view.camera, band.pictureSize});
    if (!view.body) {
        for (std::size_t i = begin; i < begin + bytes; ++i)
            picture.rgb[i] = byteOf(displayed(double(wall->pixels[i / 3][int(i % 3)])));
    } else
        TRY(raycaster.render({view.camera, view.optics, view.march, std::move(wall)}, band,
                             picture));
    // Rows that follow on are kept, so that one picture after the other needs none of them again.
    if (band.firstRow == 0) ground_ = Ground{view, {picture.width, picture.height, {}}, 0};
    if (shows(view, band.pictureSize) && ground_->rows == band.firstRow) {
        ground_->picture.rgb.resize(picture.rgb.size());
        std::copy_n(&picture.rgb[begin], bytes, &ground_->picture.rgb[begin]);
        ground_->rows += band.rows;
    }
    return {};
}

Result<void> OverviewPainter::addMarks(const OverviewView& view, Image& picture) {
    const OverviewShapes shapes = markShapes(view, scene_->path.get(), originMm_);
    if (shapes.indices.empty()) return {};
    auto vertices = TRY(gpu::StorageBuffer::create(std::span(shapes.vertices), "marks' vertices"));
    auto triangles = TRY(gpu::StorageBuffer::create(std::span(shapes.indices), "marks' triangles"));
    rasterizeWall({view.camera, {picture.width, picture.height}});  // marks fade behind it
    marksTarget_->clear(glm::vec4(0.0f));
    vertices.bind(shaders::overviewVertexBinding);
    wallTarget_->texture().bind(shaders::overviewWallUnit);
    marks_.drawNearest(*marksTarget_, triangles, 0, int(shapes.indices.size() / 3));

    const glm::ivec2 size(picture.width, picture.height);
    const auto marks =
        reduced(read<glm::u8vec4>(*marksTarget_), size, marksTarget_->size().x / size.x, meanMark);
    for (std::size_t i = 0; i < marks.size(); ++i) {
        const double shown = marks[i].w;
        if (shown <= 0.0) continue;
        for (int channel = 0; channel < 3; ++channel) {
            std::uint8_t& byte = picture.rgb[3 * i + std::size_t(channel)];
            byte = byteOf((1.0 - shown) * byte / 255.0 + double(marks[i][channel]));
        }
    }
    return {};
}

Result<void> OverviewPainter::draw(const OverviewView& view, const Band& band, Raycaster& raycaster,
                                   Image& picture) {
    const int errorsBefore = context_.errorCount();
    TRY(checkBand(band, picture));
    TRY(checkOverview(view));
    TRY(makeTargets(band.pictureSize));
    block_.write(uniformsOf(view, *scene_, originMm_, band.pictureSize));
    auto drawn = drawGround(view, band, raycaster, picture);
    if (drawn && band.firstRow + band.rows == band.pictureSize.y) drawn = addMarks(view, picture);
    if (drawn && context_.errorCount() != errorsBefore)
        drawn = fail(ErrorKind::device, "the graphics driver reported an error", "overview");
    if (!drawn) {
        ground_.reset();
        walls_.clear();
        inTarget_.reset();
    }
    return drawn;
}

std::size_t OverviewPainter::gpuBytes() const {
    std::size_t bytes = 0;
    for (const auto* buffer : {&wallVertices_, &wallTriangles_})
        if (*buffer) bytes += (*buffer)->bytes();
    for (const auto* target : {&wallTarget_, &marksTarget_})
        if (*target) bytes += (*target)->bytes();
    return bytes;
}

}  // namespace haustra::render
