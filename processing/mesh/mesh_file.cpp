#include "mesh/mesh_file.h"

#include "core/durable_file.h"
#include "core/text_file.h"
#include "mesh/file_writing.h"
#include "mesh/polygon_soup.h"

#include <cstring>
#include <new>
#include <optional>

namespace haustra::mesh {
namespace {

enum class Format { ply, obj, off, stl };

std::optional<Format> formatOf(const std::filesystem::path& file) {
    const std::string ending = endingOf(file);
    if (ending == ".ply") return Format::ply;
    if (ending == ".obj") return Format::obj;
    if (ending == ".off") return Format::off;
    if (ending == ".stl") return Format::stl;
    return {};
}

tl::unexpected<Error> unknownFormat(const std::filesystem::path& file) {
    return fail(ErrorKind::unsupported, "a mesh file's name must end in .ply, .obj, .off or .stl",
                file.string());
}

Result<TriMesh> meshOf(const std::string& bytes, Format format, const std::string& place) {
    const auto read = format == Format::ply   ? readPly
                      : format == Format::obj ? readObj
                      : format == Format::off ? readOff
                                              : readStl;
    auto soup = TRY(read(bytes, place));
    if (format == Format::stl) weldPoints(soup);
    return triangulated(soup, place);
}

// --------------------------------------------------------------------------------------- writing

// With `values`, of the faces' property of that name.
std::string plyBytes(const TriMesh& mesh, const std::string& property = {},
                     const std::vector<std::uint8_t>& values = {}) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\ncomment LPS mm\nelement vertex " +
        std::to_string(mesh.vertices.size()) +
        "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
        std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\n" +
        (values.empty() ? "" : "property uchar " + property + "\n") + "end_header\n";
    bytes.reserve(bytes.size() + 24 * mesh.vertices.size() + 13 * mesh.triangles.size());
    for (const glm::dvec3& v : mesh.vertices)
        appendRaw(bytes, v);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        bytes.push_back(3);
        appendRaw(bytes, mesh.triangles[t]);
        if (!values.empty()) bytes.push_back(char(values[t]));
    }
    return bytes;
}

std::string objBytes(const TriMesh& mesh) {
    std::string bytes = "# LPS mm\n";
    for (const glm::dvec3& v : mesh.vertices) {
        bytes += "v ";
        appendTextLine(bytes, v);
    }
    for (const glm::ivec3& t : mesh.triangles) {
        bytes += "f ";
        appendTextLine(bytes, t + 1);
    }
    return bytes;
}

std::string offBytes(const TriMesh& mesh) {
    std::string bytes = "OFF\n# LPS mm\n" + std::to_string(mesh.vertices.size()) + ' ' +
                        std::to_string(mesh.triangles.size()) + " 0\n";
    for (const glm::dvec3& v : mesh.vertices)
        appendTextLine(bytes, v);
    for (const glm::ivec3& t : mesh.triangles) {
        bytes += "3 ";
        appendTextLine(bytes, t);
    }
    return bytes;
}

std::string stlBytes(const TriMesh& mesh) {
    std::string bytes(80, '\0');
    std::strcpy(bytes.data(), "binary STL, LPS mm");
    appendRaw(bytes, std::uint32_t(mesh.triangles.size()));
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double length = glm::length(normal);
        appendRaw(bytes, glm::vec3(length > 0.0 ? normal / length : glm::dvec3(0.0)));
        for (const glm::dvec3& corner : {a, b, c})
            appendRaw(bytes, glm::vec3(corner));
        appendRaw(bytes, std::uint16_t(0));
    }
    return bytes;
}

}  // namespace

Result<TriMesh> readMesh(const std::filesystem::path& file) try {
    const auto format = formatOf(file);
    if (!format) return unknownFormat(file);
    const auto bytes = TRY(readTextFile(file));
    return meshOf(bytes, *format, file.string());
} catch (const std::bad_alloc&) {
    return fail(ErrorKind::io, "the mesh does not fit into memory", file.string());
}

Result<void> writeMesh(const std::filesystem::path& file, const TriMesh& mesh) {
    const auto format = formatOf(file);
    if (!format) return unknownFormat(file);
    const std::string bytes = *format == Format::ply   ? plyBytes(mesh)
                              : *format == Format::obj ? objBytes(mesh)
                              : *format == Format::off ? offBytes(mesh)
                                                       : stlBytes(mesh);
    return writeDurably(file, bytes);
}

Result<void> writePly(const std::filesystem::path& file, const TriMesh& mesh,
                      const std::string& property, const std::vector<std::uint8_t>& values) {
    return writeDurably(file, plyBytes(mesh, property, values));
}

}  // namespace haustra::mesh
