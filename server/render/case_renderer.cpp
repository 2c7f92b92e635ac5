#include "render/case_renderer.h"

#include "core/parallel.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "render/classification.h"
#include "render/flat_painter.h"
#include "render/leap_map.h"
#include "render/ray_setup.h"
#include "render/stored_value.h"
#include "shaders/shader_source.h"
#include "shaders/uniforms.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace haustra::render {

namespace {

using shaders::MarchUniforms;
using shaders::shaderSource;
using shaders::SliceUniforms;

// Each holds a leap map, a byte for eight voxels.
constexpr std::size_t classificationsKept = 4;

Result<gpu::Texture> uploadVolume(const Volume<std::int16_t>& volume, int threads,
                                  const char* what) {
    const glm::ivec3 size = volume.grid().size;
    Result<gpu::Texture> texture =
        gpu::Texture::create(3, size, gpu::TexelFormat::r16, gpu::Filter::linear, what);
    if (!texture) return texture;
    // By slabs, so that the copy in the texture's encoding stays small.
    const std::size_t slice = std::size_t(size.x) * std::size_t(size.y);
    const int slab = std::max(1, int((std::size_t(16) << 20) / slice));
    std::vector<std::uint16_t> encoded;
    for (int z = 0; z < size.z; z += slab) {
        const int count = std::min(slab, size.z - z);
        encoded.resize(slice * std::size_t(count));
        const std::int16_t* from = volume.voxels().data() + slice * std::size_t(z);
        parallelFor(encoded.size(), 1 << 20, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                encoded[i] = encodeHu(from[i]);
        });
        texture->uploadSlices(z, count, encoded.data());
    }
    return texture;
}

Result<void> checkPicture(int width, int height) {
    if (width < 1 || height < 1 || width > maxPictureSide || height > maxPictureSide)
        return fail(ErrorKind::badInput, "a picture of " + std::to_string(width) + "x" +
                                             std::to_string(height) +
                                             " pixels is not within 1x1 to 2048x2048");
    return {};
}

}  // namespace

struct CaseRenderer::Impl {
    gpu::Context& context;
    Grid grid;
    int threads;
    gpu::Texture ct;
    std::optional<gpu::Texture> cleansed;  // where it differs from the scan
    bool hasCleansed;
    BlockRanges ranges;
    gpu::ComputeProgram coneStart, endoscopic, slice;
    gpu::UniformBuffer marchBlock, sliceBlock;
    std::optional<FlatPainter> flat;  // where the case has a flat map
    std::optional<gpu::Texture> picture, firstStep;
    std::vector<Classification> recent;  // the latest used last

    /// Made, or found among those lately used: readers of one case may differ in their colours.
    Result<const Classification*> classification(const TransferFunction& transferFunction,
                                                 const MarchOptions& march) {
        if (Result<void> sound = checkTransferFunction(transferFunction); !sound)
            return tl::make_unexpected(sound.error());
        if (Result<void> sound = checkMarch(march); !sound)
            return tl::make_unexpected(sound.error());
        const double step = stepMm(march, grid);
        const auto wanted = [&](const Classification& one) {
            return one.isFor(transferFunction, step, march.emptySpaceLeaping);
        };
        if (const auto found = std::find_if(recent.begin(), recent.end(), wanted);
            found != recent.end()) {
            std::rotate(found, found + 1, recent.end());
            return &recent.back();
        }
        if (recent.size() == classificationsKept) recent.erase(recent.begin());
        Result<Classification> made = Classification::create(
            transferFunction, step, march.emptySpaceLeaping, ranges, threads);
        if (!made) return tl::make_unexpected(made.error());
        recent.push_back(std::move(*made));
        return &recent.back();
    }

    Result<void> makeTargets(glm::ivec2 size) {
        if (picture && glm::ivec2(picture->size()) == size) return {};
        using gpu::Filter, gpu::Texture, gpu::TexelFormat;
        Result<Texture> made =
            Texture::create(2, {size, 1}, TexelFormat::rgba8, Filter::nearest, "picture");
        if (!made) return tl::make_unexpected(made.error());
        const glm::ivec2 tiles = (size + coneTile - 1) / coneTile;
        Result<Texture> starts =
            Texture::create(2, {tiles, 1}, TexelFormat::r32f, Filter::nearest, "cone pass");
        if (!starts) return tl::make_unexpected(starts.error());
        picture = std::move(*made);
        firstStep = std::move(*starts);
        return {};
    }

    /// The volume, what makes it visible, and how rays run through it: bound for march().
    void bindVolume(const MarchUniforms& u, const Classification& classified) {
        marchBlock.write(u);
        marchBlock.bind(shaders::uniformBinding);
        (cleansed ? *cleansed : ct).bind(shaders::volumeUnit);
        classified.bind();
    }

