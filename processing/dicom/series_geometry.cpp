#include "dicom/series_geometry.h"

#include "core/printed_text.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haustra::dicom {
namespace {

constexpr double samePlaceMm = 0.01;
constexpr double widestGapMm = 10.0;
constexpr double leastTiltDegrees = 0.1;
constexpr double leastTiltPixels = 0.5;  // over the whole stack
constexpr double sidewaysPixels = 1.0;   // off the tilted axis

std::string millimetres(double value) {
    return printed("%.2f mm", value);
}

/// "z = -12.50 mm" for an axial series, "12.50 mm along the slice normal" for any other.
std::string placeAlong(const glm::dvec3& normal, double depthMm) {
    if (std::abs(normal.z) > 0.9999) return "z = " + millimetres(normal.z > 0 ? depthMm : -depthMm);
    return millimetres(depthMm) + " along the slice normal";
}

/// The middle value, of an even number the lower of the two.
double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Result<void> checkAlike(const std::vector<Slice>& slices) {
    const Slice& first = slices.front();
    for (const Slice& slice : slices) {
        const char* what = nullptr;
        if (slice.matrix != first.matrix)
            what = "matrix";
        else if (glm::distance(slice.rowDirection, first.rowDirection) > 1e-3 ||
                 glm::distance(slice.columnDirection, first.columnDirection) > 1e-3)
            what = "orientation";
        else if (glm::any(glm::greaterThan(glm::abs(slice.pixelSpacingMm - first.pixelSpacingMm),
                                           1e-3 * first.pixelSpacingMm)))
            what = "pixel spacing";
        if (what) {
            return fail(ErrorKind::badInput,
                        std::string("its ") + what + " differs from that of " + first.name,
                        slice.name);
        }
    }
    return {};
}

/// The stack under construction: slices in order, and where each lies along the normal.
struct Column {
    glm::dvec3 normal;
    std::vector<std::size_t> order;
    std::vector<double> depthMm;
    std::vector<SliceStack::Copy> copies;

    double gap(std::size_t k) const { return depthMm[k + 1] - depthMm[k]; }
    std::size_t gaps() const { return order.size() - 1; }
};

Result<Column> sortAlongNormal(const std::vector<Slice>& slices) {
    Column column;
    column.normal = glm::normalize(glm::cross(slices[0].rowDirection, slices[0].columnDirection));
    std::vector<double> depth(slices.size());
    for (std::size_t n = 0; n < slices.size(); ++n)
        depth[n] = glm::dot(slices[n].positionMm, column.normal);
    std::vector<std::size_t> order(slices.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return depth[a] != depth[b] ? depth[a] < depth[b] : slices[a].name < slices[b].name;
    });
    for (std::size_t n : order) {
        if (!column.order.empty() && depth[n] - column.depthMm.back() < samePlaceMm) {
            const Slice& kept = slices[column.order.back()];
            if (!kept.instanceUid.empty() && kept.instanceUid == slices[n].instanceUid) {
                column.copies.push_back({n, column.order.back()});
                continue;
            }
            return fail(ErrorKind::badInput,
                        "it lies at the same position (" + placeAlong(column.normal, depth[n]) +
                            ") as " + kept.name,
                        slices[n].name);
        }
        column.order.push_back(n);
        column.depthMm.push_back(depth[n]);
    }
    return column;
}

/// How many gaps from k on, in a row, exceed `widest`.
std::size_t runOfWideGaps(const std::vector<double>& gaps, std::size_t k, double widest) {
    std::size_t end = k;
    while (end < gaps.size() && gaps[end] > widest)
        ++end;
    return end - k;
}

