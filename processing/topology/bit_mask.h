// A mask of one bit a voxel with a border of zeros, from which neighbourhoods are read fast.
#pragma once

#include "core/simple_point.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::topology {

/// Voxels from (−1, −1, −1) to `size` along each axis; those beyond the grid are 0 and stay so.
/// Voxel (i, j, k) is bit i + 1 of its row. Rows are whole 64-bit words that end with a bit of the
/// border. Reading is safe from any number of threads; writing is, of different rows.
class BitMask {
public:
    explicit BitMask(glm::ivec3 size)
        : size_(size),
          rowWords_((std::size_t(size.x) + 2 + 63) / 64),
          sliceWords_(rowWords_ * (std::size_t(size.y) + 2)),
          words_(sliceWords_ * (std::size_t(size.z) + 2) + 1, 0) {}

    glm::ivec3 size() const { return size_; }
    std::size_t rowWords() const { return rowWords_; }
    /// j from −1 to size.y, k from −1 to size.z.
    const std::uint64_t* row(int j, int k) const { return words_.data() + rowBegin(j, k); }
    std::uint64_t* row(int j, int k) { return words_.data() + rowBegin(j, k); }

    bool test(glm::ivec3 v) const {
        return row(v.y, v.z)[std::size_t(v.x + 1) / 64] >> (std::size_t(v.x + 1) % 64) & 1u;
    }
    /// Of voxels on the grid alone.
    void set(glm::ivec3 v) {
        row(v.y, v.z)[std::size_t(v.x + 1) / 64] |= std::uint64_t(1) << (std::size_t(v.x + 1) % 64);
    }
    void reset(glm::ivec3 v) {
        row(v.y, v.z)[std::size_t(v.x + 1) / 64] &=
            ~(std::uint64_t(1) << (std::size_t(v.x + 1) % 64));
    }

    /// Sets, or clears, what `other`, of the same size, holds.
    void add(const BitMask& other) {
        for (std::size_t n = 0; n < words_.size(); ++n)
            words_[n] |= other.words_[n];
    }
    void remove(const BitMask& other) {
        for (std::size_t n = 0; n < words_.size(); ++n)
            words_[n] &= ~other.words_[n];
    }

    std::size_t count() const {
        std::size_t sum = 0;
        for (const std::uint64_t word : words_)
            sum += std::size_t(std::popcount(word));
        return sum;
    }

    /// Bit (dx+1) + 3 (dy+1) + 9 (dz+1) for each of the 27 voxels around v, itself included.
    Neighbourhood around(glm::ivec3 v) const {
        const auto* bytes =
            reinterpret_cast<const unsigned char*>(row(v.y - 1, v.z - 1)) + std::size_t(v.x) / 8;
        const unsigned shift = unsigned(v.x) % 8;
        Neighbourhood found = 0;
        for (unsigned dz = 0; dz < 3; ++dz) {
            for (unsigned dy = 0; dy < 3; ++dy) {
                std::uint16_t near;  // little-endian, as every target of Haustra is
                std::memcpy(&near, bytes + 8 * (dz * sliceWords_ + dy * rowWords_), 2);
                found |= (Neighbourhood(near) >> shift & 7u) << (3 * dy + 9 * dz);
            }
        }
        return found;
    }

private:
    std::size_t rowBegin(int j, int k) const {
        return std::size_t(j + 1) * rowWords_ + std::size_t(k + 1) * sliceWords_;
    }

    glm::ivec3 size_;
    std::size_t rowWords_, sliceWords_;
    std::vector<std::uint64_t> words_;
};

}  // namespace haustra::topology
