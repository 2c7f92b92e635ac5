// What products can be, and how their files (store/product_file.h) hold it: three numbers of
// elements (1 where one counts nothing), then the values as they lie in memory.
//
//   volume      voxels along i, j, k: the voxels, i fastest; of tissue fractions two bytes each
//               (air and tagged, in 255ths)
//   centerline  samples: six doubles each, x, y, z, arc, radius (mm), gap (0 or 1)
//   mesh        vertices, triangles: the vertices, three doubles each (LPS, mm); the triangles,
//               three int32 each, counted from 0
//   flat map    vertices, triangles, cameras: its height, a double; the vertices, three doubles
//               each (LPS, mm); their flat places, two doubles each (unit: the circumference); the
//               cameras, four doubles each (LPS and arc, mm); the triangles, three int32 each; for
//               each triangle the one of the closed surface that it is a part of, an int32; and for
//               each vertex its camera, an int32
//   text        bytes: UTF-8, not ended by a zero
//
// A kind of content is said here and in content.cpp, and has a file that takes it to product files
// and back: volume_product.cpp, mesh_product.cpp …
#pragma once

#include "core/result.h"
#include "core/tissue.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include <glm/glm.hpp>

namespace haustra::store {

/// The numbers stand in product files.
enum class Content : std::uint32_t {
    int16Volume = 1,
    uint8Volume = 2,
    floatVolume = 3,
    centerline = 4,
    fractionsVolume = 5,
    mesh = 6,
    flatMap = 7,
    text = 8,
};

/// The content of a Volume<T>; std::int16_t, std::uint8_t, float or TissueFractions.
template <class T>
inline constexpr Content volumeOf = Content{};
template <>
inline constexpr Content volumeOf<std::int16_t> = Content::int16Volume;
template <>
inline constexpr Content volumeOf<std::uint8_t> = Content::uint8Volume;
template <>
inline constexpr Content volumeOf<float> = Content::floatVolume;
template <>
inline constexpr Content volumeOf<TissueFractions> = Content::fractionsVolume;

/// How product files hold one kind of content. A file says three numbers of elements.
struct ContentKind {
    Content content;
    const char* description;   ///< "a volume of bytes"
    const char* extension;     ///< of the product's file: ".hvol"
    bool hasGrid;              ///< the elements are a grid's voxels
    int counts;                ///< how many of the three numbers count something; the rest are 1
    std::size_t mostElements;  ///< each of the numbers is at most this
    std::size_t (*valuesBytes)(glm::ivec3 elements);
};

/// Nullptr where the number is no content's.
const ContentKind* kindOf(Content content);

std::span<const ContentKind> contentKinds();

/// `counts` as the three numbers of elements of a product's file. Fails (unsupported), naming the
/// file, where one is more than the content may have: such a file would be refused when read.
Result<glm::ivec3> elementNumbers(Content content, const std::array<std::size_t, 3>& counts,
                                  const std::filesystem::path& file);

inline constexpr std::size_t centerlineSampleBytes = 6 * sizeof(double);
inline constexpr std::size_t meshVertexBytes = 3 * sizeof(double);
inline constexpr std::size_t meshTriangleBytes = 3 * sizeof(std::int32_t);
inline constexpr std::size_t flatMapVertexBytes = 5 * sizeof(double) + sizeof(std::int32_t);
inline constexpr std::size_t flatMapTriangleBytes = 4 * sizeof(std::int32_t);
inline constexpr std::size_t flatMapCameraBytes = 4 * sizeof(double);

}  // namespace haustra::store
