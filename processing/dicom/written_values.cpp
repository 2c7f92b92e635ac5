#include "dicom/written_values.h"

#include <cstdio>

namespace haustra::dicom {

std::string uidOf(const std::string& name) {
    using Wide = unsigned __int128;
    Wide hash = (Wide(0x6c62272e07bb0142) << 64) | 0x62b821756295c58d;
    const Wide prime = (Wide(1) << 88) | 0x13b;
    for (unsigned char c : name)
        hash = (hash ^ c) * prime;
    std::string digits;
    for (; hash != 0; hash /= 10)
        digits.insert(digits.begin(), char('0' + int(hash % 10)));
    return "2.25." + (digits.empty() ? "0" : digits);
}

std::string decimal(double value) {
    char text[40];
    for (int digits = 17; digits > 0; --digits) {
        if (std::snprintf(text, sizeof text, "%.*g", digits, value) <= 16) break;
    }
    return text;
}

}  // namespace haustra::dicom
