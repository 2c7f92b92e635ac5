#include "render/case_renderer.h"

#include "render/gl/gl_pictures.h"
#include "render/gl/single_pass_raycaster.h"
#include "render/hybrid/hybrid_raycaster.h"
#include "render/native/native_pictures.h"
#include "render/native/native_raycaster.h"
#include "render/object_order/object_order_raycaster.h"
#include "render/overview/overview_painter.h"
#include "render/polygon_assisted/polygon_assisted_raycaster.h"
#include "render/scene/beneath_wall.h"
#include "render/scene/case_pictures.h"
#include "render/scene/lru_cache.h"
#include "render/wall/wall_index.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace haustra::render {

namespace {

/// Copies what was drawn to its place in the picture.
Result<void> put(const Result<Image>& drawn, glm::ivec2 corner, Image& picture) {
    if (!drawn) return tl::make_unexpected(drawn.error());
    const std::size_t row = 3 * std::size_t(drawn->width), rows = std::size_t(drawn->height);
    std::uint8_t* to =
        &picture
             .rgb[3 * (std::size_t(corner.y) * std::size_t(picture.width) + std::size_t(corner.x))];
    for (std::size_t y = 0; y < rows; ++y, to += 3 * std::size_t(picture.width))
        std::copy_n(&drawn->rgb[row * y], row, to);
    return {};
}

template <class T>
Result<std::unique_ptr<Raycaster>> asRaycaster(Result<std::unique_ptr<T>> made) {
    return std::unique_ptr<Raycaster>(TRY(std::move(made)));
}

/// Whether slices and flattened views are drawn on the CPU too: so that nothing asks for a copy of
/// the whole volume on the GPU.
bool picturesOnCpu(RaycasterKind kind) {
    return !raycasterEntry(kind).needsWholeVolume();
}

}  // namespace

struct CaseRenderer::Impl {
    gpu::Context& context;
    RendererOptions options;
    Volume<std::int16_t> ct;             // for slices
    std::shared_ptr<const Scene> scene;  // what the endoscopic and the flattened views show
    bool hasCleansed;
    std::shared_ptr<const FlatGeometry> flatGeometry;  // where the case has a flat map
    RaycasterKind used = RaycasterKind::singlePass;
    // The rest is made when it is asked for, and kept: a machine without a GPU needs no copy of the
    // volume for one.
    std::shared_ptr<GlScene> glScene = nullptr;
    std::shared_ptr<NativeScene> nativeScene = nullptr;
    std::shared_ptr<const FlatSurface> flatSurface = nullptr;
    std::map<RaycasterKind, std::unique_ptr<Raycaster>> raycasters = {};
    std::unique_ptr<CasePictures> glPictures = nullptr, nativePictures = nullptr;
    std::unique_ptr<OverviewPainter> overview = nullptr;
    std::optional<WallIndex> wallIndex = std::nullopt;
    // Of whole pictures: one serves all bands of a picture, and the next paint over it.
    struct SeenWall {
        Camera camera;
        glm::ivec2 size{0};
        std::vector<WallPixel> pixels;
    };
    LruCache<SeenWall> seenWalls{4};

    const Grid& grid() const { return scene->grid(); }
    CasePictures& pictures() { return picturesOnCpu(used) ? *nativePictures : *glPictures; }

    Result<void> makeFlatSurface() {
        if (flatSurface) return {};
        auto made = TRY(FlatSurface::upload(flatGeometry));
        flatSurface = std::make_shared<const FlatSurface>(std::move(made));
        return {};
    }

    Result<void> makePictures(RaycasterKind kind) {
        std::unique_ptr<CasePictures>& kept = picturesOnCpu(kind) ? nativePictures : glPictures;
        if (kept) return {};
        const auto keep = [&](auto made) -> Result<void> {
            kept = TRY(std::move(made));
            return {};
        };
        if (picturesOnCpu(kind)) {
            nativeScene = std::make_shared<NativeScene>(scene, options.threads);
            return keep(NativePictures::create(nativeScene, ct.share(), flatGeometry));
        }
        TRY(checkScanSide(grid(), std::min(maxScanSide, gpu::maxTextureSide3d())));
        auto made =
            TRY(GlScene::upload(context, scene, options.threads, options.gradientBudgetBytes));
        glScene = std::move(made);
        if (flatGeometry) TRY(makeFlatSurface());
        return keep(GlPictures::create(glScene, ct, flatSurface, options.threads));
    }

