// The file of one product: a header, attributes as JSON, then the values as they lie in memory.
//
//   offset  bytes  field (all little endian)
//        0      8  "HAUSTRA\n"
//        8      4  version of this layout, 1
//       12      4  content (store/content.h)
//       16     12  three numbers of elements, which the content says the meaning of
//       28      4  bytes of attributes, A
//       32     96  patientFromVoxel, four columns of three doubles
//      128      8  offset of the values, a multiple of 4096
//      136      8  bytes of values
//      144     32  product key
//      176     32  blockwise SHA-256 of the values (4 MiB blocks)
//      208     32  SHA-256 of bytes 0…207 and the attributes
//      240      A  attributes, a JSON object of strings
//
// The values end the file. A reader believes no field before the file's length bears it out.
#pragma once

#include "core/grid.h"
#include "core/result.h"
#include "store/content.h"
#include "store/sha256.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haustra::store {

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

/// The same of values in memory, one part after the other.
Result<void> writeProduct(const std::filesystem::path& folder, const std::string& name,
                          ProductHeader header,
                          const std::vector<std::span<const std::byte>>& parts);

/// "product-0123456789abcdef.hvol": its name, the first digits of its key, its content's extension.
std::string productFileName(std::string_view product, std::string_view keyHex, Content content);
/// True where the name ends as a product's of some content does.
bool isProductFileName(const std::filesystem::path& name);

/// Fails (badInput) where `mapped`, which is called `product`, holds another kind of content than
/// `wanted`.
Result<void> checkContent(const MappedProduct& mapped, Content wanted, std::string_view product);

/// Fails (io) where a page of the values that has been read was not there (isWhole()).
Result<void> checkWhole(const MappedProduct& product);

/// Fails where the values are not those that were written. Reads all of them.
Result<void> checkValues(const MappedProduct& product);

}  // namespace haustra::store
