#include "topology/distance_field.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace haustra::topology {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Lines along y and z are worked on this many neighbours in x at a time: one cache line of floats.
constexpr int tile = 16;

/// The lower envelope of the parabolas y = height + (step · (x − centre))², for one run at a time.
class ParabolaEnvelope {
public:
    ParabolaEnvelope(int longest, double step)
        : step_(step), parabolas_(std::size_t(longest) + 2) {}

    /// Replaces squared[i], i in [begin, end), by min over j of squared[j] + (step · (i − j))²
    /// with j over the run and over begin − 1 and end, where the square is 0 if they are on the
    /// line [0, size).
    void transformRun(double* squared, int begin, int end, int size) {
        count_ = 0;
        if (begin > 0) push(begin - 1, 0.0);
        for (int i = begin; i < end; ++i) {
            if (squared[i] < infinity) push(i, squared[i] / (step_ * step_));
        }
        if (end < size) push(end, 0.0);
        if (count_ == 0) return;  // nothing outside is known yet: infinity stays
        int n = 0;
        for (int i = begin; i < end; ++i) {
            while (n + 1 < count_ && parabolas_[std::size_t(n) + 1].from <= double(i))
                ++n;
            const Parabola& p = parabolas_[std::size_t(n)];
            const double away = double(i - p.center);
            squared[i] = (p.height + away * away) * step_ * step_;
        }
    }

private:
    struct Parabola {
        double height;  // in units of step²
        double from;    // lowest from here on, up to the next one's `from`
        int center;
    };

    void push(int center, double height) {
        double from = -infinity;
        while (count_ > 0) {
            const Parabola& last = parabolas_[std::size_t(count_) - 1];
            const double apart = double(center - last.center);
            from = 0.5 * ((height - last.height) / apart + double(center + last.center));
            if (from > last.from) break;
            --count_;
            from = -infinity;
        }
        parabolas_[std::size_t(count_++)] = {height, from, center};
    }

    double step_;
    int count_ = 0;
    std::vector<Parabola> parabolas_;
};

/// Calls run(begin, end) for each maximal run of non-zero labels, `stride` apart.
template <class Run>
void forEachRun(const std::uint8_t* labels, std::size_t stride, int size, const Run& run) {
    for (int i = 0; i < size;) {
        while (i < size && labels[std::size_t(i) * stride] == 0)
            ++i;
        const int begin = i;
        while (i < size && labels[std::size_t(i) * stride] != 0)
            ++i;
        if (begin < i) run(begin, i);
    }
}

bool anyInside(const std::uint8_t* labels, int count) {
    std::uint8_t any = 0;
    for (int i = 0; i < count; ++i)
        any |= labels[i];
    return any != 0;
}

/// Squared distances along one row, infinity where the whole row is inside.
void transformRow(const std::uint8_t* labels, int size, double stepMm, float* squared) {
    std::fill_n(squared, size, 0.0f);
    forEachRun(labels, 1, size, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const double below = begin > 0 ? double(i - begin + 1) : infinity;
            const double above = end < size ? double(end - i) : infinity;
            const double away = stepMm * std::min(below, above);
            squared[i] = float(away * away);
        }
    });
}

/// One sheet of the grid whose lines run along y or z; x is always the other axis.
struct Sheet {
    const std::uint8_t* labels;
    float* squared;
    std::size_t stride;  ///< between neighbours along the line
    int lines;           ///< extent along x
    int size;            ///< extent along the line
};

/// Transforms each line of the sheet in place, where it is inside; `finish` is applied to each
/// value written.
template <class Finish>
void transformLines(const Sheet& sheet, ParabolaEnvelope& envelope, std::vector<double>& lines,
                    std::vector<std::uint8_t>& inside, const Finish& finish) {
    const std::size_t size = std::size_t(sheet.size);
    for (int x0 = 0; x0 < sheet.lines; x0 += tile) {
        const int width = std::min(tile, sheet.lines - x0);
        int first = sheet.size, last = -1;
        for (int i = 0; i < sheet.size; ++i) {
            if (!anyInside(sheet.labels + std::size_t(i) * sheet.stride + x0, width)) continue;
            first = std::min(first, i);
            last = i;
        }
        for (int i = first; i <= last; ++i) {
            const std::size_t at = std::size_t(i) * sheet.stride + std::size_t(x0);
            for (int x = 0; x < width; ++x) {
                const std::size_t to = std::size_t(x) * size + std::size_t(i);
                inside[to] = sheet.labels[at + std::size_t(x)];
                if (inside[to]) lines[to] = double(sheet.squared[at + std::size_t(x)]);
            }
        }
        if (last < 0) continue;
        for (int x = 0; x < width; ++x) {
            double* line = lines.data() + std::size_t(x) * size;
            forEachRun(inside.data() + std::size_t(x) * size + first, 1, last + 1 - first,
                       [&](int begin, int end) {
                           envelope.transformRun(line, begin + first, end + first, sheet.size);
                       });
        }
        for (int i = first; i <= last; ++i) {
            const std::size_t at = std::size_t(i) * sheet.stride + std::size_t(x0);
            for (int x = 0; x < width; ++x) {
                const std::size_t from = std::size_t(x) * size + std::size_t(i);
                if (inside[from]) sheet.squared[at + std::size_t(x)] = finish(lines[from]);
            }
        }
    }
}

}  // namespace

Volume<float> distanceToBoundaryMm(const Volume<std::uint8_t>& labels, int threads) {
    const Grid& grid = labels.grid();
    const glm::ivec3 size = grid.size;
    const glm::dvec3 stepMm = grid.spacingMm();
    const std::size_t row = std::size_t(size.x), slice = row * std::size_t(size.y);
    const std::uint8_t* label = labels.voxels().data();
    Volume<float> result(grid, 0.0f);  // rows without lumen are not touched, and take no memory
    float* squared = result.writable().data();

    // Along x and y, slice by slice.
    parallelFor(std::size_t(size.z), 1, threads, [&](std::size_t begin, std::size_t end) {
        ParabolaEnvelope envelope(size.y, stepMm.y);
        std::vector<double> lines(std::size_t(tile) * std::size_t(size.y));
        std::vector<std::uint8_t> inside(lines.size());
        for (std::size_t k = begin; k < end; ++k) {
            bool any = false;
            for (int j = 0; j < size.y; ++j) {
                const std::size_t at = k * slice + std::size_t(j) * row;
                if (!anyInside(label + at, size.x)) continue;
                any = true;
                transformRow(label + at, size.x, stepMm.x, squared + at);
            }
            if (!any) continue;
            transformLines({label + k * slice, squared + k * slice, row, size.x, size.y}, envelope,
                           lines, inside, [](double value) { return float(value); });
        }
    });
    // Along z, and from squares to distances.
    parallelFor(std::size_t(size.y), 1, threads, [&](std::size_t begin, std::size_t end) {
        ParabolaEnvelope envelope(size.z, stepMm.z);
        std::vector<double> lines(std::size_t(tile) * std::size_t(size.z));
        std::vector<std::uint8_t> inside(lines.size());
        for (std::size_t j = begin; j < end; ++j) {
            transformLines({label + j * row, squared + j * row, slice, size.x, size.z}, envelope,
                           lines, inside, [](double value) { return float(std::sqrt(value)); });
        }
    });
    return result;
}

}  // namespace haustra::topology
