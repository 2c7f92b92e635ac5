#include "render/hybrid/hybrid_raycaster.h"

#include "core/thread_pool.h"
#include "gpu/streaming.h"
#include "gpu/timestamps.h"
#include "render/gl/march_variant.h"
#include "render/gl/picture_readback.h"
#include "render/hybrid/camera_rays.h"
#include "render/hybrid/ray_tiles.h"
#include "render/hybrid/reader_balances.h"
#include "render/scene/lru_cache.h"
#include "render/scene/ray_setup.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <span>
#include <utility>

namespace haustra::render {

namespace {

/// As the shaders have them.
constexpr unsigned quadBinding = 0, spanBinding = 1, raysImage = 1;
/// Rows of tiles that are determined before their first slab is cast.
constexpr int tileRowsAtOnce = 4;
/// Quads of a work group, and as many groups to a row of them as any device takes.
constexpr int quadsPerGroup = 16, groupsPerRow = 1024, groupThreads = 64;

/// Cameras of one reader, picture after picture, in lengths of the volume's diagonal.
constexpr double nearShare = 0.1;

double nowMs() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// Of all threads of the process.
double cpuTimeMs() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

double diagonalMm(const Grid& grid) {
    return glm::distance(grid.patientFromVoxelPoint(glm::dvec3(0.0)),
                         grid.patientFromVoxelPoint(glm::dvec3(grid.size - 1)));
}

bool anyOpaqueLeaf(const ClassifiedOctree& octree) {
    const glm::ivec3 size = octree.nodes(0);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                if (octree.at(0, {x, y, z}) == NodeClass::opaque) return true;
    return false;
}

}  // namespace

/// Memory that the GPU reads lists of quads from while the CPU writes the next ones. Belongs to the
/// thread of the context. Move-only.
class QuadLists {
public:
    /// For lists of up to `quads` quads each.
    static Result<QuadLists> create(int quads);

    /// Room for a list of up to the `quads` of create(): xy as the shader packs them. Waits where
    /// the GPU still reads what was there.
    std::span<glm::uvec2> begin();
    /// Binds the list of the first `count` entries as shaders/hybrid_slab.comp reads it; `samples`
    /// of a slab, or 0.
    void bind(unsigned binding, int count, int samples);
    /// The command that reads the list has been given: the next begin() is another list.
    void given();
    std::size_t bytes() const { return memory_.bytes(); }

private:
    static constexpr int lists = 4;
    static constexpr std::size_t headerBytes = 16;
    QuadLists(gpu::MappedBuffer memory, std::size_t stride, int quads)
        : memory_(std::move(memory)), stride_(stride), quads_(quads) {}
    std::byte* at() const { return memory_.data() + stride_ * std::size_t(next_); }
    gpu::MappedBuffer memory_;
    std::size_t stride_;
    int quads_, next_ = 0;
    gpu::Fence read_[lists];
};

Result<QuadLists> QuadLists::create(int quads) {
    const std::size_t alignment = gpu::storageAlignment();
    const std::size_t list = headerBytes + sizeof(glm::uvec2) * std::size_t(quads);
    const std::size_t stride = (list + alignment - 1) / alignment * alignment;
    auto memory = TRY(gpu::MappedBuffer::create(stride * lists, "lists of quads"));
    return QuadLists(std::move(memory), stride, quads);
}

std::span<glm::uvec2> QuadLists::begin() {
    read_[next_].wait();
    return {reinterpret_cast<glm::uvec2*>(at() + headerBytes), std::size_t(quads_)};
}

void QuadLists::bind(unsigned binding, int count, int samples) {
    const std::uint32_t header[4] = {std::uint32_t(count), std::uint32_t(samples), 0, 0};
    std::memcpy(at(), header, sizeof header);
    memory_.bind(binding, stride_ * std::size_t(next_),
                 headerBytes + sizeof(glm::uvec2) * std::size_t(quads_));
}

void QuadLists::given() {
    read_[next_] = gpu::Fence::place();
    next_ = (next_ + 1) % lists;
}

struct HybridRaycaster::Impl {
    /// The octree as one view's colours show it.
    struct Classified {
        Optics optics;
        double stepMm;
        ClassifiedOctree octree;
        bool anyOpaque;
    };

    std::shared_ptr<GlScene> scene;
    HybridOptions options;
    ThreadPool pool;
    MinMaxOctree octree;
    MarchPrograms slabs{"hybrid_slab.comp"}, finish{"cell_picture.comp"};
    ReaderBalances balances;
    // Each holds a byte for eight voxels.
    LruCache<Classified> classified{GlScene::classificationsKept};
    int classifications = 0;
    std::optional<gpu::Texture> rays, target;
    std::optional<gpu::MappedBuffer> spans;
    std::optional<QuadLists> lists;
    gpu::Timestamps timestamps;  // before and after each pass of the GPU
    HybridStats stats;

