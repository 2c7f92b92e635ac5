// A case's volumes, centerlines and meshes: from memory to product files and back.
#include "store/case_store.h"
#include "store/product_file.h"
#include "store/product_values.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace haustra::store {
namespace {

namespace fs = std::filesystem;

template <class T>
constexpr Content contentOf();
template <>
constexpr Content contentOf<std::int16_t>() {
    return Content::int16Volume;
}
template <>
constexpr Content contentOf<std::uint8_t>() {
    return Content::uint8Volume;
}
template <>
constexpr Content contentOf<float>() {
    return Content::floatVolume;
}
template <>
constexpr Content contentOf<TissueFractions>() {
    return Content::fractionsVolume;
}

struct CenterlineSample {
    double x, y, z, arc, radius, gap;
};
static_assert(sizeof(CenterlineSample) == centerlineSampleBytes);
static_assert(sizeof(glm::dvec3) == meshVertexBytes && sizeof(glm::ivec3) == meshTriangleBytes);

}  // namespace

template <class T>
Result<Volume<T>> Case::readVolume(std::string_view product) const {
    auto mapped = TRY(map(product));
    TRY(checkContent(mapped, contentOf<T>(), product, folder_));
    // The values start on a page, so they are aligned for any T.
    const T* voxels = reinterpret_cast<const T*>(mapped.values.data());
    return Volume<T>::view(mapped.header.grid, voxels, mapped.mapping);
}

Result<Centerline> Case::readCenterline(std::string_view product) const {
    const auto mapped = TRY(map(product));
    TRY(checkContent(mapped, Content::centerline, product, folder_));
    Centerline centerline;
    centerline.points.reserve(mapped.values.size() / sizeof(CenterlineSample));
    for (std::size_t at = 0; at < mapped.values.size(); at += sizeof(CenterlineSample)) {
        CenterlineSample s;
        std::memcpy(&s, mapped.values.data() + at, sizeof s);
        centerline.points.push_back({{s.x, s.y, s.z}, s.arc, s.radius, s.gap != 0.0});
    }
    TRY(checkWhole(mapped));
    return centerline;
}

Result<TriMesh> Case::readMesh(std::string_view product) const {
    const auto mapped = TRY(map(product));
    TRY(checkContent(mapped, Content::mesh, product, folder_));
    // mapProduct has held both counts against the number of bytes.
    TriMesh mesh;
    mesh.vertices.resize(std::size_t(mapped.header.grid.size.x));
    mesh.triangles.resize(std::size_t(mapped.header.grid.size.y));
    const std::size_t vertexBytes = mesh.vertices.size() * meshVertexBytes;
    const auto copy = [&](auto& values, std::size_t from) {
        if (!values.empty()) {
            std::memcpy(values.data(), mapped.values.data() + from,
                        values.size() * sizeof values[0]);
        }
    };
    copy(mesh.vertices, 0);
    copy(mesh.triangles, vertexBytes);
    TRY(checkWhole(mapped));
    const auto damaged = [&](const char* what) {
        return fail(ErrorKind::badInput,
                    "the product is damaged: " + std::string(product) + " has " + what,
                    folder_.string());
    };
    for (const glm::dvec3& v : mesh.vertices) {
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
            return damaged("a vertex that is nowhere");
    }
    const auto count = std::int32_t(mesh.vertices.size());
    for (const glm::ivec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            if (t[corner] < 0 || t[corner] >= count)
                return damaged("a triangle with a corner that is no vertex");
        }
    }
    return mesh;
}

template <class T>
Result<void> Case::publishVolume(std::string_view product, const ProductKey& key,
                                 const Volume<T>& volume, const Attributes& attributes,
                                 const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    const ProductEntry entry{std::string(product), key, productFileName(product, key, ".hvol")};
    const fs::path file = folder_ / entry.file;
    TRY(checkGrid(volume.grid(), file.string()));
    const ProductHeader header{
        contentOf<T>(), volume.grid(), digestFromHex(key.hex), {}, attributes};
    return writeProduct(folder_, entry.file, header, std::as_bytes(volume.voxels())).and_then([&] {
        return announce(entry, outdated);
    });
}

