#include "cleansing/smooth_field.h"

#include "core/parallel.h"

#include <algorithm>

namespace haustra::cleansing {

SmoothField::SmoothField(const Grid& grid, glm::ivec3 voxelsPerCell)
    : perCell_(voxelsPerCell),
      cells_((grid.size + voxelsPerCell - 1) / voxelsPerCell),
      values_(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z), 0.0f) {
    for (int axis = 0; axis < 3; ++axis) {
        const int per = perCell_[axis], last = cells_[axis] - 1;
        for (int n = 0; n < grid.size[axis]; ++n) {
            // Of the voxel's place in its cell alone: wherever a grid begins, the same.
            const float past = (float(n % per) + 0.5f) / float(per) - 0.5f;
            const int cell = past < 0.0f ? n / per - 1 : n / per;
            const float share = past < 0.0f ? past + 1.0f : past;
            between_[std::size_t(axis)].push_back(
                {std::max(cell, 0), std::min(cell + 1, last), cell < 0 ? 0.0f : share});
        }
    }
}

float SmoothField::at(int i, int j, int k) const {
    const Between &x = between_[0][std::size_t(i)], &y = between_[1][std::size_t(j)],
                  &z = between_[2][std::size_t(k)];
    const auto along = [&](int b, int c) {
        const float* row = &values_[cellIndex(0, b, c)];
        return row[x.lo] + x.share * (row[x.hi] - row[x.lo]);
    };
    const auto across = [&](int c) {
        const float a = along(y.lo, c);
        return a + y.share * (along(y.hi, c) - a);
    };
    const float a = across(z.lo);
    return z.share == 0.0f ? a : a + z.share * (across(z.hi) - a);
}

void SmoothField::row(glm::ivec3 first, std::span<float> values) const {
    const Between &y = between_[1][std::size_t(first.y)], &z = between_[2][std::size_t(first.z)];
    std::vector<float> across(std::size_t(cells_.x));
    for (int x = 0; x < cells_.x; ++x) {
        const auto mixed = [&](int c) {
            return glm::mix(values_[cellIndex(x, y.lo, c)], values_[cellIndex(x, y.hi, c)],
                            y.share);
        };
        across[std::size_t(x)] = glm::mix(mixed(z.lo), mixed(z.hi), z.share);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Between& x = between_[0][std::size_t(first.x) + i];
        values[i] = glm::mix(across[std::size_t(x.lo)], across[std::size_t(x.hi)], x.share);
    }
}

void convolveAxis(std::vector<float>& cells, glm::ivec3 size, int axis,
                  std::span<const float> kernel, int threads) {
    const int reach = int(kernel.size() / 2), length = size[axis];
    const std::size_t stride = axis == 0   ? 1
                               : axis == 1 ? std::size_t(size.x)
                                           : std::size_t(size.x) * std::size_t(size.y);
    const std::size_t count = cells.size() / std::size_t(length);
    parallelFor(count, 256, threads, [&](std::size_t first, std::size_t last) {
        std::vector<float> line(static_cast<std::size_t>(length));
        // Pointers: a bound that is checked for each product costs half as much again.
        const float* const weights = kernel.data() + reach;
        float* const values = line.data();
        for (std::size_t l = first; l < last; ++l) {
            float* const out =
                cells.data() + l % stride + l / stride * stride * std::size_t(length);
            bool any = false;
            for (int n = 0; n < length; ++n) {
                values[n] = out[std::size_t(n) * stride];
                any |= values[n] != 0.0f;
            }
            if (!any) continue;
            for (int n = 0; n < length; ++n) {
                float sum = 0.0f;
                for (int m = std::max(0, n - reach); m <= std::min(length - 1, n + reach); ++m)
                    sum += weights[m - n] * values[m];
                out[std::size_t(n) * stride] = sum;
            }
        }
    });
}

}  // namespace haustra::cleansing
