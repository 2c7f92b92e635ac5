// The standard normal distribution.
#pragma once

#include <algorithm>
#include <cmath>

namespace haustra {

inline double normalCdf(double x) {
    return 0.5 * std::erfc(-x * M_SQRT1_2);
}

inline double normalDensity(double x) {
    return std::exp(-0.5 * x * x) * (0.5 * M_SQRT1_2 * M_2_SQRTPI);
}

/// Its quantile, to 5e-4 (Abramowitz and Stegun 26.2.23).
inline double normalQuantile(double p) {
    const bool upper = p > 0.5;
    const double t = std::sqrt(-2.0 * std::log(std::clamp(upper ? 1.0 - p : p, 1e-9, 0.5)));
    const double x = t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                             (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    return upper ? x : -x;
}

}  // namespace haustra
