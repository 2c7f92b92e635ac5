#include "dicom/stored_values.h"

#include <algorithm>
#include <cmath>

namespace haustra::dicom {

bool StoredFormat::valid() const {
    return (bitsAllocated == 8 || bitsAllocated == 16) && bitsStored >= 1 &&
           bitsStored <= bitsAllocated && highBit < bitsAllocated && highBit + 1 >= bitsStored;
}

HuTable::HuTable(const StoredFormat& format, const Rescale& rescale) : rescale_(rescale) {
    const int shift = format.highBit + 1 - format.bitsStored;
    const int mask = (1 << format.bitsStored) - 1;
    const int signBit = 1 << (format.bitsStored - 1);
    // Lossy compression softens padding: what lies below air in a padded image is padding too.
    const bool paddedBelowAir =
        format.padding && rescale.slope * format.padding->first + rescale.intercept <= paddingHu &&
        rescale.slope * format.padding->last + rescale.intercept <= paddingHu;
    const double lowest = paddedBelowAir ? double(paddingHu) : -32768.0;
    for (int cell = 0; cell < 65536; ++cell) {
        int stored = (cell >> shift) & mask;
        if (format.isSigned && (stored & signBit)) stored -= mask + 1;
        // Some scanners pad with a pattern that uses the bits above High Bit.
        const int whole = format.isSigned ? int(std::int16_t(cell)) : cell;
        auto padded = [&](int value) {
            return format.padding && value >= format.padding->first &&
                   value <= format.padding->last;
        };
        const double hu = rescale.slope * stored + rescale.intercept;
        hu_[std::size_t(cell)] = padded(stored) || padded(whole)
                                     ? paddingHu
                                     : std::int16_t(std::lround(std::clamp(hu, lowest, 32767.0)));
    }
}

}  // namespace haustra::dicom