    Result<std::unique_ptr<Raycaster>> makeRaycaster(RaycasterKind kind) {
        switch (kind) {
            case RaycasterKind::native:
                return std::make_unique<NativeRaycaster>(nativeScene);
            case RaycasterKind::singlePass:
                return asRaycaster(SinglePassRaycaster::create(glScene));
            case RaycasterKind::polygonAssisted:
                return asRaycaster(PolygonAssistedRaycaster::create(glScene, options.threads));
            case RaycasterKind::objectOrder:
                return asRaycaster(ObjectOrderRaycaster::create(
                    context, scene,
                    {.budgetBytes = options.gpuBudgetBytes, .threads = options.threads}));
            case RaycasterKind::hybrid:
                return asRaycaster(HybridRaycaster::create(glScene, {.threads = options.threads}));
        }
        std::abort();  // no such kind
    }

    template <class View>
    Result<void> drawSlice(const SlicePlacement& placement, const View& view, const Band& band,
                           Image& picture) {
        if (view.scan == Scan::cleansed && !hasCleansed)
            return fail(ErrorKind::badInput, "the case has no cleansed scan", "slice");
        return put(pictures().slice({placement, view.window, view.scan, view.slab}, band),
                   {0, band.firstRow}, picture);
    }

    Result<void> checkPaint(const WallPaint* paint) const {
        if (!paint) return {};
        TRY(checkWallPaint(*paint));
        if (!flatGeometry)
            return fail(ErrorKind::badInput, "the case has no flat map", "wall paint");
        return {};
    }

    Result<std::vector<WallPixel>> findWall(const Camera& camera, const Band& band) {
        if (!wallIndex) {
            auto made = TRY(WallIndex::create());
            wallIndex = std::move(made);
        }
        TRY(makeFlatSurface());
        return wallIndex->find(context, *flatSurface, camera, band);
    }

    /// Of the whole picture; valid until the next call.
    Result<const SeenWall*> wallOf(const Camera& camera, glm::ivec2 size) {
        const SeenWall* seen = seenWalls.find(
            [&](const SeenWall& kept) { return kept.camera == camera && kept.size == size; });
        if (seen) return seen;
        auto found = TRY(findWall(camera, Band::whole(size.x, size.y)));
        return seenWalls.keep({camera, size, std::move(found)});
    }

    Result<std::shared_ptr<const Backdrop>> endsOf(const CameraView& view, const Band& band) {
        const SeenWall* seen = TRY(wallOf(view.camera, band.pictureSize));
        const std::size_t row = std::size_t(band.pictureSize.x);
        std::vector<float> depths;
        depths.reserve(row * std::size_t(band.rows));
        for (const WallPixel& pixel :
             std::span(seen->pixels)
                 .subspan(row * std::size_t(band.firstRow), row * std::size_t(band.rows)))
            depths.push_back(pixel.depthMm);
        return endsBeneathWall(*scene, view.camera, band, depths, view.beneathWallMm,
                               options.threads);
    }

    /// Tints the band of a camera's picture.
    Result<void> paintWall(const Camera& camera, const WallPaint& paint, const Band& band,
                           Image& picture) {
        const glm::ivec2 size = band.pictureSize;
        const SeenWall* seen = TRY(wallOf(camera, size));
        const std::size_t row = std::size_t(size.x);
        const std::span pixels(seen->pixels);
        tint(pixels.subspan(row * std::size_t(band.firstRow), row * std::size_t(band.rows)), paint,
             band, picture, options.threads);
        return {};
    }

    Result<Image> drawFlat(const FlatView& view, const Band& band) {
        Result<Image> rows = pictures().flat(view, band);
        if (rows && view.paint) tint(view.window, *view.paint, band, *rows, options.threads);
        return rows;
    }