/// A gap 1.5 times as wide as both its neighbours is a hole. So is one 1.5 times as wide as the
/// usual gap, unless it is one of three or more such in a row: then the scan's spacing changes.
Result<void> checkHoles(const std::vector<Slice>& slices, const Column& column) {
    if (column.gaps() == 0) return {};
    std::vector<double> gaps(column.gaps());
    for (std::size_t k = 0; k < gaps.size(); ++k)
        gaps[k] = column.gap(k);
    const double usual = median(gaps);
    std::size_t run = 0;  // of wide gaps, as long as k is inside one
    for (std::size_t k = 0; k < gaps.size(); ++k) {
        const bool continues = k > 0 && gaps[k - 1] > 1.5 * usual;
        if (!continues) run = runOfWideGaps(gaps, k, 1.5 * usual);
        const bool amongNarrower =
            k > 0 && k + 1 < gaps.size() && gaps[k] > 1.5 * std::max(gaps[k - 1], gaps[k + 1]);
        const bool fewWide = gaps[k] > 1.5 * usual && run < 3;
        const std::string& below = slices[column.order[k]].name;
        const std::string& above = slices[column.order[k + 1]].name;
        if (amongNarrower || fewWide) {
            const double step = amongNarrower ? std::max(gaps[k - 1], gaps[k + 1]) : usual;
            const int missing = std::max(1, int(std::lround(gaps[k] / step)) - 1);
            const double first = column.depthMm[k] + gaps[k] / (missing + 1);
            return fail(ErrorKind::badInput,
                        (missing == 1 ? std::string("a slice is missing at ")
                                      : std::to_string(missing) + " slices are missing from ") +
                            placeAlong(column.normal, first) + ", before " + above +
                            " (slices are " + millimetres(step) + " apart)",
                        below);
        }
        if (gaps[k] > widestGapMm) {
            return fail(ErrorKind::badInput,
                        "the next slice, " + above + ", is " + millimetres(gaps[k]) +
                            " away; at most " + millimetres(widestGapMm) + " is read",
                        below);
        }
    }
    return {};
}

/// A slice between two that are as far apart as slices are before and behind is another's: a
/// spacing that changes does not do so for one slice.
Result<void> checkStrays(const std::vector<Slice>& slices, const Column& column) {
    if (column.gaps() < 4) return {};
    std::vector<double> gaps(column.gaps());
    for (std::size_t k = 0; k < gaps.size(); ++k)
        gaps[k] = column.gap(k);
    const double usual = median(gaps);
    const auto isUsual = [&](double mm) { return std::abs(mm - usual) < 0.1 * usual; };
    for (std::size_t k = 1; k + 2 < gaps.size(); ++k) {
        if (!isUsual(gaps[k] + gaps[k + 1]) || !isUsual(gaps[k - 1]) || !isUsual(gaps[k + 2]))
            continue;
        const bool nearerBelow = gaps[k] < gaps[k + 1];
        return fail(ErrorKind::badInput,
                    "it lies " + millimetres(std::min(gaps[k], gaps[k + 1])) + " from " +
                        slices[column.order[nearerBelow ? k : k + 2]].name + ", where slices are " +
                        millimetres(usual) + " apart: one of them is another's",
                    slices[column.order[k + 1]].name);
    }
    return {};
}

/// How far each slice lies sideways of the first, in pixels.
std::vector<glm::dvec2> sidewaysOffsets(const std::vector<Slice>& slices, const Column& column) {
    const Slice& first = slices[column.order[0]];
    std::vector<glm::dvec2> offsets;
    for (std::size_t n : column.order) {
        const glm::dvec3 step = slices[n].positionMm - first.positionMm;
        offsets.push_back(
            glm::dvec2(glm::dot(step, first.rowDirection), glm::dot(step, first.columnDirection)) /
            first.pixelSpacingMm);
    }
    return offsets;
}

/// Fills the stack's shifts, and moves and widens its grid to hold every shifted slice.
Result<void> squareUp(const std::vector<Slice>& slices, const Column& column, SliceStack& stack) {
    const Slice& first = slices[column.order[0]];
    const std::vector<glm::dvec2> offsets = sidewaysOffsets(slices, column);
    const double heightMm = column.depthMm.back() - column.depthMm.front();
    const glm::dvec2 drift = offsets.back();
    for (std::size_t k = 0; k < offsets.size(); ++k) {
        const double along = (column.depthMm[k] - column.depthMm[0]) / heightMm;
        const glm::dvec2 off = glm::abs(offsets[k] - along * drift);
        if (std::max(off.x, off.y) > sidewaysPixels) {
            return fail(ErrorKind::badInput,
                        "it is displaced sideways by " +
                            millimetres(glm::length(off * first.pixelSpacingMm)) +
                            " against its neighbours",
                        slices[column.order[k]].name);
        }
    }
    const double tilt =
        glm::degrees(std::atan2(glm::length(drift * first.pixelSpacingMm), heightMm));
    if (tilt < leastTiltDegrees || std::max(std::abs(drift.x), std::abs(drift.y)) < leastTiltPixels)
        return {};
    glm::dvec2 low(0.0), high(0.0);
    for (const glm::dvec2& offset : offsets) {
        low = glm::min(low, glm::floor(offset));
        high = glm::max(high, glm::ceil(offset));
    }
    if (glm::any(glm::greaterThan(high - low, glm::dvec2(4096.0)))) {
        return fail(ErrorKind::badInput, "the slices lie too far sideways of each other",
                    first.name);
    }
    for (const glm::dvec2& offset : offsets)
        stack.shiftPixels.push_back(offset - low);
    stack.grid.size.x += int(high.x - low.x);
    stack.grid.size.y += int(high.y - low.y);
    glm::dmat4& affine = stack.grid.patientFromVoxel;
    affine[3] += affine[0] * low.x + affine[1] * low.y;
    affine[2] = glm::dvec4(column.normal * glm::dot(glm::dvec3(affine[2]), column.normal), 0.0);
    stack.notes.push_back(printed("corrected a gantry tilt of %.1f degrees", tilt));
    return {};
}

