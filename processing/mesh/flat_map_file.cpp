#include "mesh/flat_map_file.h"

#include "core/durable_file.h"
#include "mesh/file_writing.h"

namespace haustra::mesh {
namespace {

std::string objBytes(const FlatMap& map) {
    std::string bytes = "# LPS mm; vt in circumferences\n";
    for (const glm::dvec3& v : map.surface.vertices) {
        bytes += "v ";
        appendTextLine(bytes, v);
    }
    for (const glm::dvec2& at : map.flat) {
        bytes += "vt ";
        appendText(bytes, at.x, ' ');
        appendText(bytes, at.y, '\n');
    }
    for (const glm::ivec3& t : map.surface.triangles) {
        bytes += "f ";
        for (int c = 0; c < 3; ++c) {
            appendText(bytes, t[c] + 1, '/');
            appendText(bytes, t[c] + 1, c == 2 ? '\n' : ' ');
        }
    }
    return bytes;
}

std::string plyBytes(const FlatMap& map, const std::vector<std::uint8_t>& bridged) {
    const bool cameras = !map.cameras.empty();
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\ncomment LPS mm; s, t in circumferences\n"
        "element vertex " +
        std::to_string(map.surface.vertices.size()) +
        "\nproperty double x\nproperty double y\nproperty double z\n"
        "property double s\nproperty double t\n";
    if (cameras) bytes += "property int camera\nproperty double arc_mm\n";
    bytes += "element face " + std::to_string(map.surface.triangles.size()) +
             "\nproperty list uchar int vertex_indices\nproperty int source_triangle\n";
    if (!bridged.empty()) bytes += "property uchar bridge\n";
    if (cameras) {
        bytes += "element camera " + std::to_string(map.cameras.size()) +
                 "\nproperty double x\nproperty double y\nproperty double z\n"
                 "property double arc_mm\n";
    }
    bytes += "end_header\n";
    for (std::size_t v = 0; v < map.flat.size(); ++v) {
        appendRaw(bytes, map.surface.vertices[v]);
        appendRaw(bytes, map.flat[v]);
        if (!cameras) continue;
        appendRaw(bytes, map.camera[v]);
        appendRaw(bytes, map.cameras[std::size_t(map.camera[v])].arcMm);
    }
    for (std::size_t t = 0; t < map.surface.triangles.size(); ++t) {
        bytes.push_back(3);
        appendRaw(bytes, map.surface.triangles[t]);
        appendRaw(bytes, map.sourceTriangle[t]);
        if (!bridged.empty()) bytes.push_back(char(bridged[t]));
    }
    for (const FlatCamera& camera : map.cameras) {
        appendRaw(bytes, camera.positionMm);
        appendRaw(bytes, camera.arcMm);
    }
    return bytes;
}

}  // namespace

Result<void> writeFlatMap(const std::filesystem::path& file, const FlatMap& map,
                          const std::vector<std::uint8_t>& bridged) {
    if (!bridged.empty() && bridged.size() != map.surface.triangles.size())
        return fail(ErrorKind::badInput, "the bridges are of another flat map", file.string());
    const std::string ending = endingOf(file);
    if (ending == ".obj") return writeDurably(file, objBytes(map));
    if (ending == ".ply") return writeDurably(file, plyBytes(map, bridged));
    return fail(ErrorKind::unsupported, "a flat map's file name must end in .obj or .ply",
                file.string());
}

}  // namespace haustra::mesh