    Result<void> checkFlat() const {
        if (flatGeometry && !scene->ranges.lowHu.empty()) return {};
        return fail(
            ErrorKind::badInput,
            flatGeometry ? "so large a scan has no flattened views" : "the case has no flat map",
            "flattened view");
    }
};

Result<std::unique_ptr<CaseRenderer>> CaseRenderer::create(gpu::Context& context,
                                                           const Volume<std::int16_t>& ct,
                                                           const Volume<std::int16_t>& cleansed,
                                                           RendererOptions options) {
    auto prepared = TRY(prepareCase(ct, cleansed, options.threads));
    return upload(context, std::move(prepared), options);
}

Result<std::unique_ptr<CaseRenderer>> CaseRenderer::upload(gpu::Context& context,
                                                           PreparedCase prepared,
                                                           RendererOptions options) {
    const Grid grid = prepared.ct.grid();
    const int errorsBefore = context.errorCount();
    auto scene = std::make_shared<const Scene>(Scene{prepared.endoscopic().share(),
                                                     std::move(prepared.ranges), prepared.wall,
                                                     prepared.flatMap, prepared.path});
    std::shared_ptr<const FlatGeometry> flatGeometry;
    if (scene->flatMap) {
        auto geometry = TRY(FlatGeometry::of(*scene->flatMap, grid));
        flatGeometry = std::move(geometry);
    }
    std::unique_ptr<CaseRenderer> renderer(new CaseRenderer(std::unique_ptr<Impl>(
        new Impl{context, options, std::move(prepared.ct), std::move(scene),
                 !prepared.cleansed.empty(), std::move(flatGeometry), options.raycaster})));
    TRY(renderer->use(options.raycaster));
    if (context.errorCount() != errorsBefore)
        return fail(ErrorKind::device, "the graphics driver reported an error", "render");
    return renderer;
}

CaseRenderer::CaseRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CaseRenderer::~CaseRenderer() = default;

RaycasterKind CaseRenderer::raycaster() const {
    return impl_->used;
}

Result<void> CaseRenderer::use(RaycasterKind kind) {
    Impl& my = *impl_;
    if (!my.raycasters.contains(kind)) {
        if (my.scene->ranges.lowHu.empty() && raycasterEntry(kind).volume != VolumeOnGpu::cells)
            return fail(ErrorKind::device, "only the object-order raycaster draws so large a scan",
                        "render");
        TRY(my.makePictures(kind));
        auto made = TRY(my.makeRaycaster(kind));
        my.raycasters[kind] = std::move(made);
    }
    my.used = kind;
    return {};
}

void CaseRenderer::keepOnlyUsed() {
    Impl& my = *impl_;
    std::erase_if(my.raycasters, [&](const auto& made) { return made.first != my.used; });
    if (picturesOnCpu(my.used)) {
        my.glPictures.reset();
        my.glScene.reset();
        if (!my.wallIndex) my.flatSurface.reset();
    } else {
        my.nativePictures.reset();
        my.nativeScene.reset();
    }
}

std::vector<PassTime> CaseRenderer::passTimes() const {
    return impl_->raycasters.at(impl_->used)->passTimes();
}

Result<void> CaseRenderer::render(const CameraView& view, const Band& band, Image& picture) {
    Impl& my = *impl_;
    TRY(my.checkPaint(view.paint.get()));
    CameraView drawn = view;
    if (view.beneathWallMm > 0.0 && my.flatGeometry) {
        TRY(checkBand(band, picture));
        TRY(checkCamera(view.camera));
        drawn.backdrop = TRY(my.endsOf(view, band));
    }
    TRY(my.raycasters.at(my.used)->render(drawn, band, picture));
    return view.paint ? my.paintWall(view.camera, *view.paint, band, picture) : Result<void>{};
}

Result<std::vector<WallPixel>> CaseRenderer::wallSeen(const Camera& camera, const Band& band) {
    Impl& my = *impl_;
    TRY(checkCamera(camera));
    TRY(checkBand(band));
    if (!my.flatGeometry)
        return fail(ErrorKind::badInput, "the case has no flat map", "wall index");
    return my.findWall(camera, band);
}

