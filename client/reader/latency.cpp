#include "reader/latency.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haustra::reader {

Summary summarize(std::span<const double> values) {
    if (values.empty()) return {};
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const auto percentile = [&](double percent) {
        const double rank = std::ceil(percent / 100.0 * double(sorted.size()));
        return sorted[std::size_t(std::max(rank, 1.0)) - 1];
    };
    const double sum = std::accumulate(sorted.begin(), sorted.end(), 0.0);
    return {sorted.size(), sum / double(sorted.size()), percentile(50.0), percentile(95.0),
            sorted.back()};
}

Summary summarize(std::span<const std::uint32_t> values) {
    return summarize(std::vector<double>(values.begin(), values.end()));
}

void RecentTimes::add(double value) {
    if (values_.size() < capacity_) {
        values_.push_back(value);
    } else {
        values_[next_] = value;
        next_ = (next_ + 1) % capacity_;
    }
}

}  // namespace haustra::reader
