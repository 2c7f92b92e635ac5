// sRGB's transfer curve (IEC 61966-2-1): light adds up linearly, and is stored as displayed.
#pragma once

#include <cmath>

namespace haustra {

/// 0…1 as displayed to 0…1 of linear light, and back.
inline double linearLight(double displayed) {
    return displayed <= 0.04045 ? displayed / 12.92 : std::pow((displayed + 0.055) / 1.055, 2.4);
}
inline double displayedLight(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace haustra
