// Statistics of measured times.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::reader {

struct Summary {
    std::size_t count = 0;
    double mean = 0.0, p50 = 0.0, p95 = 0.0, max = 0.0;
};

/// Mean, maximum, and percentiles by nearest rank: p95 is the smallest value that at least 95 % of
/// the values do not exceed. All zero for no values. O(n log n).
Summary summarize(std::span<const double> values);

/// The same numbers for integers, as doubles.
Summary summarize(std::span<const std::uint32_t> values);

/// The last few times of a running measurement, for a status line.
class RecentTimes {
public:
    explicit RecentTimes(std::size_t capacity = 60) : capacity_(capacity) {}
    void add(double value);
    void clear() { values_.clear(), next_ = 0; }
    Summary summary() const { return summarize(values_); }

private:
    std::size_t capacity_, next_ = 0;
    std::vector<double> values_;
};

}  // namespace haustra::reader
