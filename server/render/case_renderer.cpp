#include "render/case_renderer.h"

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "render/flat_painter.h"
#include "render/gl_scene.h"
#include "render/object_order/object_order_raycaster.h"
#include "render/overview_painter.h"
#include "render/picture_readback.h"
#include "render/polygon_assisted_raycaster.h"
#include "render/ray_setup.h"
#include "render/single_pass_raycaster.h"
#include "render/stored_value.h"
#include "render/wall_index.h"
#include "shaders/shader_source.h"
#include "shaders/uniforms.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace haustra::render {

namespace {

using shaders::shaderSource;
using shaders::SliceUniforms;

Image blank(int width, int height) {
    return {width, height, std::vector<std::uint8_t>(3u * unsigned(width) * unsigned(height))};
}

template <class T>
Result<std::unique_ptr<Raycaster>> asRaycaster(Result<std::unique_ptr<T>> made) {
    if (!made) return tl::make_unexpected(made.error());
    return std::unique_ptr<Raycaster>(std::move(*made));
}

}  // namespace

struct CaseRenderer::Impl {
    gpu::Context& context;
    RendererOptions options;
    std::shared_ptr<const Scene> scene;  // what the endoscopic and the flattened views show
    std::shared_ptr<GlScene> glScene;
    std::optional<gpu::Texture> ct;  // for slices, where cleansing has changed it
    bool hasCleansed;
    gpu::ComputeProgram slice;
    gpu::UniformBuffer sliceBlock;
    std::optional<FlatPainter> flat;  // where the case has a flat map
    std::map<RaycasterKind, std::unique_ptr<Raycaster>> raycasters;  // made when asked for
    RaycasterKind used = RaycasterKind::singlePass;
    std::optional<gpu::Texture> picture;
    std::unique_ptr<OverviewPainter> overview = nullptr;  // made when asked for
    std::optional<WallIndex> wallIndex = std::nullopt;    // made when asked for

    const Grid& grid() const { return scene->grid(); }

    Result<std::unique_ptr<Raycaster>> makeRaycaster(RaycasterKind kind) {
        switch (kind) {
            case RaycasterKind::singlePass:
                return asRaycaster(SinglePassRaycaster::create(glScene));
            case RaycasterKind::polygonAssisted:
                return asRaycaster(PolygonAssistedRaycaster::create(glScene, options.threads));
            case RaycasterKind::objectOrder:
                return asRaycaster(ObjectOrderRaycaster::create(
                    context, scene,
                    {.budgetBytes = options.gpuBudgetBytes, .threads = options.threads}));
            default:
                return fail(ErrorKind::device,
                            std::string("no ") + toString(kind) + " raycaster is built in");
        }
    }

    Result<void> makePicture(glm::ivec2 size) {
        if (picture && glm::ivec2(picture->size()) == size) return {};
        using gpu::Filter, gpu::Texture, gpu::TexelFormat;
        Result<Texture> made =
            Texture::create(2, {size, 1}, TexelFormat::rgba8, Filter::nearest, "picture");
        if (!made) return tl::make_unexpected(made.error());
        picture = std::move(*made);
        return {};
    }

    Result<Image> readPicture(int errorsBefore) {
        Image image = blank(picture->size().x, picture->size().y);
        if (auto read = readBack(context, *picture, errorsBefore, 0, image); !read)
            return tl::make_unexpected(read.error());
        return image;
    }

    Result<Image> drawFlat(const FlatWindow& window, const Optics& optics,
                           const MarchOptions& march, glm::ivec2 size) {
        const int errorsBefore = context.errorCount();
        const auto classified = glScene->classification(optics, march);
        if (!classified) return tl::make_unexpected(classified.error());
        if (auto made = makePicture(size); !made) return tl::make_unexpected(made.error());
        glScene->bind(
            marchUniforms(optics, march, grid(), (*classified)->table(), scene->ranges.size, size),
            **classified);
        if (auto found = flat->findTriangles(window, size); !found)
            return tl::make_unexpected(found.error());
        const MarchVariant variant = MarchVariant::of(optics, false, false);
        if (auto cast = flat->castRays(variant, stepMm(march, grid()), *picture); !cast)
            return tl::make_unexpected(cast.error());
        return readPicture(errorsBefore);
    }

