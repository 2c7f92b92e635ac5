#include "store/product_file.h"

#include "core/durable_file.h"
#include "core/parallel.h"
#include "store/lost_pages.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace haustra::store {
namespace {

static_assert(std::endian::native == std::endian::little, "product files are little endian");

constexpr char magic[8] = {'H', 'A', 'U', 'S', 'T', 'R', 'A', '\n'};
constexpr std::uint32_t layoutVersion = 1;
constexpr std::size_t valuesAlignment = 4096;

// The fixed part of the file, byte for byte.
struct FixedHeader {
    char magic[8];
    std::uint32_t version;
    std::uint32_t content;
    std::uint32_t size[3];
    std::uint32_t attributesBytes;
    double patientFromVoxel[12];
    std::uint64_t valuesOffset;
    std::uint64_t valuesBytes;
    Digest key;
    Digest valuesDigest;
    Digest headerDigest;
};
static_assert(sizeof(FixedHeader) == 240 && std::is_trivially_copyable_v<FixedHeader>);

Digest headerDigest(const FixedHeader& fixed, std::string_view attributes) {
    Sha256 hash;
    hash.add(std::as_bytes(std::span(&fixed, 1)).first(offsetof(FixedHeader, headerDigest)));
    hash.add(attributes);
    return hash.finish();
}

std::size_t alignedOffset(std::size_t attributesBytes) {
    const std::size_t end = sizeof(FixedHeader) + attributesBytes;
    return (end + valuesAlignment - 1) / valuesAlignment * valuesAlignment;
}

tl::unexpected<Error> damaged(const std::string& what, const std::filesystem::path& file) {
    return fail(ErrorKind::badInput, "the product is damaged: " + what, file.string());
}

bool writeAt(int descriptor, std::size_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::pwrite(descriptor, bytes.data(), bytes.size(), off_t(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        bytes = bytes.subspan(std::size_t(count)), offset += std::size_t(count);
    }
    return true;
}

/// Writes what is not zero: the file is as long as it will be, and holds zeros.
bool writeSparsely(int descriptor, std::size_t offset, std::span<const std::byte> bytes) {
    constexpr std::size_t pieceBytes = std::size_t(1) << 16;
    const auto isZero = [](std::span<const std::byte> piece) {
        return piece[0] == std::byte(0) &&
               std::memcmp(piece.data(), piece.data() + 1, piece.size() - 1) == 0;
    };
    // As few writes as the zeros let be.
    std::size_t from = 0;
    for (std::size_t at = 0; at < bytes.size(); at += pieceBytes) {
        const auto piece = bytes.subspan(at, std::min(pieceBytes, bytes.size() - at));
        if (!isZero(piece)) continue;
        if (!writeAt(descriptor, offset + from, bytes.subspan(from, at - from))) return false;
        from = at + piece.size();
    }
    return writeAt(descriptor, offset + from, bytes.subspan(from));
}

/// The values' blockwise digest; none where they cannot be written, and errno says why.
std::optional<Digest> writeValues(int descriptor, std::size_t offset, std::size_t bytes,
                                  const ValueSource& values, int threads) {
    std::vector<Digest> blocks((bytes + digestBlockBytes - 1) / digestBlockBytes);
    std::atomic<int> error{0};
    // A buffer serves several blocks.
    parallelFor(blocks.size(), 8, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::byte> buffer(std::min(digestBlockBytes, bytes));
        for (std::size_t n = begin; n < end && error == 0; ++n) {
            const std::size_t start = n * digestBlockBytes;
            const auto block = std::span(buffer).first(std::min(digestBlockBytes, bytes - start));
            values(start, block);
            Sha256 hash;
            hash.add(block);
            blocks[n] = hash.finish();
            if (!writeSparsely(descriptor, offset + start, block)) error = errno;
        }
    });
    if (error != 0) {
        errno = error;
        return std::nullopt;
    }
    return blockwiseDigest(blocks);
}

Result<std::map<std::string, std::string>> parseAttributes(std::string_view text,
                                                           const std::filesystem::path& file) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) return damaged("its attributes are not JSON", file);
    std::map<std::string, std::string> attributes;
    for (const auto& [name, value] : json.items()) {
        if (!value.is_string()) return damaged("its attribute " + name + " is not a text", file);
        attributes[name] = value.get<std::string>();
    }
    return attributes;
}

}  // namespace

