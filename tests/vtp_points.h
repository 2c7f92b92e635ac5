// Reads the polyline of a VTK XML PolyData file (.vtp): appended, base64, zlib-compressed, as VMTK
// writes centerlines. Only for comparing with such a file; throws std::runtime_error.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <zlib.h>

namespace haustra::tests {

class AppendedVtp {
public:
    explicit AppendedVtp(const std::filesystem::path& file) {
        std::ifstream in(file, std::ios::binary);
        text_.assign(std::istreambuf_iterator<char>(in), {});
        appended_ = find('_', find("<AppendedData", 0)) + 1;
    }
    /// The points, in the order in which the file's first line joins them.
    std::vector<glm::dvec3> polyline() const {
        const auto points = array<float>(find("Name=\"Points\"", 0));
        const auto order = array<std::int64_t>(find("Name=\"connectivity\"", find("<Lines>", 0)));
        std::vector<glm::dvec3> line;
        for (const std::int64_t n : order) {
            const auto at = 3 * std::size_t(n);
            if (at + 2 >= points.size()) throw std::runtime_error("a .vtp line leaves its points");
            line.emplace_back(points[at], points[at + 1], points[at + 2]);
        }
        return line;
    }

private:
    template <class Wanted>
    std::size_t find(Wanted wanted, std::size_t from) const {
        const std::size_t at = text_.find(wanted, from);
        if (at == std::string::npos) throw std::runtime_error("not such a .vtp file");
        return at;
    }
    std::vector<std::uint8_t> fromBase64(std::size_t at, std::size_t bytes) const {
        static const std::string alphabet =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::vector<std::uint8_t> decoded;
        std::uint32_t bits = 0;
        for (int held = 0; decoded.size() < bytes; ++at) {
            const std::size_t value = alphabet.find(text_.at(at));
            if (value == std::string::npos) throw std::runtime_error("bad base64 in a .vtp file");
            bits = bits << 6 | std::uint32_t(value);
            if ((held += 6) >= 8) decoded.push_back(std::uint8_t(bits >> (held -= 8)));
        }
        return decoded;
    }
    /// The array whose offset attribute follows position `at`: a header of 32-bit block count,
    /// block size, last block's size and each block's compressed size, then the compressed blocks.
    template <class T>
    std::vector<T> array(std::size_t at) const {
        const std::size_t offset = find("offset=\"", at) + 8;
        const std::size_t start = appended_ + std::stoul(text_.substr(offset, 20));
        std::vector<std::uint32_t> header(3);
        std::memcpy(header.data(), fromBase64(start, 12).data(), 12);
        const std::size_t blocks = header[0], headerBytes = 4 * (3 + blocks);
        header.resize(3 + blocks);
        std::memcpy(header.data(), fromBase64(start, headerBytes).data(), headerBytes);
        std::size_t packedBytes = 0;
        for (std::size_t n = 0; n < blocks; ++n)
            packedBytes += header[3 + n];
        const auto packed = fromBase64(start + (headerBytes + 2) / 3 * 4, packedBytes);
        std::vector<std::uint8_t> bytes;
        std::size_t from = 0;
        for (std::size_t n = 0; n < blocks; ++n) {
            uLongf size = n + 1 == blocks && header[2] ? header[2] : header[1];
            std::vector<std::uint8_t> block(size);
            if (uncompress(block.data(), &size, packed.data() + from, header[3 + n]) != Z_OK) {
                throw std::runtime_error("bad zlib data in a .vtp file");
            }
            bytes.insert(bytes.end(), block.begin(), block.begin() + std::ptrdiff_t(size));
            from += header[3 + n];
        }
        std::vector<T> values(bytes.size() / sizeof(T));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
        return values;
    }

    std::string text_;
    std::size_t appended_ = 0;
};

}  // namespace haustra::tests