    Result<Image> drawSlice(const SlicePlacement& placement, const WindowLevel& window, Scan scan,
                            glm::ivec2 size) {
        const int errorsBefore = context.errorCount();
        const bool cleansed = scan == Scan::cleansed;
        if (cleansed && !hasCleansed)
            return fail(ErrorKind::badInput, "the case has no cleansed scan", "slice");
        if (auto made = makePicture(size); !made) return tl::make_unexpected(made.error());

        const glm::dmat4 voxelFromPatient = grid().voxelFromPatient();
        const glm::dvec3 voxels(grid().size);
        const auto textureVector = [&](glm::dvec3 mm) {
            return glm::dvec3(voxelFromPatient * glm::dvec4(mm, 0.0)) / voxels;
        };
        SliceUniforms u{};
        u.originTexture = glm::vec4(
            (glm::dvec3(voxelFromPatient * glm::dvec4(placement.topLeftMm, 1.0)) + 0.5) / voxels,
            0.0);
        u.rightTexture = glm::vec4(textureVector(placement.rightMm), 0.0);
        u.downTexture = glm::vec4(textureVector(placement.downMm), 0.0);
        u.window = glm::vec4(storedRange / window.widthHu,
                             0.5 - (storedOffset + window.centerHu) / window.widthHu, 0, 0);
        u.pictureSize = glm::ivec4(size, 0, 0);
        sliceBlock.write(u);
        sliceBlock.bind(shaders::uniformBinding);
        (!cleansed && ct ? *ct : glScene->volume()).bind(shaders::volumeUnit);
        picture->bindImage(shaders::pictureImage);
        slice.dispatch(size);
        return readPicture(errorsBefore);
    }

    Result<void> checkFlat() const {
        if (flat) return {};
        return fail(ErrorKind::badInput, "the case has no flat map", "flattened view");
    }
};

Result<std::unique_ptr<CaseRenderer>> CaseRenderer::create(gpu::Context& context,
                                                           const Volume<std::int16_t>& ct,
                                                           const Volume<std::int16_t>& cleansed,
                                                           RendererOptions options) {
    Result<PreparedCase> prepared = prepareCase(ct, cleansed, options.threads);
    if (!prepared) return tl::make_unexpected(prepared.error());
    return upload(context, std::move(*prepared), options);
}

Result<std::unique_ptr<CaseRenderer>> CaseRenderer::upload(gpu::Context& context,
                                                           PreparedCase prepared,
                                                           RendererOptions options) {
    using gpu::ComputeProgram, gpu::Texture, gpu::UniformBuffer;
    const Grid grid = prepared.ct.grid();
    if (Result<void> fits = checkScanSide(grid, std::min(maxScanSide, gpu::maxTextureSide3d()));
        !fits)
        return tl::make_unexpected(fits.error());

    const int errorsBefore = context.errorCount();
    const bool hasCleansed = !prepared.cleansed.empty();
    std::optional<Texture> ct;
    if (hasCleansed && prepared.cleansed.voxels().data() != prepared.ct.voxels().data()) {
        Result<Texture> texture = uploadVolume(prepared.ct, options.threads, "scan on the GPU");
        if (!texture) return tl::make_unexpected(texture.error());
        ct = std::move(*texture);
    }
    auto scene = std::make_shared<const Scene>(Scene{prepared.endoscopic().share(),
                                                     std::move(prepared.ranges), prepared.wall,
                                                     prepared.flatMap, prepared.path});
    auto glScene = GlScene::upload(context, scene, options.threads);
    if (!glScene) return tl::make_unexpected(glScene.error());
    Result<ComputeProgram> slice = ComputeProgram::create(
        "slice.comp", {shaderSource("uniforms.h"), shaderSource("slice.comp")});
    if (!slice) return tl::make_unexpected(slice.error());
    Result<UniformBuffer> sliceBlock = UniformBuffer::create(sizeof(SliceUniforms));
    if (!sliceBlock) return tl::make_unexpected(sliceBlock.error());
    std::optional<FlatPainter> flat;
    if (scene->flatMap) {
        Result<FlatPainter> painter = FlatPainter::create(*scene->flatMap, grid);
        if (!painter) return tl::make_unexpected(painter.error());
        flat = std::move(*painter);
    }
    std::unique_ptr<CaseRenderer> renderer(
        new CaseRenderer(std::unique_ptr<Impl>(new Impl{context,
                                                        options,
                                                        std::move(scene),
                                                        std::move(*glScene),
                                                        std::move(ct),
                                                        hasCleansed,
                                                        std::move(*slice),
                                                        std::move(*sliceBlock),
                                                        std::move(flat),
                                                        {},
                                                        options.raycaster,
                                                        {}})));
    if (auto made = renderer->use(options.raycaster); !made)
        return tl::make_unexpected(made.error());
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
        auto made = my.makeRaycaster(kind);
        if (!made) return tl::make_unexpected(made.error());
        my.raycasters[kind] = std::move(*made);
    }
    my.used = kind;
    return {};
}

std::vector<PassTime> CaseRenderer::passTimes() const {
    return impl_->raycasters.at(impl_->used)->passTimes();
}