template <class T>
Result<void> Case::publishVolume(std::string_view product, const ProductKey& key,
                                 const BoxedVolume<T>& volume, const Attributes& attributes,
                                 const std::vector<std::string>& outdated, int threads) {
    TRY(checkWritable());
    const ProductEntry entry{std::string(product), key, productFileName(product, key, ".hvol")};
    const fs::path file = folder_ / entry.file;
    TRY(checkGrid(volume.grid, file.string()));
    const ProductHeader header{contentOf<T>(), volume.grid, digestFromHex(key.hex), {}, attributes};
    const auto values = [&](std::size_t offset, std::span<std::byte> out) {
        // Blocks are whole voxels, in memory that is aligned for any.
        volume.read(offset / sizeof(T), {reinterpret_cast<T*>(out.data()), out.size() / sizeof(T)});
    };
    return writeProduct(folder_, entry.file, header, volume.grid.voxelCount() * sizeof(T), values,
                        threads)
        .and_then([&] { return announce(entry, outdated); });
}

Result<void> Case::publishCenterline(std::string_view product, const ProductKey& key,
                                     const Centerline& centerline, const Attributes& attributes,
                                     const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    std::vector<CenterlineSample> samples;
    samples.reserve(centerline.points.size());
    for (const CenterlinePoint& p : centerline.points) {
        samples.push_back({p.positionMm.x, p.positionMm.y, p.positionMm.z, p.arcMm, p.radiusMm,
                           p.gap ? 1.0 : 0.0});
    }
    ProductHeader header{Content::centerline, {}, digestFromHex(key.hex), {}, attributes};
    header.grid.size = {int(samples.size()), 1, 1};
    const ProductEntry entry{std::string(product), key, productFileName(product, key, ".hline")};
    return writeProduct(folder_, entry.file, header, std::as_bytes(std::span(samples)))
        .and_then([&] { return announce(entry, outdated); });
}

Result<std::string> Case::readText(std::string_view product) const {
    const auto mapped = TRY(map(product));
    TRY(checkContent(mapped, Content::text, product, folder_));
    std::string text(reinterpret_cast<const char*>(mapped.values.data()), mapped.values.size());
    TRY(checkWhole(mapped));
    return text;
}

Result<void> Case::publishText(std::string_view product, const ProductKey& key,
                               std::string_view text, const Attributes& attributes,
                               const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    ProductHeader header{Content::text, {}, digestFromHex(key.hex), {}, attributes};
    header.grid.size = {int(text.size()), 1, 1};
    const ProductEntry entry{std::string(product), key, productFileName(product, key, ".htext")};
    return writeProduct(folder_, entry.file, header, std::as_bytes(std::span(text))).and_then([&] {
        return announce(entry, outdated);
    });
}

Result<void> Case::publishMesh(std::string_view product, const ProductKey& key, const TriMesh& mesh,
                               const Attributes& attributes,
                               const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    const ProductEntry entry{std::string(product), key, productFileName(product, key, ".hmesh")};
    if (mesh.vertices.size() > mostMeshElements || mesh.triangles.size() > mostMeshElements) {
        return fail(ErrorKind::unsupported, "the mesh has too many vertices or triangles to store",
                    (folder_ / entry.file).string());
    }
    ProductHeader header{Content::mesh, {}, digestFromHex(key.hex), {}, attributes};
    header.grid.size = {int(mesh.vertices.size()), int(mesh.triangles.size()), 1};
    std::vector<std::byte> bytes;
    bytes.reserve(mesh.vertices.size() * meshVertexBytes +
                  mesh.triangles.size() * meshTriangleBytes);
    appendBytes(bytes, mesh.vertices);
    appendBytes(bytes, mesh.triangles);
    return writeProduct(folder_, entry.file, header, bytes).and_then([&] {
        return announce(entry, outdated);
    });
}

template Result<Volume<std::int16_t>> Case::readVolume(std::string_view) const;
template Result<Volume<std::uint8_t>> Case::readVolume(std::string_view) const;
template Result<Volume<float>> Case::readVolume(std::string_view) const;
template Result<Volume<TissueFractions>> Case::readVolume(std::string_view) const;
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const Volume<std::int16_t>&, const Attributes&,
                                          const std::vector<std::string>&);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const Volume<std::uint8_t>&, const Attributes&,
                                          const std::vector<std::string>&);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&, const Volume<float>&,
                                          const Attributes&, const std::vector<std::string>&);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const Volume<TissueFractions>&, const Attributes&,
                                          const std::vector<std::string>&);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const BoxedVolume<std::int16_t>&, const Attributes&,
                                          const std::vector<std::string>&, int);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const BoxedVolume<std::uint8_t>&, const Attributes&,
                                          const std::vector<std::string>&, int);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const BoxedVolume<float>&, const Attributes&,
                                          const std::vector<std::string>&, int);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const BoxedVolume<TissueFractions>&, const Attributes&,
                                          const std::vector<std::string>&, int);

}  // namespace haustra::store
