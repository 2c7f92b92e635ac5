// Quantiles of some numbers.
#pragma once

#include <algorithm>
#include <vector>

namespace haustra {

/// Beneath or at which `share` of them lie, 0…1: the smallest of 0, the greatest of 1. Reorders
/// them. Of one at least. O(n).
template <class T>
T quantileOf(std::vector<T>& values, double share) {
    const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// The upper one of the two middle ones where they are even in number; reorders them. Of one at
/// least. O(n).
template <class T>
T medianOf(std::vector<T>& values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace haustra
