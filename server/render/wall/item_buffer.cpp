#include "render/wall/item_buffer.h"

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/raster_target.h"
#include "render/wall/wall_projection.h"
#include "shaders/item_uniforms.h"
#include "shaders/shader_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace haustra::render {

namespace {

constexpr int trianglesOfDraw = 512, threadsOfGroup = 64;

/// The bits of a number of 10, two places apart.
std::uint32_t spread(std::uint32_t n) {
    n = (n | n << 16) & 0x030000ff, n = (n | n << 8) & 0x0300f00f;
    n = (n | n << 4) & 0x030c30c3, n = (n | n << 2) & 0x09249249;
    return n;
}

}  // namespace

/// Triangles that follow each other in drawing order, within a ball.
struct ItemBuffer::Run {
    int first = 0, count = 0;
    glm::vec3 middleMm{0.0f};
    float radiusMm = 0.0f;
};

struct ItemBuffer::Parts {
    PinholePicture picture;
    bool tellFully = false;
    glm::dvec3 originMm{0.0};
    std::vector<std::int32_t> order;  // the wall's triangle that is drawn n-th
    std::vector<std::uint8_t> bridged;
    std::vector<Run> runs;
    gpu::RasterProgram items, totals;
    gpu::ComputeProgram observed, seen;
    gpu::StorageBuffer vertices, corners, observedCounts, totalCounts, seenFlags;
    gpu::UniformBuffer passBlock, itemBlock;
    gpu::RasterTarget target;
};

ItemBuffer::ItemBuffer(gpu::Context& context, std::unique_ptr<Parts> parts)
    : context_(context), parts_(std::move(parts)) {}
ItemBuffer::~ItemBuffer() = default;

Result<std::unique_ptr<ItemBuffer>> ItemBuffer::create(gpu::Context& context, const TriMesh& wall,
                                                       const std::vector<std::uint8_t>& bridged,
                                                       const PinholePicture& picture,
                                                       bool tellFully) {
    if (wall.triangles.empty()) return fail(ErrorKind::badInput, "the wall has no triangle");
    glm::dvec3 low(std::numeric_limits<double>::max()), high = -low;
    for (const glm::dvec3& vertex : wall.vertices)
        low = glm::min(low, vertex), high = glm::max(high, vertex);
    const glm::dvec3 origin = 0.5 * (low + high);

    // Along a space-filling curve, so that runs of triangles lie close together.
    std::vector<std::pair<std::uint32_t, std::int32_t>> byPlace;
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-9});
    for (std::size_t n = 0; n < wall.triangles.size(); ++n) {
        const glm::dvec3 middle = (wall.vertices[std::size_t(wall.triangles[n].x)] +
                                   wall.vertices[std::size_t(wall.triangles[n].y)] +
                                   wall.vertices[std::size_t(wall.triangles[n].z)]) /
                                  3.0;
        const glm::uvec3 cell((middle - low) * (1023.0 / extent));
        byPlace.emplace_back(spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2,
                             std::int32_t(n));
    }
    std::sort(byPlace.begin(), byPlace.end());
    std::vector<glm::vec4> places;
    for (const glm::dvec3& vertex : wall.vertices)
        places.emplace_back(glm::vec3(vertex - origin), 0.0f);
    std::vector<glm::uvec3> corners;
    std::vector<std::int32_t> order;
    for (const auto& [code, triangle] : byPlace) {
        order.push_back(triangle);
        corners.emplace_back(wall.triangles[std::size_t(triangle)]);
    }
    std::vector<Run> runs;
    for (int first = 0; first < int(order.size()); first += trianglesOfDraw) {
        Run run{first, std::min(trianglesOfDraw, int(order.size()) - first)};
        glm::vec3 least(INFINITY), most(-INFINITY);
        for (int n = first; n < first + run.count; ++n) {
            for (int corner = 0; corner < 3; ++corner) {
                const glm::vec3 place(places[corners[std::size_t(n)][corner]]);
                least = glm::min(least, place), most = glm::max(most, place);
            }
        }
        run.middleMm = 0.5f * (least + most);
        run.radiusMm = 0.5f * glm::distance(least, most);
        runs.push_back(run);
    }

    using gpu::ComputeProgram, gpu::RasterProgram, gpu::StorageBuffer, gpu::UniformBuffer;
    using shaders::shaderSource;
    const auto structs = shaderSource("uniforms.h"), pass = shaderSource("wall_uniforms.h"),
               own = shaderSource("item_uniforms.h"), lens = shaderSource("lens.glsl"),
               projection = shaderSource("wall.glsl"), vertex = shaderSource("item.vert");
    auto items =
        TRY(RasterProgram::create("item.frag", {structs, pass, lens, projection, vertex},
                                  {structs, pass, lens, projection, shaderSource("item.frag")}));
    auto totals = TRY(
        RasterProgram::create("item_total.frag", {structs, pass, lens, projection, vertex},
                              {structs, pass, lens, projection, shaderSource("item_total.frag")}));
    auto observed = TRY(ComputeProgram::create("item_observed.comp",
                                               {structs, own, shaderSource("item_observed.comp")}));
    auto seen = TRY(
        ComputeProgram::create("item_seen.comp", {structs, own, shaderSource("item_seen.comp")}));
    const std::vector<std::uint32_t> zeros(order.size(), 0);
    const auto counts = [&](const char* what) {
        return StorageBuffer::create(std::span(zeros), what);
    };
    auto vertexBuffer = TRY(StorageBuffer::create(std::span<const glm::vec4>(places), "wall"));
    auto cornerBuffer =
        TRY(StorageBuffer::create(std::span<const glm::uvec3>(corners), "wall's triangles"));
    auto observedCounts = TRY(counts("observed pixels"));
    auto totalCounts = TRY(counts("triangles' pixels"));
    auto seenFlags = TRY(counts("seen triangles"));
    auto passBlock = TRY(UniformBuffer::create(sizeof(shaders::WallUniforms)));
    auto itemBlock = TRY(UniformBuffer::create(sizeof(shaders::ItemUniforms)));
    auto target = TRY(gpu::RasterTarget::create(glm::ivec2(picture.side), gpu::TexelFormat::rg32i,
                                                "item buffer"));
    auto parts = std::make_unique<Parts>(Parts{
        picture, tellFully, origin, std::move(order), bridged, std::move(runs), std::move(items),
        std::move(totals), std::move(observed), std::move(seen), std::move(vertexBuffer),
        std::move(cornerBuffer), std::move(observedCounts), std::move(totalCounts),
        std::move(seenFlags), std::move(passBlock), std::move(itemBlock), std::move(target)});
    return std::unique_ptr<ItemBuffer>(new ItemBuffer(context, std::move(parts)));
}

