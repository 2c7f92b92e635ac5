#include "nifti/gzip_stream.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <new>
#include <vector>

#include <zlib.h>

namespace haustra::nifti {
namespace {

constexpr std::size_t blockBytes = 1 << 20;
constexpr std::size_t blocksInFlight = 32;
constexpr unsigned readAtOnce = 1u << 26;  // gzread counts in unsigned int
// Deflate's best ratio: 258 bytes for two bits.
constexpr std::uint64_t bestRatio = 1032;

gzFile handle(const std::shared_ptr<void>& stream) {
    return static_cast<gzFile>(stream.get());
}

/// Raw deflate of one block; not the last, it ends on a byte with an empty stored block.
std::vector<unsigned char> deflateBlock(std::span<const std::byte> block, bool last) {
    z_stream stream{};
    if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, -MAX_WBITS, MAX_MEM_LEVEL,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
        throw std::bad_alloc();
    }
    std::vector<unsigned char> packed(deflateBound(&stream, uLong(block.size())) + 16);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(block.data()));
    stream.avail_in = uInt(block.size());
    stream.next_out = packed.data();
    stream.avail_out = uInt(packed.size());
    deflate(&stream, last ? Z_FINISH : Z_SYNC_FLUSH);  // the bound leaves room for all of it
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

void put(std::ostream& out, std::span<const unsigned char> bytes) {
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

void putLittleEndian(std::ostream& out, std::uint32_t value) {
    const std::array<unsigned char, 4> bytes = {
        static_cast<unsigned char>(value), static_cast<unsigned char>(value >> 8),
        static_cast<unsigned char>(value >> 16), static_cast<unsigned char>(value >> 24)};
    put(out, bytes);
}

}  // namespace

Result<MaybeGzipFile> MaybeGzipFile::open(const std::filesystem::path& file) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(file, unknown))
        return fail(ErrorKind::notFound, "there is no such file", file.string());
    const std::uint64_t size = std::filesystem::file_size(file, unknown);
    gzFile opened = unknown ? nullptr : gzopen(file.c_str(), "rb");
    if (!opened) return fail(ErrorKind::io, "the file cannot be opened", file.string());
    MaybeGzipFile result;
    result.stream_ =
        std::shared_ptr<void>(opened, [](void* f) { gzclose(static_cast<gzFile>(f)); });
    result.place_ = file.string();
    gzbuffer(opened, 1 << 18);
    result.compressed_ = !gzdirect(opened);
    result.mostBytes_ = result.compressed_ ? size * bestRatio : size;
    return result;
}

Error MaybeGzipFile::error() const {
    int code = Z_OK;
    gzerror(handle(stream_), &code);
    return {ErrorKind::badInput,
            code == Z_DATA_ERROR ? "the compressed file is damaged" : "the file is truncated",
            place_};
}

Result<void> MaybeGzipFile::read(std::span<std::byte> bytes) {
    while (!bytes.empty()) {
        const unsigned take = unsigned(std::min<std::size_t>(bytes.size(), readAtOnce));
        const int got = gzread(handle(stream_), bytes.data(), take);
        if (got <= 0) return tl::make_unexpected(error());
        bytes = bytes.subspan(std::size_t(got));
    }
    return {};
}

Result<void> MaybeGzipFile::finish() {
    std::array<std::byte, 4096> rest;
    int got = 0;
    // What follows the volume in the file is none of it; a little of it brings up the checksum.
    for (int n = 0; n < 16 && (got = gzread(handle(stream_), rest.data(), rest.size())) > 0; ++n) {
    }
    int code = Z_OK;
    gzerror(handle(stream_), &code);
    if (got < 0 || code == Z_BUF_ERROR) return tl::make_unexpected(error());
    return {};
}

void writeGzip(std::ostream& out, std::span<const std::byte> head, const ByteSource& body,
               int threads) {
    constexpr std::array<unsigned char, 10> gzipHead = {0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 4, 255};
    put(out, gzipHead);
    uLong checksum =
        crc32(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(head.data()), uInt(head.size()));
    put(out, deflateBlock(head, body.size == 0));

    struct Block {
        std::vector<unsigned char> packed;
        uLong checksum = 0;
        std::size_t size = 0;
    };
    const std::size_t blocks = (body.size + blockBytes - 1) / blockBytes;
    for (std::size_t first = 0; first < blocks && out; first += blocksInFlight) {
        std::vector<Block> wave(std::min(blocksInFlight, blocks - first));
        parallelFor(wave.size(), 1, threads, [&](std::size_t n, std::size_t) {
            const std::size_t begin = (first + n) * blockBytes;
            std::vector<std::byte> room(std::min(blockBytes, body.size - begin));
            const auto block = body.part(begin, room);
            wave[n] = {deflateBlock(block, first + n + 1 == blocks),
                       crc32(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(block.data()),
                             uInt(block.size())),
                       block.size()};
        });
        for (const Block& block : wave) {
            put(out, block.packed);
            checksum = crc32_combine(checksum, block.checksum, z_off_t(block.size));
        }
    }
    putLittleEndian(out, std::uint32_t(checksum));
    putLittleEndian(out, std::uint32_t(head.size() + body.size));  // modulo 2^32, by the format
}

void writePlain(std::ostream& out, std::span<const std::byte> head, const ByteSource& body) {
    const auto put = [&](std::span<const std::byte> bytes) {
        out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    };
    put(head);
    std::vector<std::byte> room(std::min(blockBytes, body.size));
    for (std::size_t begin = 0; begin < body.size && out; begin += blockBytes)
        put(body.part(begin, std::span(room).first(std::min(blockBytes, body.size - begin))));
}

}  // namespace haustra::nifti
