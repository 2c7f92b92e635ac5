// A case's flat maps: from memory to product files and back.
#include "store/case_store.h"
#include "store/product_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace haustra::store {
namespace {

struct Camera {
    double x, y, z, arc;
};
static_assert(sizeof(Camera) == flatMapCameraBytes);
static_assert(sizeof(glm::dvec3) + sizeof(glm::dvec2) + sizeof(std::int32_t) == flatMapVertexBytes);
static_assert(sizeof(glm::ivec3) + sizeof(std::int32_t) == flatMapTriangleBytes);

bool isInReach(glm::dvec3 p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= maxWallMm &&
           !std::isnan(p.x + p.y + p.z);
}

// What is wrong with the map; nullptr where it is sound. Written so that NaN is wrong everywhere.
const char* flawOf(const FlatMap& map) {
    const std::size_t vertices = map.surface.vertices.size();
    if (map.flat.size() != vertices || map.camera.size() != vertices ||
        map.sourceTriangle.size() != map.surface.triangles.size()) {
        return "counts that do not agree";
    }
    if (map.surface.triangles.empty()) return "no triangle";
    if (map.cameras.empty()) return "no camera";
    if (!(map.height > 0.0 && map.height <= maxFlatHeight)) return "a height that is none";
    for (const glm::dvec3& v : map.surface.vertices) {
        if (!isInReach(v)) return "a vertex that is nowhere";
    }
    for (const glm::dvec2& at : map.flat) {
        if (!(at.x >= 0.0 && at.x <= 1.0 && at.y >= 0.0 && at.y <= map.height))
            return "a vertex that is flattened beyond the strip";
    }
    for (const glm::ivec3& t : map.surface.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            if (t[corner] < 0 || std::size_t(t[corner]) >= vertices)
                return "a triangle with a corner that is no vertex";
        }
    }
    for (const std::int32_t source : map.sourceTriangle) {
        if (source < 0) return "a triangle that is a part of none";
    }
    for (const std::int32_t camera : map.camera) {
        if (camera < 0 || std::size_t(camera) >= map.cameras.size())
            return "a vertex whose camera does not exist";
    }
    double lastArcMm = 0.0;
    for (const FlatCamera& camera : map.cameras) {
        if (!isInReach(camera.positionMm) || !(camera.arcMm <= maxWallMm))
            return "a camera that is nowhere";
        if (camera.arcMm < lastArcMm) return "cameras that are not in order";
        lastArcMm = camera.arcMm;
    }
    return nullptr;
}

}  // namespace

Result<FlatMap> Case::readFlatMap(std::string_view product) const {
    const auto mapped = TRY(map(product));
    TRY(checkContent(mapped, Content::flatMap, product));
    // mapProduct has held the three counts against the number of bytes.
    const glm::ivec3 size = mapped.header.grid.size;
    const std::size_t vertices = std::size_t(size.x), triangles = std::size_t(size.y);
    FlatMap flatMap;
    const std::byte* at = mapped.values.data();
    const auto take = [&](auto& values, std::size_t count) {
        values.resize(count);
        if (count == 0) return;
        std::memcpy(values.data(), at, count * sizeof values[0]);
        at += count * sizeof values[0];
    };
    std::memcpy(&flatMap.height, at, sizeof flatMap.height);
    at += sizeof flatMap.height;
    std::vector<Camera> cameras;
    take(flatMap.surface.vertices, vertices);
    take(flatMap.flat, vertices);
    take(cameras, std::size_t(size.z));
    take(flatMap.surface.triangles, triangles);
    take(flatMap.sourceTriangle, triangles);
    take(flatMap.camera, vertices);
    TRY(checkWhole(mapped));
    flatMap.cameras.reserve(cameras.size());
    for (const Camera& camera : cameras)
        flatMap.cameras.push_back({{camera.x, camera.y, camera.z}, camera.arc});
    if (const char* flaw = flawOf(flatMap)) {
        return fail(ErrorKind::badInput,
                    "the product is damaged: " + std::string(product) + " has " + flaw,
                    folder_.string());
    }
    return flatMap;
}

Result<void> Case::publishFlatMap(std::string_view product, const ProductKey& key,
                                  const FlatMap& map, const Attributes& attributes,
                                  const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    const ProductEntry entry{std::string(product), key,
                             productFileName(product, key.hex, Content::flatMap)};
    const std::filesystem::path file = folder_ / entry.file;
    ProductHeader header{Content::flatMap, {}, digestFromHex(key.hex), {}, attributes};
    header.grid.size = TRY(elementNumbers(
        Content::flatMap,
        {map.surface.vertices.size(), map.surface.triangles.size(), map.cameras.size()}, file));
    if (const char* flaw = flawOf(map))
        return fail(ErrorKind::badInput, std::string("the flat map has ") + flaw, file.string());
    std::vector<Camera> cameras;
    cameras.reserve(map.cameras.size());
    for (const FlatCamera& camera : map.cameras) {
        const glm::dvec3 p = camera.positionMm;
        cameras.push_back({p.x, p.y, p.z, camera.arcMm});
    }
    const std::span height(&map.height, 1);
    return writeProduct(
               folder_, entry.file, header,
               {std::as_bytes(height), std::as_bytes(std::span(map.surface.vertices)),
                std::as_bytes(std::span(map.flat)), std::as_bytes(std::span(cameras)),
                std::as_bytes(std::span(map.surface.triangles)),
                std::as_bytes(std::span(map.sourceTriangle)), std::as_bytes(std::span(map.camera))})
        .and_then([&] { return announce(entry, outdated); });
}

}  // namespace haustra::store
