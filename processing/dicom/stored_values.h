// From stored pixel values to Hounsfield units (DICOM PS3.3 C.7.6.3.1, C.11.1.1.2; PS3.5 8.1.1).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace haustra::dicom {

/// How a value lies in its memory cell.
struct StoredFormat {
    int bitsAllocated = 16;  ///< 8 or 16
    int bitsStored = 16;     ///< 1 … bitsAllocated
    int highBit = 15;
    bool isSigned = false;

    struct PaddingRange {
        int first = 0, last = 0;  ///< inclusive, as stored values
        bool operator==(const PaddingRange&) const = default;
    };
    std::optional<PaddingRange> padding;  ///< values that stand for "outside the field of view"

    bool valid() const;
    bool operator==(const StoredFormat&) const = default;
};

/// HU = slope · stored + intercept.
struct Rescale {
    double slope = 1.0;
    double intercept = 0.0;
    bool operator==(const Rescale&) const = default;
};

/// What pixels outside the field of view become.
inline constexpr std::int16_t paddingHu = -1024;

/// The HU of each 16-bit pattern that can lie in a cell, so that decoding a pixel is one lookup.
/// Values beyond int16 are clamped; in an image padded with values below air, so are values below
/// −1024.
class HuTable {
public:
    /// `format` must be valid().
    HuTable(const StoredFormat& format, const Rescale& rescale);

    std::int16_t operator[](std::uint16_t cell) const { return hu_[cell]; }
    bool isOf(const StoredFormat& format, const Rescale& rescale) const {
        return format == format_ && rescale == rescale_;
    }

private:
    StoredFormat format_;
    Rescale rescale_;
    std::array<std::int16_t, 65536> hu_;
};

}  // namespace haustra::dicom
