// A case's triangle meshes: from memory to product files and back.
#include "store/case_store.h"
#include "store/product_file.h"

#include <cmath>
#include <cstring>
#include <span>

namespace haustra::store {
namespace {

static_assert(sizeof(glm::dvec3) == meshVertexBytes && sizeof(glm::ivec3) == meshTriangleBytes);

}  // namespace

Result<TriMesh> Case::readMesh(std::string_view product) const {
    const auto mapped = TRY(map(product));
    TRY(checkContent(mapped, Content::mesh, product));
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

Result<void> Case::publishMesh(std::string_view product, const ProductKey& key, const TriMesh& mesh,
                               const Attributes& attributes,
                               const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    const ProductEntry entry{std::string(product), key,
                             productFileName(product, key.hex, Content::mesh)};
    ProductHeader header{Content::mesh, {}, digestFromHex(key.hex), {}, attributes};
    header.grid.size = TRY(elementNumbers(
        Content::mesh, {mesh.vertices.size(), mesh.triangles.size(), 1}, folder_ / entry.file));
    return writeProduct(
               folder_, entry.file, header,
               {std::as_bytes(std::span(mesh.vertices)), std::as_bytes(std::span(mesh.triangles))})
        .and_then([&] { return announce(entry, outdated); });
}

}  // namespace haustra::store
