#include "render/polygon_assisted/polygon_assisted_raycaster.h"

#include "render/scene/ray_setup.h"
#include "render/wall/wall_projection.h"
#include "shaders/shader_source.h"

#include <algorithm>
#include <span>
#include <utility>

namespace haustra::render {

namespace {

/// With more, their faces cost more than the rays that they shorten.
constexpr std::size_t mostBlocksBefore = 100000;

Result<void> checkWall(const Scene& scene) {
    const auto bad = [](const char* what) { return fail(ErrorKind::badInput, what, "wall"); };
    if (!scene.wall) return bad("the case has no mesh of the wall");
    const int count = int(scene.wall->vertices.size());
    for (const glm::ivec3& t : scene.wall->triangles)
        if (std::min({t.x, t.y, t.z}) < 0 || std::max({t.x, t.y, t.z}) >= count)
            return bad("has triangles of vertices that it has not");
    if (scene.wall->triangles.empty() || !meshTopology(*scene.wall).closed())
        return bad("the mesh is not closed");
    return {};
}

}  // namespace

Result<std::unique_ptr<PolygonAssistedRaycaster>> PolygonAssistedRaycaster::create(
    std::shared_ptr<GlScene> scene, int threads) {
    using shaders::shaderSource;
    TRY(checkWall(scene->scene()));
    auto rays = TRY(SinglePassRaycaster::create(scene));
    const auto structs = shaderSource("uniforms.h"), own = shaderSource("wall_uniforms.h"),
               lens = shaderSource("lens.glsl"), wall = shaderSource("wall.glsl");
    auto entry = TRY(gpu::RasterProgram::create(
        "wall_entry", {structs, own, lens, wall, shaderSource("wall_entry.vert")},
        {structs, own, lens, wall, shaderSource("wall_entry.frag")}));
    auto block = TRY(gpu::UniformBuffer::create(sizeof(shaders::WallUniforms)));
    WallEntry around(scene->scene());
    auto mesh = TRY(upload(around.wall()));
    return std::unique_ptr<PolygonAssistedRaycaster>(
        new PolygonAssistedRaycaster(std::move(scene), threads, std::move(rays), std::move(entry),
                                     std::move(block), std::move(around), std::move(mesh)));
}

PolygonAssistedRaycaster::PolygonAssistedRaycaster(std::shared_ptr<GlScene> scene, int threads,
                                                   std::unique_ptr<SinglePassRaycaster> rays,
                                                   gpu::RasterProgram entry,
                                                   gpu::UniformBuffer block, WallEntry wall,
                                                   Mesh mesh)
    : scene_(std::move(scene)),
      threads_(threads),
      rays_(std::move(rays)),
      entry_(std::move(entry)),
      block_(std::move(block)),
      wall_(std::move(wall)),
      mesh_(std::move(mesh)) {}

Result<PolygonAssistedRaycaster::Mesh> PolygonAssistedRaycaster::upload(
    const EntryTriangles& triangles) {
    using gpu::StorageBuffer;
    auto places = TRY(StorageBuffer::create(std::span<const glm::vec4>(triangles.places), "wall"));
    auto indices =
        TRY(StorageBuffer::create(std::span<const glm::ivec3>(triangles.triangles), "wall"));
    return Mesh{std::move(places), std::move(indices), int(triangles.triangles.size())};
}

Result<const PolygonAssistedRaycaster::Before*> PolygonAssistedRaycaster::findBefore(
    const Optics& optics, double stepMm, const TransferTable& table) {
    if (const Before* known = before_.find(
            [&](const Before& one) { return one.stepMm == stepMm && one.optics == optics; }))
        return known;
    before_.makeRoom();
    ++searches_;
    Before before;
    before.optics = optics;
    before.stepMm = stepMm;
    before.visible = wall_.visibleBefore(scene_->scene().ranges, table, threads_);
    before.count =
        std::size_t(std::count(before.visible.begin(), before.visible.end(), std::uint8_t(1)));
    before.tooMany = before.count > mostBlocksBefore;
    if (before.count > 0 && !before.tooMany) {
        const EntryTriangles faces = wall_.faces(before.visible);
        if (!faces.triangles.empty()) {
            auto uploaded = TRY(upload(faces));
            before.faces = std::move(uploaded);
        }
    }
    return before_.keep(std::move(before));
}

bool PolygonAssistedRaycaster::mayBeginAtMesh(const CameraView& view, const Before& before) const {
    // Not every ray of an orthographic camera begins where the camera is.
    return view.march.emptySpaceLeaping && view.camera.lens == Lens::perspective &&
           !before.tooMany && wall_.isClear(view.camera.positionMm, before.visible);
}

Result<void> PolygonAssistedRaycaster::drawEntry(const CameraView& view, const Band& band,
                                                 double stepMm, const Before& before) {
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    if (!firstStep_ || firstStep_->size() != size) {
        auto made =
            TRY(gpu::RasterTarget::create(size, gpu::TexelFormat::r32f, "rays' beginnings"));
        firstStep_ = std::move(made);
    }
    const Grid& grid = scene_->scene().grid();
    shaders::WallUniforms u = wallProjection(
        view.camera, band, grid.patientFromVoxelPoint(0.5 * glm::dvec3(grid.size) - 0.5));
    u.stepsPerMm = float(1.0 / stepMm);
    block_.write(u);
    block_.bind(shaders::wallUniformBinding);
    firstStep_->clear(glm::vec4(0.0f));
    const auto draw = [&](const Mesh& mesh) {
        mesh.places.bind(shaders::wallVertexBinding);
        entry_.drawNearest(*firstStep_, mesh.triangles, 0, mesh.count);
    };
    draw(mesh_);
    if (before.faces) draw(*before.faces);
    return {};
}

Result<void> PolygonAssistedRaycaster::render(const CameraView& view, const Band& band,
                                              Image& picture) {
    TRY(checkBand(band, picture));
    TRY(checkCameraView(view, band.pictureSize));
    timestamps_.restart();
    timestamps_.mark();
    const auto classified = TRY(scene_->classification(view.optics, view.march));
    const double step = stepMm(view.march, scene_->scene().grid());
    const auto before = TRY(findBefore(view.optics, step, classified->table()));
    blocksBefore_ = before->count;
    beganAtMesh_ = mayBeginAtMesh(view, *before);
    if (!beganAtMesh_) return rays_->render(view, band, picture);
    TRY(drawEntry(view, band, step, *before));
    timestamps_.mark();
    return rays_->renderFrom(firstStep_->texture(), view, band, picture);
}

std::vector<PassTime> PolygonAssistedRaycaster::passTimes() const {
    std::vector<PassTime> times = rays_->passTimes();
    if (const std::vector<double> ms = timestamps_.betweenMs(); beganAtMesh_ && ms.size() == 1)
        times.insert(times.begin(), {"mesh", ms.front()});
    return times;
}

std::size_t PolygonAssistedRaycaster::gpuBytes() const {
    std::size_t bytes = mesh_.places.bytes() + mesh_.triangles.bytes() + rays_->gpuBytes();
    for (const Before& one : before_.all())
        if (one.faces) bytes += one.faces->places.bytes() + one.faces->triangles.bytes();
    if (firstStep_) bytes += firstStep_->bytes();
    return bytes;
}

}  // namespace haustra::render