Result<void> ItemBuffer::look(const CenterlineCamera& camera) {
    Parts& p = *parts_;
    const int errorsBefore = context_.errorCount();
    Camera view{camera.positionMm, camera.forward, camera.up, p.picture.fovDegrees};
    shaders::WallUniforms pass =
        wallProjection(view, Band::whole(p.picture.side, p.picture.side), p.originMm);
    // What lies beyond the depth of field hides nothing within it.
    std::vector<std::pair<int, int>> draws;
    for (const Run& run : p.runs) {
        const glm::vec3 fromEye = run.middleMm - pass.eyeMm;
        if (glm::length(fromEye) - run.radiusMm > float(p.picture.farthestMm) + 0.01f ||
            !mayShow(pass, fromEye, run.radiusMm))
            continue;
        if (!draws.empty() && draws.back().first + draws.back().second == run.first)
            draws.back().second += run.count;
        else
            draws.emplace_back(run.first, run.count);
    }
    p.itemBlock.write(shaders::ItemUniforms{pass.eyeMm, float(p.picture.nearestMm),
                                            float(p.picture.farthestMm), int(p.order.size()),
                                            int(p.tellFully), 0});
    p.itemBlock.bind(shaders::itemUniformBinding);
    p.passBlock.bind(shaders::wallUniformBinding);
    p.vertices.bind(shaders::itemVertexBinding);
    p.corners.bind(shaders::itemCornerBinding);
    p.observedCounts.bind(shaders::itemObservedBinding);
    p.totalCounts.bind(shaders::itemTotalBinding);
    p.seenFlags.bind(shaders::itemSeenBinding);
    p.target.clear(glm::ivec4(-1, 0, 0, 0));
    for (const auto& [first, count] : draws) {
        pass.firstTriangle = first;
        p.passBlock.write(pass);
        p.items.drawNearest(p.target, p.corners, first, count);
    }
    p.target.texture().bind(shaders::itemUnit);
    p.observed.dispatch(p.target.size());
    if (p.tellFully) {
        for (const auto& [first, count] : draws) {
            pass.firstTriangle = first;
            p.passBlock.write(pass);
            p.totals.drawAll(p.target, p.corners, first, count);
        }
    }
    p.seen.dispatchGroups((int(p.order.size()) + threadsOfGroup - 1) / threadsOfGroup);
    if (context_.errorCount() != errorsBefore)
        return fail(ErrorKind::device, "the graphics driver reported an error", "item buffer");
    return {};
}

std::vector<Visibility> ItemBuffer::seen() const {
    const Parts& p = *parts_;
    std::vector<std::uint32_t> drawn(p.order.size());
    p.seenFlags.read(drawn.data(), p.seenFlags.bytes());
    std::vector<Visibility> seen(p.order.size(), Visibility::unseen);
    for (std::size_t n = 0; n < p.order.size(); ++n) {
        const auto triangle = std::size_t(p.order[n]);
        if (p.bridged.empty() || !p.bridged[triangle]) seen[triangle] = Visibility(drawn[n]);
    }
    return seen;
}

}  // namespace haustra::render