Result<void> CaseRenderer::render(const SliceView& view, const Band& band, Image& picture) {
    TRY(checkBand(band, picture));
    const auto placement =
        TRY(placeSlice(view, impl_->grid(), band.pictureSize.x, band.pictureSize.y));
    return impl_->drawSlice(placement, view, band, picture);
}

Result<void> CaseRenderer::render(const ObliqueView& view, const Band& band, Image& picture) {
    TRY(checkBand(band, picture));
    const auto placement = TRY(placeSlice(view, band.pictureSize.x, band.pictureSize.y));
    return impl_->drawSlice(placement, view, band, picture);
}

Result<void> CaseRenderer::render(const FlatView& view, const Band& band, Image& picture) {
    TRY(checkBand(band, picture));
    TRY(checkFlatWindow(view.window, band.pictureSize.x));
    TRY(impl_->checkFlat());
    TRY(impl_->checkPaint(view.paint.get()));
    return put(impl_->drawFlat(view, band), {0, band.firstRow}, picture);
}

Result<void> CaseRenderer::render(const FlatOverview& view, const Band& band, Image& picture) {
    Impl& my = *impl_;
    TRY(checkBand(band, picture));
    TRY(my.checkFlat());
    TRY(my.checkPaint(view.paint.get()));
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    (void)put(blankImage(size), {0, band.firstRow}, picture);  // the gutters
    for (const StripColumn& column :
         layOutStrip(my.flatGeometry->height(), band.pictureSize).columns) {
        const FlatView part{column.window, view.optics, view.march, view.paint};
        const Band rows{column.size, band.firstRow, band.rows};
        TRY(put(my.drawFlat(part, rows), {column.left, band.firstRow}, picture));
    }
    return {};
}

Result<void> CaseRenderer::render(const OverviewView& view, const Band& band, Image& picture) {
    Impl& my = *impl_;
    TRY(my.checkPaint(view.paint.get()));
    if (!my.overview) {
        auto made = TRY(OverviewPainter::create(my.context, my.scene));
        my.overview = std::move(made);
    }
    TRY(my.overview->draw(view, band, *my.raycasters.at(my.used), picture));
    return view.paint ? my.paintWall(view.camera, *view.paint, band, picture) : Result<void>{};
}

CaseGpuBytes CaseRenderer::gpuBytesFor(const PreparedCase& prepared) {
    const bool two = !prepared.cleansed.empty() &&
                     prepared.cleansed.voxels().data() != prepared.ct.voxels().data();
    CaseGpuBytes bytes;
    bytes.volumes = prepared.ct.grid().voxelCount() * sizeof(std::int16_t) * (two ? 2 : 1);
    bytes.rest = GlScene::classificationsKept * prepared.ranges.lowHu.size();
    // The wall twice: from within, moved inwards, and from outside, with normals.
    if (const auto& wall = prepared.wall)
        bytes.rest +=
            (sizeof(glm::vec4) + sizeof(shaders::OverviewVertex)) * wall->vertices.size() +
            2 * sizeof(glm::ivec3) * wall->triangles.size();
    if (const auto& map = prepared.flatMap)
        bytes.rest += sizeof(shaders::FlatVertex) * map->flat.size() +
                      sizeof(glm::ivec3) * map->surface.triangles.size() +
                      sizeof(shaders::FlatEye) * map->cameras.size();
    return bytes;
}

std::size_t CaseRenderer::gpuBytes() const {
    const Impl& my = *impl_;
    std::size_t bytes = my.glScene ? my.glScene->gpuBytes() : 0;
    if (my.glPictures) bytes += my.glPictures->gpuBytes();
    if (my.flatSurface) bytes += my.flatSurface->gpuBytes();
    if (my.overview) bytes += my.overview->gpuBytes();
    if (my.wallIndex) bytes += my.wallIndex->gpuBytes();
    for (const auto& [kind, raycaster] : my.raycasters)
        bytes += raycaster->gpuBytes();
    return bytes;
}

}  // namespace haustra::render
