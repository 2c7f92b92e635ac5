#include "reader/flat_strip.h"

#include <algorithm>

namespace haustra::reader {
namespace {

// rows' `to` at `from` == value; where several rows have that value, the middle of them.
double interpolated(const std::vector<FlatStrip::Row>& rows, double FlatStrip::Row::*from,
                    double FlatStrip::Row::*to, double value) {
    const auto below = [&](const FlatStrip::Row& row, double v) { return row.*from < v; };
    const auto above = [&](double v, const FlatStrip::Row& row) { return v < row.*from; };
    const auto first = std::lower_bound(rows.begin(), rows.end(), value, below);
    const auto last = std::upper_bound(first, rows.end(), value, above);
    if (first != last) return 0.5 * ((*first).*to + (*(last - 1)).*to);
    if (first == rows.begin()) return rows.front().*to;
    if (first == rows.end()) return rows.back().*to;
    const FlatStrip::Row &a = *(first - 1), &b = *first;
    return a.*to + (b.*to - a.*to) * (value - a.*from) / (b.*from - a.*from);
}

}  // namespace

double FlatStrip::yAtArc(double arcMm) const {
    return interpolated(rows, &Row::arcMm, &Row::y, arcMm);
}

double FlatStrip::arcAtY(double y) const {
    return interpolated(rows, &Row::y, &Row::arcMm, y);
}

}  // namespace haustra::reader