Result<MappedProduct> mapProduct(const std::filesystem::path& file) {
    const auto mapping = TRY(MappedFile::open(file, sizeof(FixedHeader)));
    const std::byte* const bytes = mapping->bytes().data();
    const std::size_t length = mapping->bytes().size();

    FixedHeader fixed;
    std::memcpy(&fixed, bytes, sizeof fixed);
    if (std::memcmp(fixed.magic, magic, sizeof magic) != 0) {
        return damaged("it does not start as a product does", file);
    }
    if (fixed.version != layoutVersion) {
        return fail(ErrorKind::unsupported,
                    "the product has layout " + std::to_string(fixed.version) + "; " +
                        std::to_string(layoutVersion) + " is read",
                    file.string());
    }
    if (fixed.attributesBytes > length - sizeof fixed) return damaged("it is cut short", file);
    const std::string_view attributes(reinterpret_cast<const char*>(bytes) + sizeof fixed,
                                      fixed.attributesBytes);
    if (headerDigest(fixed, attributes) != fixed.headerDigest) {
        return damaged("its header does not match its checksum", file);
    }

    MappedProduct product;
    product.header.content = Content(fixed.content);
    const ContentKind* const kind = kindOf(product.header.content);
    if (!kind) return damaged("it holds an unknown kind of content", file);
    for (int axis = 0; axis < 3; ++axis) {
        if (fixed.size[axis] > kind->mostElements ||
            (axis >= kind->counts && fixed.size[axis] != 1))
            return damaged("its size is absurd", file);
        product.header.grid.size[axis] = int(fixed.size[axis]);
    }
    for (int n = 0; n < 12; ++n) {
        product.header.grid.patientFromVoxel[n / 3][n % 3] = fixed.patientFromVoxel[n];
    }
    if (kind->hasGrid) {
        TRY(checkGrid(product.header.grid, file.string()));
    }
    // The sizes are bounded now, so that nothing overflows.
    if (fixed.valuesOffset != alignedOffset(fixed.attributesBytes) ||
        fixed.valuesBytes != kind->valuesBytes(product.header.grid.size)) {
        return damaged("its header contradicts itself", file);
    }
    if (length < fixed.valuesOffset || length - fixed.valuesOffset != fixed.valuesBytes) {
        return damaged("it has " + std::to_string(length) + " bytes instead of " +
                           std::to_string(fixed.valuesOffset + fixed.valuesBytes),
                       file);
    }
    auto parsed = TRY(parseAttributes(attributes, file));
    product.header.attributes = std::move(parsed);
    product.header.key = fixed.key;
    product.header.valuesDigest = fixed.valuesDigest;
    product.values = {bytes + fixed.valuesOffset, std::size_t(fixed.valuesBytes)};
    product.mapping = mapping;
    product.file = file;
    return product;
}

Result<void> writeProduct(const std::filesystem::path& folder, const std::string& name,
                          ProductHeader header, std::size_t bytes, const ValueSource& values,
                          int threads) {
    // Bytes that are not UTF-8 become U+FFFD: an attribute must not be able to stop a product.
    const std::string attributes =
        nlohmann::json(header.attributes)
            .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    FixedHeader fixed{};
    std::memcpy(fixed.magic, magic, sizeof magic);
    fixed.version = layoutVersion;
    fixed.content = std::uint32_t(header.content);
    for (int axis = 0; axis < 3; ++axis)
        fixed.size[axis] = std::uint32_t(header.grid.size[axis]);
    for (int n = 0; n < 12; ++n) {
        fixed.patientFromVoxel[n] = header.grid.patientFromVoxel[n / 3][n % 3];
    }
    fixed.attributesBytes = std::uint32_t(attributes.size());
    fixed.valuesOffset = alignedOffset(attributes.size());
    fixed.valuesBytes = bytes;
    fixed.key = header.key;
    const auto write = [&](int descriptor) {
        const auto length = off_t(fixed.valuesOffset + fixed.valuesBytes);
        if (::ftruncate(descriptor, length) != 0) return false;
        const auto digest =
            writeValues(descriptor, fixed.valuesOffset, fixed.valuesBytes, values, threads);
        if (!digest) return false;
        fixed.valuesDigest = *digest;
        fixed.headerDigest = headerDigest(fixed, attributes);
        return writeAt(descriptor, 0, std::as_bytes(std::span(&fixed, 1))) &&
               writeAt(descriptor, sizeof fixed, std::as_bytes(std::span(attributes)));
    };
    return writeDurably(folder / name, write, 0640);
}

Result<void> writeProduct(const std::filesystem::path& folder, const std::string& name,
                          ProductHeader header,
                          const std::vector<std::span<const std::byte>>& parts) {
    std::size_t bytes = 0;
    for (const auto part : parts)
        bytes += part.size();
    // A block is what the parts have of it.
    const auto values = [&](std::size_t offset, std::span<std::byte> out) {
        for (const auto part : parts) {
            if (offset < part.size() && !out.empty()) {
                const auto piece = part.subspan(offset, std::min(out.size(), part.size() - offset));
                std::ranges::copy(piece, out.begin());
                out = out.subspan(piece.size());
                offset = 0;
            } else {
                offset -= std::min(offset, part.size());
            }
        }
    };
    return writeProduct(folder, name, std::move(header), bytes, values);
}

std::string productFileName(std::string_view product, std::string_view keyHex, Content content) {
    return std::string(product) + "-" + std::string(keyHex.substr(0, 16)) +
           kindOf(content)->extension;
}

bool isProductFileName(const std::filesystem::path& name) {
    return std::ranges::any_of(contentKinds(), [&](const ContentKind& kind) {
        return name.extension() == kind.extension;
    });
}

Result<void> checkContent(const MappedProduct& mapped, Content wanted, std::string_view product) {
    if (mapped.header.content == wanted) return {};
    return fail(ErrorKind::badInput,
                std::string(product) + " is " + kindOf(mapped.header.content)->description +
                    ", not " + kindOf(wanted)->description,
                mapped.file.parent_path().string());
}

Result<void> checkWhole(const MappedProduct& product) {
    if (isWhole(product.values.data())) return {};
    return fail(ErrorKind::io, "the product was cut short, or its disk fails, while it was read",
                product.file.string());
}

Result<void> checkValues(const MappedProduct& product) {
    if (blockwiseDigest(product.values) != product.header.valuesDigest) {
        TRY(checkWhole(product));
        return damaged("its values do not match their checksum", product.file);
    }
    return {};
}

}  // namespace haustra::store