    Result<Image> drawFlat(const FlatWindow& window, const MarchOptions& march,
                           const Classification& classified, glm::ivec2 size) {
        const int errorsBefore = context.errorCount();
        if (Result<void> made = makeTargets(size); !made) return tl::make_unexpected(made.error());
        bindVolume(marchUniforms(march, grid, classified.table(), ranges.size, size), classified);
        if (Result<void> found = flat->findTriangles(window, size); !found)
            return tl::make_unexpected(found.error());
        flat->castRays(stepMm(march, grid), *picture);
        return readPicture(size, errorsBefore);
    }

    Result<void> checkFlat() const {
        if (flat) return {};
        return fail(ErrorKind::badInput, "the case has no flat map", "flattened view");
    }

    Result<Image> readPicture(glm::ivec2 size, int errorsBefore) {
        const std::size_t pixels = std::size_t(size.x) * std::size_t(size.y);
        std::vector<std::uint8_t> rgba(4 * pixels);
        picture->read(rgba.data(), rgba.size());
        if (context.errorCount() != errorsBefore)
            return fail(ErrorKind::device, "the graphics driver reported an error", "render");
        Image image{size.x, size.y, std::vector<std::uint8_t>(3 * pixels)};
        for (std::size_t i = 0; i < pixels; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                image.rgb[3 * i + c] = rgba[4 * i + c];
        return image;
    }
};

Result<std::unique_ptr<CaseRenderer>> CaseRenderer::create(gpu::Context& context,
                                                           const Volume<std::int16_t>& ct,
                                                           const Volume<std::int16_t>& cleansed,
                                                           int threads) {
    Result<PreparedCase> prepared = prepareCase(ct, cleansed, threads);
    if (!prepared) return tl::make_unexpected(prepared.error());
    return upload(context, std::move(*prepared), threads);
}

Result<std::unique_ptr<CaseRenderer>> CaseRenderer::upload(gpu::Context& context,
                                                           PreparedCase prepared, int threads) {
    using gpu::ComputeProgram, gpu::Filter, gpu::Texture, gpu::TexelFormat, gpu::UniformBuffer;
    const Grid grid = prepared.ct.grid();
    if (Result<void> fits = checkScanSide(grid, std::min(maxScanSide, gpu::maxTextureSide3d()));
        !fits)
        return tl::make_unexpected(fits.error());

    const int errorsBefore = context.errorCount();
    Result<Texture> ctTexture = uploadVolume(prepared.ct, threads, "scan on the GPU");
    if (!ctTexture) return tl::make_unexpected(ctTexture.error());
    const bool hasCleansed = !prepared.cleansed.empty();
    std::optional<Texture> cleansedTexture;
    if (hasCleansed && prepared.cleansed.voxels().data() != prepared.ct.voxels().data()) {
        Result<Texture> texture =
            uploadVolume(prepared.cleansed, threads, "cleansed scan on the GPU");
        if (!texture) return tl::make_unexpected(texture.error());
        cleansedTexture = std::move(*texture);
    }
    const std::string_view structs = shaderSource("uniforms.h"), march = shaderSource("march.glsl");
    Result<ComputeProgram> cone = ComputeProgram::create(
        "cone_start.comp", {structs, march, shaderSource("cone_start.comp")});
    if (!cone) return tl::make_unexpected(cone.error());
    Result<ComputeProgram> endoscopic = ComputeProgram::create(
        "endoscopic.comp",
        {structs, march, shaderSource("picture.glsl"), shaderSource("endoscopic.comp")});
    if (!endoscopic) return tl::make_unexpected(endoscopic.error());
    Result<ComputeProgram> slice =
        ComputeProgram::create("slice.comp", {structs, shaderSource("slice.comp")});
    if (!slice) return tl::make_unexpected(slice.error());
    Result<UniformBuffer> marchBlock = UniformBuffer::create(sizeof(MarchUniforms));
    if (!marchBlock) return tl::make_unexpected(marchBlock.error());
    Result<UniformBuffer> sliceBlock = UniformBuffer::create(sizeof(SliceUniforms));
    if (!sliceBlock) return tl::make_unexpected(sliceBlock.error());
    std::optional<FlatPainter> flat;
    if (prepared.flatMap) {
        Result<FlatPainter> painter = FlatPainter::create(*prepared.flatMap, grid);
        if (!painter) return tl::make_unexpected(painter.error());
        flat = std::move(*painter);
    }
    if (context.errorCount() != errorsBefore)
        return fail(ErrorKind::device, "the graphics driver reported an error", "render");

    return std::unique_ptr<CaseRenderer>(
        new CaseRenderer(std::unique_ptr<Impl>(new Impl{context,
                                                        grid,
                                                        threads,
                                                        std::move(*ctTexture),
                                                        std::move(cleansedTexture),
                                                        hasCleansed,
                                                        std::move(prepared.ranges),
                                                        std::move(*cone),
                                                        std::move(*endoscopic),
                                                        std::move(*slice),
                                                        std::move(*marchBlock),
                                                        std::move(*sliceBlock),
                                                        std::move(flat),
                                                        {},
                                                        {},
                                                        {}})));
}

CaseRenderer::CaseRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CaseRenderer::~CaseRenderer() = default;

Result<Image> CaseRenderer::render(const EndoscopicView& view, int width, int height) {
    Impl& my = *impl_;
    const int errorsBefore = my.context.errorCount();
    if (Result<void> sound = checkPicture(width, height); !sound)
        return tl::make_unexpected(sound.error());
    if (Result<void> sound = checkCamera(view.camera); !sound)
        return tl::make_unexpected(sound.error());
    const glm::ivec2 size(width, height);
    if (Result<void> made = my.makeTargets(size); !made) return tl::make_unexpected(made.error());

    const Result<const Classification*> classified =
        my.classification(view.transferFunction, view.march);
    if (!classified) return tl::make_unexpected(classified.error());
    my.bindVolume(marchUniforms(view, my.grid, (*classified)->table(), my.ranges.size, size),
                  **classified);
    my.firstStep->bindImage(shaders::startImage);
    my.coneStart.dispatch((size + coneTile - 1) / coneTile);
    my.firstStep->bind(shaders::startUnit);
    my.picture->bindImage(shaders::pictureImage);
    my.endoscopic.dispatch(size);
    return my.readPicture(size, errorsBefore);
}

Result<Image> CaseRenderer::render(const SliceView& view, int width, int height) {
    Impl& my = *impl_;
    const int errorsBefore = my.context.errorCount();
    if (Result<void> sound = checkPicture(width, height); !sound)
        return tl::make_unexpected(sound.error());
    const bool cleansed = view.scan == Scan::cleansed;
    if (cleansed && !my.hasCleansed)
        return fail(ErrorKind::badInput, "the case has no cleansed scan", "slice");
    const Result<SlicePlacement> placement = placeSlice(view, my.grid, width, height);
    if (!placement) return tl::make_unexpected(placement.error());
    const glm::ivec2 size(width, height);
    if (Result<void> made = my.makeTargets(size); !made) return tl::make_unexpected(made.error());

    const glm::dmat4 voxelFromPatient = my.grid.voxelFromPatient();
    const glm::dvec3 voxels(my.grid.size);
    const auto textureVector = [&](glm::dvec3 mm) {
        return glm::dvec3(voxelFromPatient * glm::dvec4(mm, 0.0)) / voxels;
    };
    SliceUniforms u{};
    u.originTexture = glm::vec4(
        (glm::dvec3(voxelFromPatient * glm::dvec4(placement->topLeftMm, 1.0)) + 0.5) / voxels, 0.0);
    u.rightTexture = glm::vec4(textureVector(placement->rightMm), 0.0);
    u.downTexture = glm::vec4(textureVector(placement->downMm), 0.0);
    const WindowLevel& window = view.window;
    u.window = glm::vec4(storedRange / window.widthHu,
                         0.5 - (storedOffset + window.centerHu) / window.widthHu, 0, 0);
    u.pictureSize = glm::ivec4(size, 0, 0);
    my.sliceBlock.write(u);
    my.sliceBlock.bind(shaders::uniformBinding);
    (cleansed && my.cleansed ? *my.cleansed : my.ct).bind(shaders::volumeUnit);
    my.picture->bindImage(shaders::pictureImage);
    my.slice.dispatch(size);
    return my.readPicture(size, errorsBefore);
}

Result<Image> CaseRenderer::render(const FlatView& view, int width, int height) {
    Impl& my = *impl_;
    if (Result<void> sound = checkPicture(width, height); !sound)
        return tl::make_unexpected(sound.error());
    if (Result<void> sound = checkFlatWindow(view.window, width); !sound)
        return tl::make_unexpected(sound.error());
    if (Result<void> has = my.checkFlat(); !has) return tl::make_unexpected(has.error());
    const Result<const Classification*> classified =
        my.classification(view.transferFunction, view.march);
    if (!classified) return tl::make_unexpected(classified.error());
    return my.drawFlat(view.window, view.march, **classified, {width, height});
}

Result<Image> CaseRenderer::render(const FlatOverview& view, int width, int height) {
    Impl& my = *impl_;
    if (Result<void> sound = checkPicture(width, height); !sound)
        return tl::make_unexpected(sound.error());
    if (Result<void> has = my.checkFlat(); !has) return tl::make_unexpected(has.error());
    const Result<const Classification*> classified =
        my.classification(view.transferFunction, view.march);
    if (!classified) return tl::make_unexpected(classified.error());
    Image overview{width, height,
                   std::vector<std::uint8_t>(3u * unsigned(width) * unsigned(height))};
    for (const StripColumn& column : layOutStrip(my.flat->height(), {width, height}).columns) {
        const Result<Image> drawn =
            my.drawFlat(column.window, view.march, **classified, column.size);
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

std::size_t CaseRenderer::gpuBytes() const {
    const Impl& my = *impl_;
    std::size_t bytes = my.ct.bytes();
    for (const std::optional<gpu::Texture>* texture : {&my.cleansed, &my.picture, &my.firstStep})
        if (*texture) bytes += (*texture)->bytes();
    if (my.flat) bytes += my.flat->gpuBytes();
    for (const Classification& one : my.recent)
        bytes += one.gpuBytes();
    return bytes;
}

}  // namespace haustra::render
