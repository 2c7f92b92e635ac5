// The file of one product: a header, attributes as JSON, then the values as they lie in memory.
//
//   offset  bytes  field (all little endian)
//        0      8  "HAUSTRA\n"
//        8      4  version of this layout, 1
//       12      4  content: 1 int16 volume, 2 uint8 volume, 3 float volume, 4 centerline,
//                  5 volume of tissue fractions, 6 mesh, 7 flat map, 8 text
//       16     12  size i, j, k (volume); samples, 1, 1 (centerline); vertices, triangles, 1
//       (mesh); bytes, 1, 1 (text);
//                  vertices, triangles, cameras (flat map)
//       28      4  bytes of attributes, A
//       32     96  patientFromVoxel, four columns of three doubles
//      128      8  offset of the values, a multiple of 4096
//      136      8  bytes of values
//      144     32  product key
//      176     32  blockwise SHA-256 of the values (4 MiB blocks)
//      208     32  SHA-256 of bytes 0…207 and the attributes
//      240      A  attributes, a JSON object of strings
//
// Values: a volume's voxels, i fastest (of fractions: two bytes, air and tagged in 255ths); a
// centerline's samples, six doubles each: x, y, z, arc, radius (mm), gap (0 or 1); a mesh's
// vertices, three doubles each (LPS, mm), then its triangles, three int32 each, counted from 0. A
// flat map: its height, a double; its vertices, three doubles each (LPS, mm); their flat places,
// two doubles each (unit: the circumference); its cameras, four doubles each (LPS and arc, mm); its
// triangles, three int32 each; for each triangle the one of the closed surface that it is a part
// of, an int32; and for each vertex its camera, an int32. A text: UTF-8, not ended by a zero.
//
// The values end the file. A reader believes no field before the file's length bears it out.
#pragma once

#include "core/grid.h"
#include "core/result.h"
#include "store/sha256.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>

namespace haustra::store {

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
inline constexpr std::size_t centerlineSampleBytes = 6 * sizeof(double);
inline constexpr std::size_t meshVertexBytes = 3 * sizeof(double);
inline constexpr std::size_t meshTriangleBytes = 3 * sizeof(std::int32_t);
inline constexpr std::size_t flatMapVertexBytes = 5 * sizeof(double) + sizeof(std::int32_t);
inline constexpr std::size_t flatMapTriangleBytes = 4 * sizeof(std::int32_t);
inline constexpr std::size_t flatMapCameraBytes = 4 * sizeof(double);
inline constexpr std::size_t mostMeshElements = std::size_t(1) << 28;

/// Everything of a product file but its values.
struct ProductHeader {
    Content content = Content::int16Volume;
    Grid grid;  ///< its size is the number of elements, as the file has it
    Digest key{};
    Digest valuesDigest{};
    std::map<std::string, std::string> attributes;
};

/// A product file, memory-mapped read-only; `mapping` keeps `values` alive even after the file has
/// been replaced or removed.
struct MappedProduct {
    ProductHeader header;
    std::span<const std::byte> values;
    std::shared_ptr<const void> mapping;
    std::filesystem::path file;
};

/// Maps a product file. Fails, naming the file, where it is cut short, too long or inconsistent.
/// Reads the header only, not the values: a mesh's or a flat map's are still to be checked.
Result<MappedProduct> mapProduct(const std::filesystem::path& file);

/// Fills `out` with the values from byte `offset` on. Called from several threads, each block of
/// 4 MiB once.
using ValueSource = std::function<void(std::size_t offset, std::span<std::byte> out)>;

/// Publishes `folder`/`name` as writeDurably does, of values that are made block by block as they
/// are written: they are never in memory all at once. What is zero takes no room on the disk.
/// `header.valuesDigest` is computed here. The same file for any number of threads (≤ 0: all
/// cores).
Result<void> writeProduct(const std::filesystem::path& folder, const std::string& name,
                          ProductHeader header, std::size_t bytes, const ValueSource& values,
                          int threads = 0);

/// The same of values in memory.
Result<void> writeProduct(const std::filesystem::path& folder, const std::string& name,
                          ProductHeader header, std::span<const std::byte> values);

/// Fails (io) where a page of the values that has been read was not there (isWhole()).
Result<void> checkWhole(const MappedProduct& product);

/// Fails where the values are not those that were written. Reads all of them.
Result<void> checkValues(const MappedProduct& product);

}  // namespace haustra::store
