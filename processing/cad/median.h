// The middle of some numbers.
#pragma once

#include <algorithm>
#include <vector>

namespace haustra::cad {

/// The upper one of the two middle ones where they are even in number; reorders them. Of one at
/// least. O(n).
inline double medianOf(std::vector<double>& values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace haustra::cad
