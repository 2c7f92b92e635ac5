#include "store/content.h"

#include <algorithm>
#include <string>

namespace haustra::store {
namespace {

constexpr std::size_t mostVoxelsOrSamples = std::size_t(1) << 24;
constexpr std::size_t mostMeshElements = std::size_t(1) << 28;

template <class T>
std::size_t voxelBytes(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) * sizeof(T);
}

template <class T>
constexpr ContentKind volumeKind(const char* description) {
    return {volumeOf<T>, description, ".hvol", true, 3, mostVoxelsOrSamples, voxelBytes<T>};
}

constexpr ContentKind kinds[] = {
    volumeKind<std::int16_t>("a volume of 16-bit integers"),
    volumeKind<std::uint8_t>("a volume of bytes"),
    volumeKind<float>("a volume of floats"),
    {Content::centerline, "a centerline", ".hline", false, 1, mostVoxelsOrSamples,
     [](glm::ivec3 samples) { return std::size_t(samples.x) * centerlineSampleBytes; }},
    volumeKind<TissueFractions>("a volume of tissue fractions"),
    {Content::mesh, "a mesh", ".hmesh", false, 2, mostMeshElements,
     [](glm::ivec3 mesh) {
         return std::size_t(mesh.x) * meshVertexBytes + std::size_t(mesh.y) * meshTriangleBytes;
     }},
    {Content::flatMap, "a flat map", ".hflat", false, 3, mostMeshElements,
     [](glm::ivec3 map) {
         return sizeof(double) + std::size_t(map.x) * flatMapVertexBytes +
                std::size_t(map.y) * flatMapTriangleBytes + std::size_t(map.z) * flatMapCameraBytes;
     }},
    {Content::text, "a text", ".htext", false, 1, mostVoxelsOrSamples,
     [](glm::ivec3 text) { return std::size_t(text.x); }},
};

}  // namespace

std::span<const ContentKind> contentKinds() {
    return kinds;
}

const ContentKind* kindOf(Content content) {
    const auto found = std::ranges::find(kinds, content, &ContentKind::content);
    return found == std::end(kinds) ? nullptr : found;
}

Result<glm::ivec3> elementNumbers(Content content, const std::array<std::size_t, 3>& counts,
                                  const std::filesystem::path& file) {
    const ContentKind& kind = *kindOf(content);
    if (std::ranges::max(counts) > kind.mostElements)
        return fail(ErrorKind::unsupported,
                    std::string(kind.description) + " of " +
                        std::to_string(std::ranges::max(counts)) +
                        " elements is too large to store",
                    file.string());
    return glm::ivec3(counts[0], counts[1], counts[2]);
}

}  // namespace haustra::store