    Impl(std::shared_ptr<GlScene> made, HybridOptions chosen)
        : scene(std::move(made)),
          options(chosen),
          pool(chosen.threads),
          octree(MinMaxOctree::fromLeaves(scene->scene().ranges, blockSide,
                                          scene->scene().grid().size)),
          balances(nearShare * diagonalMm(scene->scene().grid())) {}

    const Classified& classify(const Optics& optics, double stepMm, const TransferTable& table) {
        if (const Classified* known = classified.find([&](const Classified& one) {
                return one.stepMm == stepMm && one.optics == optics;
            }))
            return *known;
        classified.makeRoom();
        ++classifications;
        ClassifiedOctree made(octree, table, options.threads);
        const bool opaque =
            optics.composition != Composition::maximumIntensity && anyOpaqueLeaf(made);
        return *classified.keep({optics, stepMm, std::move(made), opaque});
    }

    Result<void> makeTargets(glm::ivec2 size);
    /// Casts the list of quads; `samples` of a slab, or 0.
    void cast(const gpu::ComputeProgram& program, int quads, int samples);
    /// Casts slab after slab until no quad goes on, then what is left.
    void castAll(const gpu::ComputeProgram& program, RayTiles& tiles, int tilesPerRow);
};

Result<void> HybridRaycaster::Impl::makeTargets(glm::ivec2 size) {
    if (target && glm::ivec2(target->size()) == size) return {};
    using gpu::Filter, gpu::Texture, gpu::TexelFormat;
    auto sums = TRY(Texture::create(2, {size, 1}, TexelFormat::rgba32f, Filter::nearest, "rays"));
    auto made = TRY(Texture::create(2, {size, 1}, TexelFormat::rgba8, Filter::nearest, "picture"));
    auto memory = TRY(gpu::MappedBuffer::create(
        sizeof(RaySpan) * std::size_t(size.x) * std::size_t(size.y), "ends of rays"));
    const glm::ivec2 tiles = (size + RayTiles::tileSide - 1) / RayTiles::tileSide;
    auto quads = TRY(QuadLists::create(tiles.x * tiles.y * RayTiles::quadsPerTile));
    rays = std::move(sums);
    target = std::move(made);
    spans = std::move(memory);
    lists = std::move(quads);
    return {};
}

void HybridRaycaster::Impl::cast(const gpu::ComputeProgram& program, int quads, int samples) {
    if (quads == 0) return;
    lists->bind(quadBinding, quads, samples);
    const int groups = (quads + quadsPerGroup - 1) / quadsPerGroup;
    timestamps.mark();
    program.dispatch({groupThreads * std::min(groups, groupsPerRow),
                      (groups + groupsPerRow - 1) / groupsPerRow});
    timestamps.mark();
    lists->given();
}

void HybridRaycaster::Impl::castAll(const gpu::ComputeProgram& program, RayTiles& tiles,
                                    int tilesPerRow) {
    const auto timed = [&](const auto& work) {
        const double before = nowMs();
        work();
        stats.cpuMs += nowMs() - before;
    };
    std::span<glm::uvec2> list;
    int listed = 0;
    const auto append = [&](int tile, QuadState state) {
        tiles.forEach(tile, state, [&](glm::ivec2 quad, int before) {
            list[std::size_t(listed++)] = {unsigned(quad.x) | unsigned(quad.y) << 16,
                                           unsigned(before)};
        });
    };
    std::vector<int> active;
    const int atOnce = tileRowsAtOnce * tilesPerRow;
    for (int first = 0; first < tiles.tiles(); first += atOnce) {
        const int count = std::min(atOnce, tiles.tiles() - first);
        list = lists->begin();
        listed = 0;
        timed([&] {
            pool.run(count, [&](int i) { tiles.determine(first + i); });
            for (int tile = first; tile < first + count; ++tile) {
                if (tiles.liveQuads(tile) == 0) continue;
                append(tile, QuadState::live);
                active.push_back(tile);
            }
        });
        cast(program, listed, RayTiles::slabSamples);
        stats.quadsCast += listed;
    }
    for (int slab = 0; !active.empty(); ++slab) {
        ++stats.passes;
        list = lists->begin();
        listed = 0;
        timed([&] {
            pool.run(int(active.size()),
                     [&](int i) { tiles.follow(active[std::size_t(i)], slab); });
            std::erase_if(active, [&](int tile) { return tiles.liveQuads(tile) == 0; });
            for (const int tile : active)
                append(tile, QuadState::live);
        });
        cast(program, listed, RayTiles::slabSamples);
        stats.quadsCast += listed;
    }
    list = lists->begin();
    listed = 0;
    for (int tile = 0; tile < tiles.tiles(); ++tile)
        append(tile, QuadState::hole);
    stats.quadsFilled = listed;
    cast(program, listed, 0);
}

Result<std::unique_ptr<HybridRaycaster>> HybridRaycaster::create(std::shared_ptr<GlScene> scene,
                                                                 HybridOptions options) {
    std::unique_ptr<HybridRaycaster> made(
        new HybridRaycaster(std::make_unique<Impl>(std::move(scene), options)));
    // A driver that refuses the text is found here, not in a reader's session.
    for (MarchPrograms* programs : {&made->impl_->slabs, &made->impl_->finish})
        TRY(programs->program({}));
    return made;
}

HybridRaycaster::HybridRaycaster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HybridRaycaster::~HybridRaycaster() = default;

Result<void> HybridRaycaster::render(const CameraView& view, const Band& band, Image& picture) {
    TRY(checkBand(band, picture));
    TRY(checkCameraView(view, band.pictureSize));
    Impl& my = *impl_;
    const int errorsBefore = my.scene->context().errorCount();
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    TRY(my.makeTargets(size));
    const auto onGpu = TRY(my.scene->classification(view.optics, view.march));
    const Scene& scene = my.scene->scene();
    const TransferTable& table = onGpu->table();
    const double step = stepMm(view.march, scene.grid());
    const Impl::Classified& classified = my.classify(view.optics, step, table);
    const MarchVariant variant = MarchVariant::of(view.optics, my.scene->hasGradients(view.optics),
                                                  view.backdrop != nullptr);
    const auto slab = TRY(my.slabs.program(variant));
    const auto finish = TRY(my.finish.program(variant));

    shaders::MarchUniforms uniforms =
        marchUniforms(view, scene.grid(), table, scene.ranges.size, band.pictureSize);
    uniforms.firstRow = band.firstRow;
    my.scene->bind(uniforms, *onGpu);
    if (view.backdrop) {
        TRY(my.scene->bindBackdrop(view.backdrop));
    }
    // Where the GPU is the CPU's own cores, a picture costs what it takes of them all: that others
    // who use them meanwhile do not blur, nor does a way of sharing that only takes more from them.
    const auto spentMs = my.scene->context().software() ? cpuTimeMs : nowMs;
    const double began = spentMs();
    my.stats = {};
    my.stats.controls =
        my.options.controls ? *my.options.controls : my.balances.controls(view, band, step);
    my.timestamps.restart();
    my.rays->clear();
    my.rays->bindImage(raysImage);
    my.spans->bind(spanBinding, 0, my.spans->bytes());
    const CameraRays rays(view, scene.grid(), band.pictureSize);
    const RayMedium medium{scene.volume, classified.octree, table, classified.anyOpaque,
                           variant.preIntegrated ? 2 : 1};
    const std::span<RaySpan> spans(reinterpret_cast<RaySpan*>(my.spans->data()),
                                   std::size_t(size.x) * std::size_t(size.y));
    RayTiles tiles(rays, medium, band, view.backdrop.get(), step, my.stats.controls, spans);
    my.stats.quads = ((size.x + 1) / 2) * ((size.y + 1) / 2);
    my.castAll(*slab, tiles, (size.x + RayTiles::tileSide - 1) / RayTiles::tileSide);

    my.target->bindImage(shaders::pictureImage);
    finish->dispatch(size);
    TRY(readBack(my.scene->context(), *my.target, errorsBefore, band.firstRow, picture));
    const std::vector<double> between = my.timestamps.betweenMs();
    for (std::size_t i = 0; i < between.size(); i += 2)
        my.stats.gpuMs += between[i];
    if (!my.options.controls) my.balances.drew(my.stats.cpuMs, my.stats.gpuMs, spentMs() - began);
    return {};
}

const HybridStats& HybridRaycaster::stats() const {
    return impl_->stats;
}

int HybridRaycaster::classifications() const {
    return impl_->classifications;
}

std::vector<PassTime> HybridRaycaster::passTimes() const {
    return {{"cpu", impl_->stats.cpuMs}, {"slabs", impl_->stats.gpuMs}};
}

std::size_t HybridRaycaster::gpuBytes() const {
    const Impl& my = *impl_;
    if (!my.target) return 0;
    return my.rays->bytes() + my.target->bytes();
}

}  // namespace haustra::render