Result<void> CaseRenderer::render(const CameraView& view, const Band& band, Image& picture) {
    if (view.paint) {
        if (auto sound = checkWallPaint(*view.paint); !sound) return sound;
        if (!impl_->flat) return fail(ErrorKind::badInput, "the case has no flat map", "wall paint");
    }
    if (auto drawn = impl_->raycasters.at(impl_->used)->render(view, band, picture); !drawn)
        return drawn;
    if (!view.paint) return {};
    const auto seen = wallSeen(view.camera, band);
    if (!seen) return tl::make_unexpected(seen.error());
    tint(*seen, *view.paint, band, picture);
    return {};
}

Result<std::vector<WallPixel>> CaseRenderer::wallSeen(const Camera& camera, const Band& band) {
    Impl& my = *impl_;
    if (auto sound = checkCamera(camera); !sound) return tl::make_unexpected(sound.error());
    if (auto sound = checkBand(band); !sound) return tl::make_unexpected(sound.error());
    if (!my.flat) return fail(ErrorKind::badInput, "the case has no flat map", "wall index");
    if (!my.wallIndex) {
        auto made = WallIndex::create();
        if (!made) return tl::make_unexpected(made.error());
        my.wallIndex = std::move(*made);
    }
    return my.wallIndex->find(my.context, my.flat->surface(), camera, band);
}

Result<Image> CaseRenderer::render(const CameraView& view, int width, int height) {
    if (auto sound = checkPictureSize({width, height}); !sound)
        return tl::make_unexpected(sound.error());
    Image picture = blank(width, height);
    if (auto drawn = render(view, Band::whole(width, height), picture); !drawn)
        return tl::make_unexpected(drawn.error());
    return picture;
}

Result<Image> CaseRenderer::render(const SliceView& view, int width, int height) {
    if (auto sound = checkPictureSize({width, height}); !sound)
        return tl::make_unexpected(sound.error());
    const auto placement = placeSlice(view, impl_->grid(), width, height);
    if (!placement) return tl::make_unexpected(placement.error());
    return impl_->drawSlice(*placement, view.window, view.scan, {width, height});
}

Result<Image> CaseRenderer::render(const ObliqueView& view, int width, int height) {
    if (auto sound = checkPictureSize({width, height}); !sound)
        return tl::make_unexpected(sound.error());
    const auto placement = placeSlice(view, width, height);
    if (!placement) return tl::make_unexpected(placement.error());
    return impl_->drawSlice(*placement, view.window, view.scan, {width, height});
}

Result<Image> CaseRenderer::render(const FlatView& view, int width, int height) {
    if (Result<void> sound = checkPictureSize({width, height}); !sound)
        return tl::make_unexpected(sound.error());
    if (Result<void> sound = checkFlatWindow(view.window, width); !sound)
        return tl::make_unexpected(sound.error());
    if (Result<void> has = impl_->checkFlat(); !has) return tl::make_unexpected(has.error());
    return impl_->drawFlat(view.window, view.optics, view.march, {width, height});
}

Result<Image> CaseRenderer::render(const FlatOverview& view, int width, int height) {
    Impl& my = *impl_;
    if (Result<void> sound = checkPictureSize({width, height}); !sound)
        return tl::make_unexpected(sound.error());
    if (Result<void> has = my.checkFlat(); !has) return tl::make_unexpected(has.error());
    Image overview = blank(width, height);
    for (const StripColumn& column : layOutStrip(my.flat->height(), {width, height}).columns) {
        const Result<Image> drawn =
            my.drawFlat(column.window, view.optics, view.march, column.size);
        if (!drawn) return drawn;
        const std::size_t row = 3 * std::size_t(column.size.x);
        for (int y = 0; y < column.size.y; ++y)
            std::copy_n(
                &drawn->rgb[row * std::size_t(y)], row,
                &overview
                     .rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(column.left))]);
    }
    return overview;
}

Result<Image> CaseRenderer::render(const OverviewView& view, int width, int height) {
    Impl& my = *impl_;
    if (!my.overview) {
        auto made = OverviewPainter::create(my.context, my.scene);
        if (!made) return tl::make_unexpected(made.error());
        my.overview = std::move(*made);
    }
    return my.overview->draw(view, {width, height}, *my.raycasters.at(my.used));
}

std::size_t CaseRenderer::gpuBytes() const {
    const Impl& my = *impl_;
    std::size_t bytes = my.glScene->gpuBytes();
    for (const std::optional<gpu::Texture>* texture : {&my.ct, &my.picture})
        if (*texture) bytes += (*texture)->bytes();
    if (my.flat) bytes += my.flat->gpuBytes();
    if (my.overview) bytes += my.overview->gpuBytes();
    if (my.wallIndex) bytes += my.wallIndex->gpuBytes();
    for (const auto& [kind, raycaster] : my.raycasters)
        bytes += raycaster->gpuBytes();
    return bytes;
}

}  // namespace haustra::render