/// Sets the grid's third axis and size; fills depthSlices where the spacing varies.
void setSpacing(const std::vector<Slice>& slices, const Column& column, SliceStack& stack) {
    glm::dvec4& axis = stack.grid.patientFromVoxel[2];
    const Slice& first = slices[column.order.front()];
    if (column.gaps() == 0) {
        axis = glm::dvec4(column.normal * (first.thicknessMm > 0.0 ? first.thicknessMm : 1.0), 0.0);
        stack.grid.size.z = 1;
        return;
    }
    const glm::dvec3 climb = slices[column.order.back()].positionMm - first.positionMm;
    const double heightMm = column.depthMm.back() - column.depthMm.front();
    const double mean = heightMm / double(column.gaps());
    std::vector<double> gaps;
    bool uniform = true;
    for (std::size_t k = 0; k < column.gaps(); ++k) {
        gaps.push_back(column.gap(k));
        // Positions rounded to 0.1 mm still count as uniform.
        uniform &= std::abs(column.depthMm[k] - column.depthMm[0] - mean * double(k)) < 0.1 * mean;
    }
    double spacing = mean;
    stack.grid.size.z = int(column.order.size());
    if (!uniform) {
        const auto [least, most] = std::minmax_element(gaps.begin(), gaps.end());
        spacing = std::max(*least, 0.5 * median(gaps));
        for (double depth : column.depthMm)
            stack.depthSlices.push_back((depth - column.depthMm[0]) / spacing);
        // To the last slice or just beyond it: nothing that was scanned is cut off.
        stack.grid.size.z = 1 + int(std::ceil(heightMm / spacing - 1e-6));
        stack.notes.push_back("resampled slices " + millimetres(*least) + " to " +
                              millimetres(*most) + " apart to " + millimetres(spacing));
    }
    axis = glm::dvec4(climb * (spacing / heightMm), 0.0);
}

}  // namespace

Result<SliceStack> stackSlices(const std::vector<Slice>& slices) {
    if (slices.empty()) return fail(ErrorKind::noResult, "the series holds no slice");
    TRY(checkAlike(slices));
    auto column = TRY(sortAlongNormal(slices));
    TRY(checkStrays(slices, column));
    TRY(checkHoles(slices, column));

    const Slice& first = slices[column.order[0]];
    SliceStack stack;
    stack.order = column.order;
    stack.copies = column.copies;
    if (!column.copies.empty()) {
        stack.notes.push_back("left out " + std::to_string(column.copies.size()) +
                              " copies of slices that are there already");
    }
    stack.grid.size = glm::ivec3(first.matrix, 1);
    glm::dmat4& affine = stack.grid.patientFromVoxel;
    affine[0] = glm::dvec4(first.rowDirection * first.pixelSpacingMm.x, 0.0);
    affine[1] = glm::dvec4(first.columnDirection * first.pixelSpacingMm.y, 0.0);
    affine[3] = glm::dvec4(first.positionMm, 1.0);
    setSpacing(slices, column, stack);
    if (column.gaps() > 0) {
        TRY(squareUp(slices, column, stack));
    }
    TRY(checkGrid(stack.grid, first.name));
    return stack;
}

}  // namespace haustra::dicom
